// Writes edits into the text of a scene file: only the values they change, everything else byte for byte as it was.
#pragma once
#include "viewer/editing/scene_edit.h"

#include <filesystem>

namespace tyndall {
// The text with the edits applied in order. `scene` is what was read from the text, with or without the edits. Lights
// of the glTF get an entry with their name; a default camera is written out. The result is checked against the schema.
// Throws Error (refused).
std::string edited_text(std::string text, const Scene& scene, std::span<const Edit> edits);

// The text of a scene file for a bare glTF, with all defaults it was given: camera, light, fog. Sets the `entry` of
// each in the scene.
std::string new_scene_text(Scene& scene);

// The text with its relative paths changed to refer to the same files from another folder.
std::string rebase_paths(std::string text, const std::filesystem::path& from, const std::filesystem::path& to);
}
