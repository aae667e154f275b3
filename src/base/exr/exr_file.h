// Reads complete OpenEXR files with all channels, and rejects damaged or malicious ones.
#pragma once
#include "base/image.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct ExrFile {
    ivec2 display{0}, low{0}, size{0}; // size of the display window; origin within it and size of the data window
    std::vector<std::pair<std::string, Image<float>>> channels;
    std::map<std::string, std::string> attributes; // names, and values by attribute_text()
    std::string compression;
    bool is_unchanged = false; // every byte is as write_exr() wrote it, according to tyndall:check
    const Image<float>* channel(std::string_view name) const;
};

// R, G and B of a layer, or of the image; black where the file lacks them.
Image<vec3> color_of(const ExrFile& exr, std::string_view layer = {});

// Decodes every pixel; of tiled files the largest level. Throws Error (unreadable, refused): only single-part flat
// images without subsampled channels, within the limits, are read.
ExrFile read_exr(const std::filesystem::path& file);

inline constexpr int max_channels = 1024;
inline constexpr uint64_t max_decoded_bytes = uint64_t{4} << 30; // as floats

// Runs the same checks but leaves the channels without pixels.
ExrFile read_exr_header(const std::filesystem::path& file);

// Rows first..first + count - 1 of the data window, counted from its top, of a file that has already been checked.
// Throws Error (unreadable, refused).
ExrFile read_exr_rows(const std::filesystem::path& file, int first, int count);
}
