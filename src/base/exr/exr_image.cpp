#include "base/exr/exr_image.h"

#include "base/exr/exr_check.h"
#include "base/exr/exr_stream.h"

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfRgbaFile.h>

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr int largest_picture_side = 16384;

const ExrChannelClaim* channel_of(const ExrPartHeader& part, std::string_view name) {
    const auto found = std::ranges::find(part.channels, name, &ExrChannelClaim::name);
    return found == part.channels.end() ? nullptr : &*found;
}

bool has_chroma(const ExrPartHeader& part) {
    return channel_of(part, "Y") && (channel_of(part, "RY") || channel_of(part, "BY"));
}

bool has_colors(const ExrPartHeader& part) {
    return std::ranges::any_of(std::array{"R", "G", "B", "Y"}, [&](const char* c) { return channel_of(part, c); });
}

// Names of the first few channels, for the error message.
std::string some_channels(const ExrPartHeader& part) {
    std::string text;
    for (size_t n = 0; n < std::min<size_t>(part.channels.size(), 4); ++n)
        text += (n ? ", " : "") + part.channels[n].name.substr(0, 60);
    return text + (part.channels.size() > 4 ? ", ..." : "");
}

struct Chosen {
    ExrHeaders claims;
    size_t index = 0;
    const ExrPartHeader& part() const { return claims.parts[index]; }
};

// Chooses the first part with color channels.
Chosen choose_part(std::string_view bytes, const std::string& where) {
    Chosen chosen{read_exr_headers(bytes, where), 0};
    const std::vector<ExrPartHeader>& parts = chosen.claims.parts;
    chosen.index = static_cast<size_t>(std::ranges::find_if(parts, has_colors) - parts.begin());
    if (chosen.index == parts.size())
        refuse(where, "the image has no channel R, G, B or Y; it has " + some_channels(parts[0]));
    const ExrPartHeader& part = chosen.part();
    if (part.cube) refuse(where, "the image is a cube map; convert it to latitude-longitude with exrenvmap");
    const ivec2 display = part.display_high - part.display_low + 1;
    if (std::max(display.x, display.y) > largest_picture_side)
        refuse(where, "the display window is larger than 16384 x 16384 pixels");
    const auto area = [](ivec2 size) { return int64_t{size.x} * size.y; };
    if (area(display) > 16 * area(part.high - part.low + 1) + (1 << 20))
        refuse(where, "the data window covers less than 1/16 of the display window");
    return chosen;
}

// Decodes full-resolution channels.
void decode_channels(Imf::IStream& stream, const Chosen& chosen, ExrImage& picture) {
    const ExrPartHeader& part = chosen.part();
    const bool colored = channel_of(part, "R") || channel_of(part, "G") || channel_of(part, "B");
    const Imath::Box2i window({part.low.x, part.low.y}, {part.high.x, part.high.y});
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; ++c) {
        const std::string name(1, colored ? "RGB"[c] : 'Y');
        if (!channel_of(part, name) || (!colored && c > 0)) continue;
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, &picture.color.pixels[0][c], window, sizeof(vec3),
                                             sizeof(vec3) * static_cast<size_t>(picture.color.size.x)));
    }
    Imf::MultiPartInputFile file(stream, 0);
    Imf::InputPart input(file, static_cast<int>(chosen.index));
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    if (colored) return;
    for (vec3& pixel : picture.color.pixels) pixel = vec3(pixel.x);
}

// Decodes luminance with subsampled chroma, which the library upsamples.
void decode_chroma(Imf::IStream& stream, ExrImage& picture) {
    Imf::RgbaInputFile input(stream, 0);
    const Imath::Box2i window = input.dataWindow();
    std::vector<Imf::Rgba> line(static_cast<size_t>(picture.color.size.x));
    for (int y = window.min.y; y <= window.max.y; ++y) {
        input.setFrameBuffer(line.data() - window.min.x, 1, 0);
        input.readPixels(y);
        for (int x = 0; x < picture.color.size.x; ++x) {
            const Imf::Rgba& pixel = line[static_cast<size_t>(x)];
            picture.color.at(x, y - window.min.y) = {pixel.r, pixel.g, pixel.b};
        }
    }
}
}

ivec2 exr_display_size(std::string_view bytes, const std::string& where) {
    const Chosen chosen = choose_part(bytes, where);
    return chosen.part().display_high - chosen.part().display_low + 1;
}

ExrImage decode_exr_image(std::string_view bytes, const std::string& where) {
    const Chosen chosen = choose_part(bytes, where);
    const ExrPartHeader& part = chosen.part();
    const bool chroma = has_chroma(part);
    for (const char* name : {"R", "G", "B", "Y"})
        if (const ExrChannelClaim* channel = channel_of(part, name); channel && channel->step != 1)
            refuse(where, std::string("the channel ") + name + " is subsampled; full resolution is required");
    if (chroma && chosen.claims.multipart)
        refuse(where, "luminance and chroma are supported only in single-part files");
    check_exr_blocks(bytes, chosen.claims, chosen.index, where);

    ExrImage picture{part.display_high - part.display_low + 1, part.low - part.display_low,
                     Image<vec3>(part.high - part.low + 1), part.foreign_primaries};
    guarded_exr(where, [&] {
        ExrStream stream(where, bytes);
        if (chroma)
            decode_chroma(stream, picture);
        else
            decode_channels(stream, chosen, picture);
    });
    return picture;
}
}
