// Scenes to edit: one of everything, and how two of them are held against each other.
#pragma once
#include "support/gltf_builder.h"
#include "support/scratch.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct Scene;
}

namespace tyndall::test {
// Lights of a model: a spot and a sun that stand still, a point that moves with its node, a triangle.
GltfBuilder model();

extern const std::string rich_scene, dust; // texts of the scene and of its recipe

// A folder with the scene and what it names.
struct SceneFolder : TempFolder {
    std::filesystem::path file;

    explicit SceneFolder(std::string_view text = rich_scene);
};

void write_ball(const std::filesystem::path& file);

// Everything edits can reach, to the bit, one line for each light, medium and camera.
std::vector<std::string> state_of(const Scene& scene);
}
