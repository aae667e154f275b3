// OpenEXR pictures. The only user of OpenEXR. Encoded in memory, then written atomically.
#pragma once
#include "render/frame.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// How a picture was made; becomes header attributes.
struct Provenance {
    Camera camera;
    double frame_rate = 24;
    int frame = 0;
    std::map<std::string, std::string> attributes;     // "tyndall:mode" -> "march", ...: text for each
};

// Which layers go into the file besides RGBA: Z, inscatter, transmittance, validity, lights.
struct ExrOptions {
    std::vector<std::string> layers{"Z", "inscatter", "transmittance"};
    bool full_float = false;                           // colours as 32 bit instead of half
};

void write_exr(const std::filesystem::path& file, const Layers& layers, const Provenance& provenance,
               const ExrOptions& options);

struct ExrFile {
    ivec2 display{0}, low{0}, size{0};
    std::vector<std::pair<std::string, Image<float>>> channels;
    std::map<std::string, std::string> attributes;     // text attributes; others as text
    std::string compression;
    const Image<float>* channel(std::string_view name) const;
};

// Every pixel is decoded. Throws Error (unreadable, refused): flat, single part, NONE/RLE/ZIPS/ZIP only; limits apply.
ExrFile read_exr(const std::filesystem::path& file);
}
