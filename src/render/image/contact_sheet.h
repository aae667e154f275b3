// Several images of one view side by side, with lines of text under each.
#pragma once
#include "render/image/view_transform.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tyndall {
struct SheetImage {
    Image<vec3> color;              // linear Rec.709, all of one size
    std::vector<std::string> lines; // the first one is bright
};

// Tiles of at most 640 pixels across, in about as many rows as columns.
Image<glm::u8vec3> contact_sheet(const std::vector<SheetImage>& pictures, const Display& display);
void write_contact_sheet(const std::filesystem::path& file, const std::vector<SheetImage>& pictures,
                         const Display& display);
}
