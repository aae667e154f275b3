// The display transform: exposure, shoulder, sRGB, dither.
#include "render/image/png.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/random.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <cstdint>

namespace tyndall {
namespace {
constexpr float shoulder = 0.8f;

// Identity up to the shoulder, then bent smoothly towards 1.
float compressed(float x) {
    if (!(x > 0)) return 0;
    return x <= shoulder ? x : 1 - (1 - shoulder) * std::exp((shoulder - x) / (1 - shoulder));
}

// IEC 61966-2-1.
float srgb(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; }

uint8_t code(float linear, uint32_t x, uint32_t y, uint32_t channel) {
    const float value = 255 * srgb(compressed(linear)) + random_unit(x, y, channel, 0);
    return static_cast<uint8_t>(std::min(value, 255.0f));
}

void append(void* context, void* data, int size) {
    auto& bytes = *static_cast<std::vector<std::byte>*>(context);
    const auto* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}
}

Image<glm::u8vec3> display_codes(const Image<vec3>& linear, float exposure) {
    const float gain = std::exp2(exposure);
    Image<glm::u8vec3> codes(linear.size);
    for (int y = 0; y < linear.size.y; ++y)
        for (int x = 0; x < linear.size.x; ++x)
            for (int c = 0; c < 3; ++c) codes.at(x, y)[c] = code(gain * linear.at(x, y)[c], x, y, c);
    return codes;
}

void write_png(const std::filesystem::path& file, const Image<vec3>& linear, float exposure) {
    write_png(file, display_codes(linear, exposure));
}

void write_png(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb) {
    static_assert(sizeof(glm::u8vec3) == 3);
    std::vector<std::byte> bytes;
    stbi_write_png_compression_level = 5;
    if (!stbi_write_png_to_func(append, &bytes, srgb.size.x, srgb.size.y, 3, srgb.pixels.data(), 3 * srgb.size.x))
        fail(ExitCode::out_of_memory, file.string(), "no memory to encode the picture");
    write_file_atomically(file, bytes);
}

void write_jpeg(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, int quality) {
    std::vector<std::byte> bytes;
    if (!stbi_write_jpg_to_func(append, &bytes, srgb.size.x, srgb.size.y, 3, srgb.pixels.data(), quality))
        fail(ExitCode::out_of_memory, file.string(), "no memory to encode the picture");
    write_file_atomically(file, bytes);
}
}
