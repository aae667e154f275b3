// Edits the scene that is shown: how edits, undo and saving change the state.
#pragma once
#include "viewer/state/view_state.h"

namespace tyndall {
double seconds_of(const ViewState& state); // of the frame shown; needs a scene

// Path and value as in parse_edit, at the frame shown; `drag` as in edit(). Throws Error.
void edit_scene(ViewState& state, std::string_view path, std::string_view value, double drag);

void undo_edit(ViewState& state);
void redo_edit(ViewState& state);
void cancel_drag(ViewState& state, double drag);

// Saves to `file`, or to the scene's own file if that is empty. Throws Error.
void save_scene(ViewState& state, const std::filesystem::path& file);

// A user is asked before unsaved edits are lost, a script only before it closes the window, which also ends a running
// job: `asked` then waits for an answer: save, discard or cancel. answer() throws Error (usage: another word, or no
// question; or as saving does), and the question remains.
void open_scene(ViewState& state, const Action& action);
void reload_scene(ViewState& state); // from its files, in the background; unsaved edits stay
void close_window(ViewState& state, const Action& action);
void answer(ViewState& state, const std::string& word);

// Call after the session's scene has changed, to update the image.
void show_edits(ViewState& state);

// The action that selects a part of the scene.
Action selection_of(const Scene& scene, PartRef thing);

// The action that makes an edit: its words give the same part and, to the bit, the same numbers.
Action action_of(const Scene& scene, const Edit& edit, uint64_t drag);
}
