// Detects changes on disk to the files that a scene was read from.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace tyndall {
struct Scene;

struct InputTime {
    std::filesystem::path file;
    std::filesystem::file_time_type written{};
    uintmax_t size = 0;
};

// Time and size of every file the scene was read from, including its volumes.
std::vector<InputTime> input_times(const Scene& scene);

// The files whose time or size has changed. A missing file counts as unchanged: many editors remove a file for a moment
// while they replace it.
std::vector<std::filesystem::path> changed_inputs(std::span<const InputTime> known);
}
