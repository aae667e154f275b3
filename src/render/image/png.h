// 8-bit sRGB pictures for looking at.
#pragma once
#include "base/image.h"

#include <filesystem>

namespace tyndall {
// colour · 2^exposure, filmic shoulder above 0.8 so that bright shafts keep their shape, sRGB, dithered by ±½ code.
void write_png(const std::filesystem::path& file, const Image<vec3>& linear, float exposure);

// The same as codes.
Image<glm::u8vec3> display_codes(const Image<vec3>& linear, float exposure);

// Codes as they are.
void write_png(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb);

// Codes nearly as they are, in a fraction of the room: for pictures inside of pages. Quality 1 to 100.
void write_jpeg(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, int quality);
}
