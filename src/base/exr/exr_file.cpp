#include "base/exr/exr_file.h"

#include "base/error.h"
#include "base/exr/exr_attributes.h"
#include "base/exr/exr_check.h"
#include "base/exr/exr_stream.h"
#include "base/io/file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>

namespace tyndall {
namespace {
constexpr uint64_t largest_file = uint64_t{4} << 30;

// True if the file's bytes still match its tyndall:check hash.
bool is_unchanged(std::string_view bytes) {
    const size_t name = bytes.find(before_check), value = name + before_check.size();
    if (name == bytes.npos || value + no_check.size() > bytes.size()) return false;
    const std::string_view pieces[] = {bytes.substr(0, value), no_check, bytes.substr(value + no_check.size())};
    return content_hash(pieces) == bytes.substr(value, no_check.size());
}

// Windows, attributes and channel names from the header.
ExrFile described(const Imf::Header& header) {
    const Imath::Box2i &window = header.dataWindow(), &display = header.displayWindow();
    ExrFile result;
    result.display = ivec2(display.max.x - display.min.x, display.max.y - display.min.y) + 1;
    result.low = {window.min.x - display.min.x, window.min.y - display.min.y};
    result.size = ivec2(window.max.x - window.min.x, window.max.y - window.min.y) + 1;
    for (auto a = header.begin(); a != header.end(); ++a) result.attributes[a.name()] = attribute_text(a.attribute());
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        result.channels.emplace_back(c.name(), Image<float>());
    return result;
}

// Decodes all channels of `count` rows as floats.
void decode_rows(Imf::InputFile& input, int first, int count, ExrFile& file) {
    const Imath::Box2i window = input.header().dataWindow();
    const Imath::Box2i rows({window.min.x, window.min.y + first}, {window.max.x, window.min.y + first + count - 1});
    Imf::FrameBuffer buffer;
    for (auto& [name, image] : file.channels) {
        image = Image<float>(ivec2(file.size.x, count));
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, image.pixels.data(), rows, sizeof(float),
                                             sizeof(float) * static_cast<size_t>(file.size.x)));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(rows.min.y, rows.max.y);
}

ExrFile read_checked(std::string_view bytes, const std::string& file, bool pixels) {
    const ExrHeaders claims = read_exr_headers(bytes, file);
    if (claims.multipart) refuse(file, "multi-part files are not supported");
    if (std::ranges::any_of(claims.parts[0].channels, [](const ExrChannelClaim& c) { return c.step != 1; }))
        refuse(file, "subsampled channels are not supported");
    check_exr_blocks(bytes, claims, 0, file);
    return guarded_exr(file, [&] {
        ExrStream stream(file, bytes);
        Imf::InputFile input(stream, 0);
        ExrFile result = described(input.header());
        result.compression = name_of(claims.parts[0].compression);
        result.is_unchanged = is_unchanged(bytes);
        if (pixels) decode_rows(input, 0, result.size.y, result);
        return result;
    });
}
}

const Image<float>* ExrFile::channel(std::string_view name) const {
    for (const auto& [own_name, image] : channels)
        if (own_name == name) return &image;
    return nullptr;
}

ExrFile read_exr(const std::filesystem::path& file) {
    return read_checked(read_file(file, largest_file), file.string(), true);
}

ExrFile read_exr_header(const std::filesystem::path& file) {
    return read_checked(read_file(file, largest_file), file.string(), false);
}

ExrFile read_exr_rows(const std::filesystem::path& file, int first, int count) {
    check_readable(file);
    return guarded_exr(file.string(), [&] {
        Imf::InputFile input(file.c_str(), 0);
        ExrFile result = described(input.header());
        if (first + count > result.size.y) refuse(file.string(), "was changed while it was being read");
        decode_rows(input, first, count, result);
        return result;
    });
}

Image<vec3> color_of(const ExrFile& exr, std::string_view layer) {
    Image<vec3> color(exr.size);
    const std::string prefix = layer.empty() ? "" : std::string(layer) + ".";
    for (int c = 0; c < 3; ++c)
        if (const Image<float>* channel = exr.channel(prefix + "RGB"[c]))
            for (size_t i = 0; i < color.pixels.size(); ++i) color.pixels[i][c] = channel->pixels[i];
    return color;
}
}
