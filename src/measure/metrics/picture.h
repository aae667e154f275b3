// The colours of an OpenEXR file of any renderer, ready to be compared.
#pragma once
#include "base/image.h"

#include <filesystem>
#include <map>
#include <string>

namespace tyndall {
struct Picture {
    std::string file;
    ivec2 display{0}, low{0}; // display window's size; where the pixels lie in it
    bool grey = false;        // the file has luminance (Y) only
    bool stylised = false;    // made with artist's controls: no measure of accuracy
    Image<vec3> beauty;
    // By name: NAME.R/G/B as colours, layers of one channel (transmittance.T) as grey.
    std::map<std::string, Image<vec3>> layers;

    const Image<vec3>* layer(const std::string& name) const;
};

// Throws Error as read_exr does, and refused when there is neither R, G, B nor Y.
Picture read_picture(const std::filesystem::path& file);

// Throws Error (refused) unless both show the same pixels of pictures of the same size, in colour both or grey both.
void check_same_frame(const Picture& test, const Picture& reference);
}
