// Editing the scene that is shown: what edits, undo and saving do to the state.
#pragma once
#include "viewer/state/view_state.h"

namespace tyndall {
double seconds_of(const ViewState& state); // of the frame shown; needs a scene

// Path and value as in parse_edit, at the frame shown; `drag` as in edit(). Throws Error.
void edit_scene(ViewState& state, std::string_view path, std::string_view value, double drag);

void undo_edit(ViewState& state);
void redo_edit(ViewState& state);
void cancel_drag(ViewState& state, double drag);

// Into its own file when none is given. Throws Error.
void save_scene(ViewState& state, const std::filesystem::path& file);

// Hands are asked before unsaved edits are lost, scripts only when they close the window, which ends a job as well:
// `asked` then waits for an answer: save, discard or cancel. Throws Error: usage (of another answer, or without a
// question), and as saving does, and goes on asking.
void open_scene(ViewState& state, const Action& action);
void reload_scene(ViewState& state); // from its files, in the background; unsaved edits stay
void close_window(ViewState& state, const Action& action);
void answer(ViewState& state, const std::string& word);

// The session's scene has changed: pictures have to follow.
void show_edits(ViewState& state);

// The action that selects a thing.
Action selection_of(const Scene& scene, Thing thing);

// The action that makes an edit: its words name the same thing and the same numbers, to the bit.
Action action_of(const Scene& scene, const Edit& edit, uint64_t drag);
}
