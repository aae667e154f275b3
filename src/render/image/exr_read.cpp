// OpenEXR files read back, to the last pixel.
#include "base/error.h"
#include "base/io/file.h"
#include "render/image/exr_header.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstring>
#include <stdexcept>

namespace tyndall {
namespace {
constexpr int largest_side = 16384, max_channels = 1024, max_attributes = 4096;
constexpr int largest_coordinate = 1 << 24;
constexpr uint64_t max_decoded_bytes = uint64_t{4} << 30;
constexpr uint64_t best_ratio = 1032; // of deflate; run lengths reach 64

enum : uint32_t { tiled_flag = 0x200, long_names_flag = 0x400, deep_flag = 0x800, multipart_flag = 0x1000 };

// What a file claims, read from its header before the library sees it.
struct ExrClaims {
    ivec2 display_low{0}, display_high{0};
    ivec2 low{0}, high{0}; // data window, both corners included
    int compression = 0;   // 0 none, 1 RLE, 2 ZIPS, 3 ZIP
    int channels = 0;
    uint64_t bytes_per_pixel = 0;
};

struct Cursor {
    std::string_view left;
    const std::string& file;

    std::string_view bytes(size_t count) {
        if (count > left.size()) refuse(file, "the file ends inside its header");
        const std::string_view result = left.substr(0, count);
        left.remove_prefix(count);
        return result;
    }
    int32_t integer() {
        int32_t value;
        std::memcpy(&value, bytes(4).data(), 4);
        return value;
    }
    std::string_view name() {
        const size_t end = left.substr(0, 256).find('\0');
        if (end == std::string_view::npos) refuse(file, "the header holds a name without an end");
        const std::string_view result = bytes(end);
        bytes(1);
        return result;
    }
};

void read_channels(Cursor cursor, ExrClaims& claims) {
    while (!cursor.name().empty()) {
        const int type = cursor.integer();
        cursor.bytes(4); // perceptual flag, reserved
        const int step_x = cursor.integer(), step_y = cursor.integer();
        if (type < 0 || type > 2) refuse(cursor.file, "a channel has an unknown pixel type");
        if (step_x != 1 || step_y != 1) refuse(cursor.file, "channels of reduced resolution are not read");
        if (++claims.channels > max_channels) refuse(cursor.file, "more than 1024 channels");
        claims.bytes_per_pixel += type == 1 ? 2 : 4;
    }
    if (claims.channels == 0) refuse(cursor.file, "there are no channels");
}

void read_window(Cursor cursor, ivec2& low, ivec2& high) {
    if (cursor.left.size() != 16) refuse(cursor.file, "a window has the wrong size");
    low.x = cursor.integer(), low.y = cursor.integer(), high.x = cursor.integer(), high.y = cursor.integer();
    for (const int c : {low.x, low.y, high.x, high.y})
        if (c < -largest_coordinate || c > largest_coordinate) refuse(cursor.file, "a window is out of range");
    if (low.x > high.x || low.y > high.y) refuse(cursor.file, "a window is empty");
}

void read_compression(Cursor cursor, ExrClaims& claims) {
    claims.compression = static_cast<unsigned char>(cursor.bytes(1)[0]);
    if (claims.compression > 3) refuse(cursor.file, "only the compressions NONE, RLE, ZIPS and ZIP are read");
}

// A name of `type` that is there once; other attributes with that name are refused.
void expect_type(std::string_view name, std::string_view type, std::string_view expected, bool& seen,
                 const std::string& file) {
    if (type != expected) refuse(file, "the attribute " + std::string(name) + " has the wrong type");
    if (seen) refuse(file, "the attribute " + std::string(name) + " is there twice");
    seen = true;
}

void check_flags(Cursor& cursor) {
    if (cursor.left.size() < 8 || cursor.integer() != 20000630) refuse(cursor.file, "this is not an OpenEXR file");
    const uint32_t version = static_cast<uint32_t>(cursor.integer());
    if ((version & 0xff) != 2) refuse(cursor.file, "an OpenEXR version other than 2");
    if (version & deep_flag) refuse(cursor.file, "deep pictures are not read");
    if (version & multipart_flag) refuse(cursor.file, "files of several parts are not read");
    if (version & tiled_flag) refuse(cursor.file, "tiled pictures are not read");
    if (version & ~(0xffu | long_names_flag)) refuse(cursor.file, "the header has unknown flags");
}

// The pixels must fit in memory, and no compression may have made the file as small as it is if it is too small.
void check_amount(const ExrClaims& claims, uint64_t file_bytes, const std::string& file) {
    const ivec2 size = claims.high - claims.low + 1;
    if (size.x > largest_side || size.y > largest_side) refuse(file, "the picture is larger than 16384 x 16384 pixels");
    const uint64_t pixels = static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y);
    if (pixels * static_cast<uint64_t>(claims.channels) * sizeof(float) > max_decoded_bytes)
        refuse(file, "the picture would need more than 4 GiB of memory");
    if (pixels * claims.bytes_per_pixel / best_ratio > file_bytes)
        refuse(file, "the file is too short for its picture: cut off or damaged");
}

// Walks the header. Throws Error (refused) unless the file is a flat, single-part scanline picture of a supported
// compression, within limits, whose pixels can fit in bytes as few as these.
ExrClaims check_exr_claims(std::string_view bytes, const std::string& file) {
    Cursor cursor{bytes, file};
    check_flags(cursor);

    ExrClaims claims;
    bool channels = false, window = false, display = false, compression = false;
    for (int count = 0;; ++count) {
        const std::string_view name = cursor.name();
        if (name.empty()) break;
        if (count == max_attributes) refuse(file, "the header has more than 4096 attributes");
        const std::string_view type = cursor.name();
        const int32_t size = cursor.integer();
        if (size < 0) refuse(file, "an attribute has a negative size");
        const Cursor value{cursor.bytes(static_cast<size_t>(size)), file};

        if (name == "channels") {
            expect_type(name, type, "chlist", channels, file);
            read_channels(value, claims);
        } else if (name == "dataWindow") {
            expect_type(name, type, "box2i", window, file);
            read_window(value, claims.low, claims.high);
        } else if (name == "displayWindow") {
            expect_type(name, type, "box2i", display, file);
            read_window(value, claims.display_low, claims.display_high);
        } else if (name == "compression") {
            expect_type(name, type, "compression", compression, file);
            read_compression(value, claims);
        } else if (name == "type" && value.left != "scanlineimage") {
            refuse(file, "only scanline pictures are read");
        }
    }
    if (!channels || !window || !display || !compression)
        refuse(file, "the header lacks channels, dataWindow, displayWindow or compression");
    check_amount(claims, bytes.size(), file);
    return claims;
}
constexpr uint64_t largest_file = uint64_t{4} << 30;

class MemoryStream : public Imf::IStream {
public:
    MemoryStream(const char* name, std::string_view bytes) : IStream(name), bytes_(bytes) {}
    bool read(char* to, int count) override {
        if (count < 0 || static_cast<size_t>(count) > bytes_.size() - position_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, bytes_.data() + position_, static_cast<size_t>(count));
        position_ += static_cast<size_t>(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = std::min<uint64_t>(position, bytes_.size()); }

private:
    std::string_view bytes_;
    size_t position_ = 0;
};

ExrFile decoded(const std::string& file, std::string_view bytes, const ExrClaims& claims) {
    MemoryStream stream(file.c_str(), bytes);
    Imf::InputFile input(stream, 0);
    const Imf::Header& header = input.header();
    const Imath::Box2i window = header.dataWindow();

    constexpr const char* compressions[] = {"none", "rle", "zips", "zip"};
    ExrFile result;
    result.compression = compressions[claims.compression];
    result.display = claims.display_high - claims.display_low + 1;
    result.low = claims.low - claims.display_low;
    result.size = claims.high - claims.low + 1;
    for (auto a = header.begin(); a != header.end(); ++a) result.attributes[a.name()] = attribute_text(a.attribute());

    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        result.channels.emplace_back(c.name(), Image<float>(result.size));
    Imf::FrameBuffer buffer;
    for (auto& [name, image] : result.channels)
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, image.pixels.data(), window, sizeof(float),
                                             sizeof(float) * static_cast<size_t>(result.size.x)));
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    return result;
}
}

const Image<float>* ExrFile::channel(std::string_view name) const {
    for (const auto& [own_name, image] : channels)
        if (own_name == name) return &image;
    return nullptr;
}

ExrFile read_exr(const std::filesystem::path& file) {
    const std::string name = file.string();
    const std::string bytes = read_file(file, largest_file);
    const ExrClaims claims = check_exr_claims(bytes, name);
    try {
        return decoded(name, bytes, claims);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(name, std::string("damaged: ") + error.what());
    }
}

Image<vec3> color_of(const ExrFile& exr) {
    Image<vec3> color(exr.size);
    constexpr std::string_view names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        if (const Image<float>* channel = exr.channel(names[c]))
            for (size_t i = 0; i < color.pixels.size(); ++i) color.pixels[i][c] = channel->pixels[i];
    return color;
}
}
