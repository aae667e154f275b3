#include "scene/images/radiance_file.h"

#include "base/error.h"
#include "base/text.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace tyndall {
namespace {
constexpr int64_t max_pixels = int64_t{1} << 27;

// One axis of the resolution line, such as "-Y 512".
struct Axis {
    char name = 0;
    bool backwards = false;
    int size = 0;

    int place(int index) const { return backwards ? size - 1 - index : index; }
};

struct Header {
    Axis across_lines, along_line; // relative to the file's scanlines
    vec3 multiplied{1};
    size_t pixels_at = 0;

    bool is_upright() const { return across_lines.name == 'Y'; }
    ivec2 size() const {
        return is_upright() ? ivec2(along_line.size, across_lines.size) : ivec2(across_lines.size, along_line.size);
    }
};

[[noreturn]] void refuse_cut_off(std::string_view where) { refuse(where, "the image is truncated"); }

// The next line, without its line ending.
std::string_view next_line(std::string_view bytes, size_t& at, std::string_view where) {
    constexpr size_t longest = 65536;
    const size_t end = bytes.substr(0, at + longest).find('\n', at);
    if (end == bytes.npos) refuse_cut_off(where);
    std::string_view line = bytes.substr(at, end - at);
    at = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string_view next_word(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end);
    return word;
}

float factor_of(std::string_view& text, std::string_view line, std::string_view where) {
    const std::string_view word = next_word(text);
    const std::optional<float> value = parsed<float>(word);
    if (!value || !(*value > 0) || !std::isfinite(*value))
        refuse(where, "\"" + printable(line, 60) + "\" in the header is not a factor above 0");
    return *value;
}

Axis next_axis(std::string_view& text) {
    const std::string_view name = next_word(text), size = next_word(text);
    Axis axis;
    if (name.size() != 2 || (name[0] != '+' && name[0] != '-') || (name[1] != 'X' && name[1] != 'Y')) return {};
    axis.name = name[1], axis.backwards = (name[0] == '-') == (name[1] == 'X'); // -Y runs down, as rows do
    axis.size = parsed<int>(size).value_or(0);
    return axis;
}

Header read_header(std::string_view bytes, std::string_view where) {
    Header header;
    for (std::string_view line; !(line = next_line(bytes, header.pixels_at, where)).empty();) {
        const size_t equals = std::min(line.find('='), line.size() - 1);
        const std::string_view name = line.substr(0, equals);
        std::string_view value = line.substr(equals + 1);
        if (name == "FORMAT" && next_word(value) != "32-bit_rle_rgbe")
            refuse(where, "its pixel format is not 32-bit_rle_rgbe, but \"" + printable(line, 60) + "\"");
        if (name == "EXPOSURE") header.multiplied *= factor_of(value, line, where);
        if (name == "COLORCORR")
            for (int c = 0; c < 3; ++c) header.multiplied[c] *= factor_of(value, line, where);
    }
    const std::string_view resolution = next_line(bytes, header.pixels_at, where);
    std::string_view rest = resolution;
    header.across_lines = next_axis(rest), header.along_line = next_axis(rest);
    if (header.across_lines.size < 1 || header.along_line.size < 1 ||
        header.across_lines.name == header.along_line.name)
        refuse(where, "\"" + printable(resolution, 60) + "\" is not a resolution such as \"-Y 512 +X 1024\"");
    return header;
}

using Rgbe = std::array<uint8_t, 4>;

// The unread part of the file.
struct Bytes {
    std::string_view rest;
    std::string_view where;

    uint8_t next() {
        if (rest.empty()) refuse_cut_off(where);
        const uint8_t byte = static_cast<uint8_t>(rest[0]);
        rest.remove_prefix(1);
        return byte;
    }
    Rgbe pixel() {
        Rgbe result;
        for (uint8_t& byte : result) byte = next();
        return result;
    }
};

// New run-length encoding: each of the four components separately, as runs of one value or literal values.
void read_planes(Bytes& bytes, std::vector<Rgbe>& line) {
    for (size_t plane = 0; plane < 4; ++plane)
        for (size_t i = 0; i < line.size();) {
            const uint8_t code = bytes.next();
            const bool run = code > 128;
            const size_t count = run ? code - 128u : code;
            if (count == 0 || count > line.size() - i)
                refuse(bytes.where, "the image is damaged: a run exceeds its scanline");
            uint8_t value = run ? bytes.next() : 0;
            for (size_t k = 0; k < count; ++k) {
                if (!run) value = bytes.next();
                line[i++][plane] = value;
            }
        }
}

// Uncompressed, or old run-length encoding: 1 1 1 n repeats the previous pixel n times, and further such pixels give
// the higher bytes of n.
void read_pixels(Bytes& bytes, Rgbe first, std::vector<Rgbe>& line) {
    int shift = 0;
    for (size_t i = 0; i < line.size();) {
        const Rgbe pixel = i == 0 ? first : bytes.pixel();
        if (i == 0 || pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            line[i++] = pixel, shift = 0;
            continue;
        }
        const size_t count = shift < 32 ? size_t{pixel[3]} << shift : line.size();
        if (count > line.size() - i) refuse(bytes.where, "the image is damaged: a run exceeds its scanline");
        for (size_t k = 0; k < count; ++k, ++i) line[i] = line[i - 1];
        shift += 8;
    }
}

void read_line(Bytes& bytes, std::vector<Rgbe>& line) {
    const Rgbe first = bytes.pixel();
    const size_t length = size_t{first[2]} << 8 | first[3];
    if (first[0] == 2 && first[1] == 2 && first[2] < 128 && line.size() >= 8 && length == line.size())
        read_planes(bytes, line);
    else
        read_pixels(bytes, first, line);
}

vec3 light_of(Rgbe pixel) {
    if (pixel[3] == 0) return vec3(0);
    return std::ldexp(1.0f, pixel[3] - 136) * vec3(pixel[0], pixel[1], pixel[2]);
}
}

bool is_radiance(std::string_view bytes) { return bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE"); }

ivec2 radiance_size(std::string_view bytes, std::string_view where) { return read_header(bytes, where).size(); }

Image<vec3> decode_radiance(std::string_view bytes, std::string_view where, std::string& note) {
    const Header header = read_header(bytes, where);
    const ivec2 size = header.size();
    if (int64_t{size.x} * size.y > max_pixels)
        refuse(where, formatted("the image has %dx%d pixels; at most 134 million can be used", size.x, size.y));
    Bytes rest{bytes.substr(header.pixels_at), where};
    if (rest.rest.size() < 4 * static_cast<size_t>(header.across_lines.size)) refuse_cut_off(where);
    if (header.multiplied != vec3(1)) note = "pixels are divided by the EXPOSURE and COLORCORR of the header";

    Image<vec3> image(size);
    std::vector<Rgbe> line(static_cast<size_t>(header.along_line.size));
    for (int i = 0; i < header.across_lines.size; ++i) {
        read_line(rest, line);
        const int row = header.across_lines.place(i);
        for (int k = 0; k < header.along_line.size; ++k) {
            const int column = header.along_line.place(k);
            const ivec2 pixel = header.is_upright() ? ivec2(column, row) : ivec2(row, column);
            image.at(pixel.x, pixel.y) = light_of(line[static_cast<size_t>(k)]) / header.multiplied;
        }
    }
    return image;
}
}
