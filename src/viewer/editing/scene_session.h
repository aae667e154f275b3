// A scene that is open for editing: its file's contents, the edits since, undo, saving, and reloading when files change
// on disk. The caller makes a new snapshot after every change, and not from one made before a reload.
#pragma once
#include "viewer/editing/editable_parts.h"
#include "viewer/editing/input_times.h"
#include "viewer/editing/scene_edit.h"

namespace tyndall {
// Edits that are undone together: one drag.
struct EditStep {
    std::vector<Edit> edits;
    uint64_t drag = 0; // 0 = complete
};

struct SceneSession {
    Scene scene; // as edited
    LoadOptions options;
    bool has_file = false; // from a scene file; else a bare glTF or volume, with the text of a scene file for it
    std::string text;      // without the steps
    std::string on_disk;   // as last read or written
    EditableParts before;  // without the steps
    std::vector<EditStep> steps;
    size_t done = 0;               // steps applied; those after can be redone
    size_t saved = 0;              // steps applied when last saved or read
    size_t kept = 0;               // of those, how many are still among the steps
    std::vector<InputTime> inputs; // of every file read
};

// A scene file, .gltf, .glb or .vdb. Throws Error.
SceneSession open_session(const std::filesystem::path& file, const LoadOptions& options = {});

// Applies an edit. Consecutive edits with the same `drag` are one step to undo; 0 is a step by itself. Throws Error as
// apply() does.
void edit(SceneSession& session, const Edit& edit, uint64_t drag = 0);

bool undo(SceneSession& session); // false if there is nothing to undo
bool redo(SceneSession& session);

// Cancels a drag: its step is undone and cannot be redone. False if the last step is not that drag's.
bool discard_drag(SceneSession& session, uint64_t drag);

bool has_unsaved_changes(const SceneSession& session);

// Writes the edits into the scene file, atomically. Throws Error: usage (there is no scene file yet), refused (the file
// was changed on disk: reload first), unwritable.
void save(SceneSession& session);

// Writes the scene to another file, with paths that refer to the same files, and continues with that one. Throws Error.
void save_as(SceneSession& session, const std::filesystem::path& file);

// Reads all files again and repeats the unsaved edits. Returns a line for each that is no longer possible and is lost.
// Saved steps can no longer be undone. If the files cannot be read, throws Error and leaves the scene and its edits as
// they were; `inputs` then has the new times, so that the next change is noticed.
std::vector<std::string> reload(SceneSession& session);

// The same with a session that was read in the background; for interfaces that do not wait for files.
std::vector<std::string> rebase_onto(SceneSession& session, SceneSession fresh);

// The unsaved edits, one per line, and a hash of the edited scene; empty if there are none. One more line if something
// saved was undone.
std::string unsaved_text(const SceneSession& session);
}
