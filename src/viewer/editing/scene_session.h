// A scene that is open for editing: what the file said, the edits made since, undo, saving, and reloading when files
// change on disk. Whoever shows the scene makes new snapshots after every change, not out of those before a reload.
#pragma once
#include "viewer/editing/editable_parts.h"
#include "viewer/editing/input_times.h"
#include "viewer/editing/scene_edit.h"

namespace tyndall {
// Edits that are undone together: one drag.
struct EditStep {
    std::vector<Edit> edits;
    uint64_t drag = 0; // 0 = nothing is added to it any more
};

struct SceneSession {
    Scene scene; // as edited
    LoadOptions options;
    bool has_file = false; // a scene file; else a bare glTF or volume, with the text that a scene file would have
    std::string text;      // without the steps
    std::string on_disk;   // as last read or written
    EditableParts before;  // without the steps
    std::vector<EditStep> steps;
    size_t done = 0;               // steps in force; those behind can be done again
    size_t saved = 0;              // steps in force when last saved or read
    size_t kept = 0;               // of those, how many are still among the steps
    std::vector<InputTime> inputs; // of every file read
};

// A scene file, .gltf, .glb or .vdb. Throws Error.
SceneSession open_session(const std::filesystem::path& file, const LoadOptions& options = {});

// Applies an edit. Every drag has a number of its own: edits in a row with the same one are one step to undo; 0 stands
// alone. Throws Error as apply does.
void edit(SceneSession& session, const Edit& edit, uint64_t drag = 0);

bool undo(SceneSession& session); // false when there is nothing
bool redo(SceneSession& session);

// Ends a drag as if it had never begun: its step is undone and cannot be done again. False when the last step is not
// that drag's.
bool take_back(SceneSession& session, uint64_t drag);

bool has_unsaved_changes(const SceneSession& session);

// Writes the edits into the scene file, atomically. Throws Error: usage (there is no scene file yet), refused (the file
// was changed on disk by somebody else: reload first), unwritable.
void save(SceneSession& session);

// Writes a scene file elsewhere, with paths that mean the same files, and goes on with that one. Throws Error.
void save_as(SceneSession& session, const std::filesystem::path& file);

// Reads everything anew and makes the unsaved edits again. Returns a line for each that found no place any more and is
// gone. Steps that were saved can no longer be undone. Throws Error and leaves scene and edits alone when the files
// cannot be read; `inputs` then knows the new times, so that the next change is noticed.
std::vector<std::string> reload(SceneSession& session);

// The same with what was read elsewhere meanwhile; for interfaces that do not wait for files.
std::vector<std::string> go_on_with(SceneSession& session, SceneSession fresh);

// The edits that no file has yet, one a line, and a hash of the scene with them; empty when there are none. A line more
// when something saved was undone.
std::string unsaved_text(const SceneSession& session);
}
