// Edits written into the text of a scene file: only the values they change, everything else byte for byte as it was.
#pragma once
#include "viewer/editing/scene_edit.h"

#include <filesystem>

namespace tyndall {
// The text with the edits made, in their order. `scene` is what was read from the text, with or without the edits.
// Lights of the glTF get an entry of their name; a camera that stood in for a missing one is written down. The result
// is checked against the schema. Throws Error (refused).
std::string edited_text(std::string text, const Scene& scene, std::span<const Edit> edits);

// The text of a scene file that lies beside a bare glTF and says all that was made up for it: camera, light, fog.
// Notes in the scene where each of them stands.
std::string new_scene_text(Scene& scene);

// The text with its relative paths made to mean the same files from another folder.
std::string moved_text(std::string text, const std::filesystem::path& from, const std::filesystem::path& to);
}
