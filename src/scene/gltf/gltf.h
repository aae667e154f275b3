// Reads glTF 2.0 (.gltf, .glb) into a Scene. The only user of tinygltf; everything it leaves unchecked is checked here.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// Appends the file's contents (default scene only). Throws Error (refused, unreadable) naming file and JSON pointer.
// Never opens files outside the glTF's directory.
void load_gltf(const std::filesystem::path& file, const LoadOptions& options, Scene& scene);
}
