// OpenEXR files read back, to the last pixel.
#include "base/error.h"
#include "base/io/file.h"
#include "render/image/exr_check.h"
#include "render/image/exr_header.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cstring>
#include <stdexcept>

namespace tyndall {
namespace {
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

// Whether the bytes are those that tyndall:check was made of.
bool is_unchanged(std::string bytes) {
    const size_t name = bytes.find(before_check), value = name + before_check.size();
    if (name == bytes.npos || value + no_check.size() > bytes.size()) return false;
    const std::string check = bytes.substr(value, no_check.size());
    return content_hash(bytes.replace(value, no_check.size(), no_check)) == check;
}

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
        ExrFile result = decoded(name, bytes, claims);
        result.is_unchanged = is_unchanged(bytes);
        return result;
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
