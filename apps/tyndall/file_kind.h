// What a file is, from its name and its first bytes.
#pragma once
#include "base/json/json.h"

#include <filesystem>

namespace tyndall {
enum class FileKind { vdb, gltf, exr, ies, scene, recipe, schema };

// Throws Error: unreadable, or refused when it is none of these.
FileKind file_kind(const std::filesystem::path& file);
}
