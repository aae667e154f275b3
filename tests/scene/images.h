// Encoded pictures made on the spot.
#pragma once
#include "base/image.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall {
// An RGBA PNG of 8 or 16 bits without compression; its checksums are zero, which decoders we use do not look at.
template<class Code> std::string png_with(ivec2 size, const std::vector<std::array<Code, 4>>& texels) {
    const auto big = [](uint32_t value) {
        return std::string{static_cast<char>(value >> 24), static_cast<char>(value >> 16),
                           static_cast<char>(value >> 8), static_cast<char>(value)};
    };
    const auto part = [&](const char* type, const std::string& bytes) {
        return big(static_cast<uint32_t>(bytes.size())) + type + bytes + std::string(4, '\0');
    };
    std::string rows;
    for (size_t i = 0; i < texels.size(); ++i) {
        if (i % size.x == 0) rows += '\0';
        for (const Code value : texels[i]) {
            if (sizeof(Code) > 1) rows += static_cast<char>(value >> 8);
            rows += static_cast<char>(value);
        }
    }
    const std::string depth{static_cast<char>(8 * sizeof(Code))};
    const size_t length = rows.size();
    const std::string stored = std::string("\x78\x01\x01", 3) + static_cast<char>(length) +
                               static_cast<char>(length >> 8) + static_cast<char>(~length) +
                               static_cast<char>(~length >> 8) + rows + std::string(4, '\0');
    return "\x89PNG\r\n\x1a\n" + part("IHDR", big(size.x) + big(size.y) + depth + std::string("\x06\0\0\0", 4)) +
           part("IDAT", stored) + part("IEND", "");
}
inline std::string png_of(ivec2 size, const std::vector<std::array<uint8_t, 4>>& texels) {
    return png_with(size, texels);
}
inline std::string png16_of(ivec2 size, const std::vector<std::array<uint16_t, 4>>& texels) {
    return png_with(size, texels);
}

// A Radiance picture of flat RGBE pixels.
inline std::string radiance_of(ivec2 size, const std::vector<std::array<uint8_t, 4>>& pixels) {
    std::string text =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(size.y) + " +X " + std::to_string(size.x) + "\n";
    for (const auto& pixel : pixels)
        for (const uint8_t value : pixel) text += static_cast<char>(value);
    return text;
}
}
