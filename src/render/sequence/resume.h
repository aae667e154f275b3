// Whether a frame on disk is the one that would be rendered.
#pragma once
#include "render/image/exr.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct ExpectedFrame {
    ivec2 display{0}, low{0}, size{0};
    std::vector<std::string> channels; // sorted
    std::string hash;
};

// Reads the frame if every pixel decodes and everything is as wanted; otherwise none, with the reason in `why` (empty:
// there is no file).
std::optional<ExrFile> finished_frame(const std::filesystem::path& file, const ExpectedFrame& expected,
                                      std::string& why);
}
