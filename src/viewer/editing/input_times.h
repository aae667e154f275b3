// Whether files that a scene was read from changed on disk.
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

// The state of every file the scene was read from, the files of its volumes included.
std::vector<InputTime> input_times(const Scene& scene);

// Those that are another file now, by time or size. A file that is away counts as unchanged: many editors remove a file
// for a moment while they replace it.
std::vector<std::filesystem::path> changed_inputs(std::span<const InputTime> known);
}
