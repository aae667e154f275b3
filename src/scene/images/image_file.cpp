#include "scene/images/image_file.h"

#include "base/error.h"
#include "base/exr/exr_image.h"
#include "base/io/file.h"
#include "base/srgb.h"
#include "base/text.h"
#include "scene/images/radiance_file.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace tyndall {
namespace {
struct Free {
    void operator()(void* memory) const { stbi_image_free(memory); }
};

constexpr const char* not_an_image = "the image is neither PNG, JPEG, Radiance .hdr nor OpenEXR";

const stbi_uc* start(std::string_view bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

int big_endian(std::string_view bytes) {
    uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return static_cast<int>(std::min(value, 0x7fffffffu));
}

void check_length(std::string_view bytes, std::string_view where) {
    if (bytes.size() > size_t{1} << 30) refuse(where, "the image file is over 1 GiB");
}

// stb_image's failure reasons are internal terms, not fit for users.
[[noreturn]] void refuse_damaged(std::string_view where) {
    const std::string_view reason = stbi_failure_reason() ? stbi_failure_reason() : "";
    refuse(where, reason == "outofdata" ? "the image is truncated" : "the image is truncated or damaged");
}

// Linear light of each sRGB code of 8 or 16 bits.
const float* lights_of(const uint8_t*) { return srgb_lights().data(); }
const float* lights_of(const uint16_t*) {
    static const std::vector<float> lights = [] {
        std::vector<float> values(65536);
        for (size_t i = 0; i < values.size(); ++i) values[i] = srgb_decoded(static_cast<float>(i) / 65535.0f);
        return values;
    }();
    return lights.data();
}

// Calls `visit` with the index, color in 0..1 and alpha of every texel; `linear`: the color is not sRGB.
template<class Code, class Visit> void visit_codes(const Code* codes, ivec2 size, bool linear, const Visit& visit) {
    constexpr auto last = static_cast<float>(std::numeric_limits<Code>::max());
    const float* lights = lights_of(codes);
    const auto color = [&](Code code) { return linear ? static_cast<float>(code) / last : lights[code]; };
    for (size_t i = 0; i < static_cast<size_t>(size.x) * size.y; ++i, codes += 4)
        visit(i, vec3(color(codes[0]), color(codes[1]), color(codes[2])), static_cast<float>(codes[3]) / last);
}

// Calls `use` with the RGBA codes of a PNG or JPEG, which have 16 bits if the PNG does, and its size. Throws Error
// (refused) naming `where`.
template<class Use> void with_codes(std::string_view bytes, std::string_view where, const Use& use) {
    const int length = static_cast<int>(bytes.size());
    ivec2 size(0);
    int channels;
    const auto checked = [&](auto* codes) {
        const std::unique_ptr<std::remove_pointer_t<decltype(codes)>, Free> data(codes);
        if (!data) refuse_damaged(where);
        use(codes, size);
    };
    if (stbi_is_16_bit_from_memory(start(bytes), length))
        checked(stbi_load_16_from_memory(start(bytes), length, &size.x, &size.y, &channels, 4));
    else
        checked(stbi_load_from_memory(start(bytes), length, &size.x, &size.y, &channels, 4));
}

// visit_codes() for a PNG or JPEG.
template<class Visit>
void visit_texels(std::string_view bytes, std::string_view where, bool linear, const Visit& visit) {
    with_codes(bytes, where, [&](auto* codes, ivec2 size) { visit_codes(codes, size, linear, visit); });
}

// In the display window, black where the file has no pixels.
Image<vec3> decode_openexr(std::string_view bytes, std::string_view where, std::string& note) {
    const ExrImage file = decode_exr_image(bytes, std::string(where));
    if (file.foreign_primaries) note = "its primaries are not Rec.709; its colors are used without conversion";
    Image<vec3> image(file.display);
    const ivec2 begin = glm::max(file.low, ivec2(0)), end = glm::min(file.low + file.color.size, file.display);
    for (int y = begin.y; y < end.y; ++y)
        for (int x = begin.x; x < end.x; ++x) image.at(x, y) = file.color.at(x - file.low.x, y - file.low.y);
    return image;
}

bool holds_floats(ImageFormat format) { return format == ImageFormat::radiance || format == ImageFormat::openexr; }

void add_note(std::string& note, const std::string& more) { note += (note.empty() ? "" : "; ") + more; }

// A sun beyond the largest half float is infinite in files of halves; it is read as that or as the brightest other
// value.
void cut_infinite(Image<vec3>& image, std::string& note) {
    float largest = 65504;
    size_t infinite = 0;
    for (const vec3& pixel : image.pixels)
        for (int c = 0; c < 3; ++c)
            if (std::isfinite(pixel[c])) largest = std::max(largest, pixel[c]);
    for (vec3& pixel : image.pixels)
        if (glm::any(glm::equal(pixel, vec3(infinity)))) pixel = glm::min(pixel, vec3(largest)), ++infinite;
    if (infinite > 0) add_note(note, count_text(infinite, "infinite pixel") + ", read as " + shortest_text(largest));
}

void check_finite(const Image<vec3>& image, std::string_view where) {
    const auto broken = [](const vec3& pixel) { return !is_finite(pixel); };
    const auto first = std::ranges::find_if(image.pixels, broken);
    if (first == image.pixels.end()) return;
    const auto index = static_cast<int>(first - image.pixels.begin());
    const auto count = static_cast<size_t>(std::count_if(first, image.pixels.end(), broken));
    refuse(where, count_text(count, "pixel") + (count == 1 ? " is" : " are") + " not finite (-inf or NaN), " +
                      (count == 1 ? "" : "the first one ") + "at x " + std::to_string(index % image.size.x) + ", y " +
                      std::to_string(index / image.size.x) +
                      " from the upper left; give them a value, for example with oiiotool --fixnan box3");
}

Image<vec3> decode_floats(std::string_view bytes, std::string_view where, std::string& note) {
    Image<vec3> image = image_format(bytes) == ImageFormat::radiance ? decode_radiance(bytes, where, note)
                                                                     : decode_openexr(bytes, where, note);
    cut_infinite(image, note);
    check_finite(image, where);
    return image;
}
}

ImageFormat image_format(std::string_view bytes) {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return ImageFormat::png;
    if (bytes.starts_with("\xff\xd8\xff")) return ImageFormat::jpeg;
    if (is_radiance(bytes)) return ImageFormat::radiance;
    if (bytes.starts_with("\x76\x2f\x31\x01")) return ImageFormat::openexr;
    return ImageFormat::other;
}

ivec2 image_size(std::string_view bytes, std::string_view where) {
    check_length(bytes, where);
    if (image_format(bytes) == ImageFormat::openexr) return exr_display_size(bytes, std::string(where));
    ivec2 size(0);
    int channels;
    if (image_format(bytes) == ImageFormat::png && bytes.size() >= 24) {
        size = {big_endian(bytes.substr(16)), big_endian(bytes.substr(20))};
    } else if (image_format(bytes) == ImageFormat::radiance) {
        size = radiance_size(bytes, where);
    } else if (!stbi_info_from_memory(start(bytes), static_cast<int>(bytes.size()), &size.x, &size.y, &channels)) {
        refuse_damaged(where);
    }
    const std::string pixels = "the image has " + std::to_string(size.x) + "x" + std::to_string(size.y) + " pixels; ";
    if (size.x < 1 || size.y < 1) refuse(where, pixels + "at least 1 on a side is needed");
    if (std::max(size.x, size.y) > largest_image_side) refuse(where, pixels + "at most 16384 on a side can be used");
    return size;
}

Texels decode_texture(std::string_view bytes, std::string_view where) {
    const ImageFormat format = image_format(bytes);
    if (format != ImageFormat::png && format != ImageFormat::jpeg) refuse(where, "the image is neither PNG nor JPEG");
    image_size(bytes, where);
    Texels texels;
    with_codes(bytes, where, [&](auto* codes, ivec2 size) {
        if constexpr (sizeof *codes == 1) {
            texels.codes = Image<Code4>(size);
            std::memcpy(texels.codes.pixels.data(), codes, texels.bytes());
        } else {
            texels.linear = Image<vec4>(size);
            visit_codes(codes, size, false, [&](size_t i, vec3 color, float alpha) {
                texels.linear.pixels[i] = {color, alpha};
            });
        }
    });
    return texels;
}

Image<vec3> decode_image(std::string_view bytes, std::string_view where, std::string& note) {
    const ImageFormat format = image_format(bytes);
    if (format == ImageFormat::other) refuse(where, not_an_image);
    if (holds_floats(format)) {
        image_size(bytes, where);
        Image<vec3> image = decode_floats(bytes, where, note);
        size_t negative = 0;
        for (vec3& pixel : image.pixels)
            if (glm::any(glm::lessThan(pixel, vec3(0)))) pixel = glm::max(pixel, vec3(0)), ++negative;
        if (negative > 0) add_note(note, count_text(negative, "pixel") + " with negative values, set to 0");
        if (std::ranges::all_of(image.pixels, [](vec3 pixel) { return pixel == vec3(0); }))
            add_note(note, "the image is black");
        return image;
    }
    Image<vec3> image(image_size(bytes, where));
    visit_texels(bytes, where, false, [&](size_t i, vec3 color, float alpha) { image.pixels[i] = color * alpha; });
    return image;
}

namespace {
// Adds a pixel's share to its block's mean.
void add_to_block(ReducedImage& picture, size_t pixel, vec3 color) {
    const float share = 1 / static_cast<float>(picture.factor * picture.factor);
    const int x = static_cast<int>(pixel % picture.size.x), y = static_cast<int>(pixel / picture.size.x);
    picture.image.at(x / picture.factor, y / picture.factor) += share * color;
}
}

ReducedImage decode_reduced(std::string_view bytes, bool linear, int largest, int most, std::string_view where,
                            std::string& note) {
    const ImageFormat format = image_format(bytes);
    if (format == ImageFormat::other) refuse(where, not_an_image);
    ReducedImage picture{image_size(bytes, where), 1, {}};
    const int side = std::max(picture.size.x, picture.size.y), limit = largest / (holds_floats(format) ? 2 : 1);
    if (side > limit)
        refuse(where, "the image has " + std::to_string(picture.size.x) + "x" + std::to_string(picture.size.y) +
                          " pixels; at most " + std::to_string(limit) + " on a side can be used here");
    picture.factor = (side + most - 1) / most;
    picture.image = Image<vec3>((picture.size + picture.factor - 1) / picture.factor);
    if (holds_floats(format)) {
        const Image<vec3> pixels = decode_floats(bytes, where, note);
        for (size_t i = 0; i < pixels.pixels.size(); ++i) add_to_block(picture, i, pixels.pixels[i]);
    } else {
        visit_texels(bytes, where, linear,
                     [&](size_t i, vec3 color, float alpha) { add_to_block(picture, i, color * alpha); });
    }
    return picture;
}
}
