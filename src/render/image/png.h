// 8-bit sRGB pictures for looking at.
#pragma once
#include "render/image/view_transform.h"

#include <filesystem>
#include <map>

namespace tyndall {
// What a PNG says of itself: keywords of 1 to 79 letters, and text in ASCII.
using PngText = std::map<std::string, std::string>;

PngText text_of(const Display& display); // tyndall:exposure, in stops, and tyndall:viewTransform

// Light as it is shown, dithered, with that text.
void write_png(const std::filesystem::path& file, const Image<vec3>& linear, const Display& display);

// Codes as they are.
void write_png(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, const PngText& text = {});

// Codes nearly as they are, in a fraction of the room: for pictures inside of pages. Quality 1 to 100.
void write_jpeg(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, int quality);
}
