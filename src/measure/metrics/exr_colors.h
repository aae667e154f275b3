// The colors of an OpenEXR file from any renderer, ready to be compared.
#pragma once
#include "base/image.h"

#include <filesystem>
#include <map>
#include <string>

namespace tyndall {
struct ExrColors {
    std::string file;
    ivec2 display{0}, low{0}; // display window's size; where the pixels lie in it
    bool gray = false;        // the file has luminance (Y) only
    bool stylized = false;    // made with artistic controls: differences say nothing about accuracy
    Image<vec3> beauty;
    // By name: NAME.R/G/B as colors, layers of one channel (transmittance.T) as gray.
    std::map<std::string, Image<vec3>> layers;

    const Image<vec3>* layer(const std::string& name) const;
};

// Throws Error as read_exr does, and refused when there is neither R, G, B nor Y.
ExrColors read_exr_colors(const std::filesystem::path& file);

// Throws Error (refused) unless both hold the same pixels of images of the same size, both in color or both gray.
void check_same_frame(const ExrColors& test, const ExrColors& reference);
}
