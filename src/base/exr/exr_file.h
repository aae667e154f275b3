// OpenEXR files read back, to the last pixel, guarded against damaged and hostile ones.
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
    ivec2 display{0}, low{0}, size{0}; // display window's size; data window within it
    std::vector<std::pair<std::string, Image<float>>> channels;
    std::map<std::string, std::string> attributes; // text attributes; others as text
    std::string compression;
    bool is_unchanged = false; // every byte is as write_exr() wrote it; tyndall:check says what they were
    const Image<float>* channel(std::string_view name) const;
};

// R, G and B; black where the file lacks them.
Image<vec3> color_of(const ExrFile& exr);

// Every pixel is decoded, of tiles the largest level. Throws Error (unreadable, refused): flat pictures of one part
// only, all channels with all pixels; limits apply.
ExrFile read_exr(const std::filesystem::path& file);

inline constexpr int max_channels = 1024;
inline constexpr uint64_t max_decoded_bytes = uint64_t{4} << 30; // as floats

// The same checks, but of the channels the names only.
ExrFile read_exr_header(const std::filesystem::path& file);

// So many rows from one on, counted from the top of the pixels that are there, of a file that has been checked. Throws
// Error (unreadable, refused).
ExrFile read_exr_rows(const std::filesystem::path& file, int first, int count);
}
