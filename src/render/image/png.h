// 8-bit sRGB images for viewing.
#pragma once
#include "render/image/view_transform.h"

#include <filesystem>
#include <map>

namespace tyndall {
// Text chunks of a PNG: keywords of 1 to 79 letters, and text in ASCII.
using PngText = std::map<std::string, std::string>;

PngText text_of(const Display& display); // tyndall:exposure, in stops, and tyndall:viewTransform

// Writes linear light as displayed, dithered, with text_of(display).
void write_png(const std::filesystem::path& file, const Image<vec3>& linear, const Display& display);

// Writes sRGB codes unchanged.
void write_png(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, const PngText& text = {});

// Writes sRGB codes as a much smaller JPEG, for images embedded in pages. Quality 1 to 100.
void write_jpeg(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, int quality);
}
