#include "render/image/png.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <cstdint>

namespace tyndall {
namespace {
void append(void* context, void* data, int size) {
    auto& bytes = *static_cast<std::vector<std::byte>*>(context);
    const auto* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

constexpr std::ptrdiff_t header_size = 8 + 25; // signature and IHDR

std::string big_endian(uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
}

// CRC-32 of ISO 3309.
uint32_t checksum(std::string_view bytes) {
    uint32_t sum = ~0u;
    for (const char byte : bytes) {
        sum ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum & 1 ? 0xedb88320u : 0);
    }
    return ~sum;
}

// A tEXt chunk (PNG specification): length, name and content, CRC of both.
std::string text_chunk(const std::string& keyword, const std::string& value) {
    const std::string content = keyword + '\0' + value, chunk = "tEXt" + content;
    return big_endian(static_cast<uint32_t>(content.size())) + chunk + big_endian(checksum(chunk));
}
}

PngText text_of(const Display& display) {
    return {{"tyndall:exposure", formatted("%.6g", display.exposure)},
            {"tyndall:viewTransform", name_of(display.transform)}};
}

void write_png(const std::filesystem::path& file, const Image<vec3>& linear, const Display& display) {
    write_png(file, display_codes(linear, display), text_of(display));
}

void write_png(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, const PngText& text) {
    static_assert(sizeof(glm::u8vec3) == 3);
    std::vector<std::byte> bytes;
    stbi_write_png_compression_level = 5;
    if (!stbi_write_png_to_func(append, &bytes, srgb.size.x, srgb.size.y, 3, srgb.pixels.data(), 3 * srgb.size.x))
        fail(ExitCode::out_of_memory, file.string(), "not enough memory to encode the image");
    for (const auto& [keyword, value] : text) {
        const std::string chunk = text_chunk(keyword, value);
        const auto* first = reinterpret_cast<const std::byte*>(chunk.data());
        bytes.insert(bytes.begin() + header_size, first, first + chunk.size());
    }
    write_file_atomically(file, bytes);
}

void write_jpeg(const std::filesystem::path& file, const Image<glm::u8vec3>& srgb, int quality) {
    std::vector<std::byte> bytes;
    if (!stbi_write_jpg_to_func(append, &bytes, srgb.size.x, srgb.size.y, 3, srgb.pixels.data(), quality))
        fail(ExitCode::out_of_memory, file.string(), "not enough memory to encode the image");
    write_file_atomically(file, bytes);
}
}
