// Encodes layers as an OpenEXR file in memory, then writes it to disk.
#include "base/error.h"
#include "base/exr/exr_attributes.h"
#include "base/io/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/image/exr_header.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <half.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <deque>
#include <set>

namespace tyndall {
namespace {
// A stream in memory. OpenEXR writes the line offset table last, over its placeholder among the bytes already there.
class MemoryStream : public Imf::OStream {
public:
    MemoryStream(const char* name, size_t room) : OStream(name) { data.reserve(room); }
    void write(const char* bytes, int count) override {
        const size_t end = position_ + static_cast<size_t>(count);
        if (end > data.size()) data.resize(end);
        std::memcpy(data.data() + position_, bytes, static_cast<size_t>(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    std::vector<std::byte> data;

private:
    uint64_t position_ = 0;
};

bool wants(const ExrOptions& options, std::string_view layer) {
    return std::ranges::find(options.layers, layer) != options.layers.end();
}

// Layer names for lights: letters, digits and _ only, unique, at most 31 bytes as `light_NAME.R`.
std::vector<std::string> light_layer_names(const Layers& layers) {
    std::vector<std::string> result;
    std::set<std::string> taken;
    for (const auto& [light, image] : layers.lights) {
        std::string name = "light_";
        for (const char c : light) {
            const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
            name += plain ? c : '_';
        }
        const std::string base = name.substr(0, 29);
        name = base;
        for (int n = 2; !taken.insert(name).second; ++n) {
            const std::string suffix = "_" + std::to_string(n);
            name = base.substr(0, 29 - suffix.size()) + suffix;
        }
        result.push_back(name);
    }
    return result;
}

void add_color(std::vector<ExrChannel>& channels, const std::string& prefix, const Image<vec3>& image,
               bool full_float) {
    const float* first = image.empty() ? nullptr : &image.pixels[0].x;
    for (int c = 0; c < 3; ++c) channels.push_back({prefix + "RGB"[c], first ? first + c : nullptr, 3, full_float});
}

void add_value(std::vector<ExrChannel>& channels, const std::string& name, const Image<float>& image, bool full_float) {
    channels.push_back({name, image.pixels.data(), 1, full_float});
}

// The channels of a file. `depth` holds what goes into Z.
std::vector<ExrChannel> make_channels(const Layers& layers, const Image<float>& depth, const ExrOptions& options) {
    const bool wide = options.full_float;
    std::vector<ExrChannel> channels;
    add_color(channels, "", layers.color, wide);
    add_value(channels, "A", layers.alpha, wide);
    if (wants(options, "Z")) add_value(channels, "Z", depth, true);
    const std::pair<const char*, const Image<vec3>*> colors[] = {
        {"surface", &layers.surface}, {"background", &layers.background}, {"inscatter", &layers.inscatter},
        {"ambient", &layers.ambient}, {"emission", &layers.emission},     {"multiple", &layers.multiple}};
    for (const auto& [name, image] : colors)
        if (wants(options, name)) add_color(channels, std::string(name) + ".", *image, wide);
    if (wants(options, "transmittance")) add_value(channels, "transmittance.T", layers.transmittance, wide);
    if (wants(options, "transmittance") && !layers.channel_transmittance.empty())
        add_color(channels, "transmittance.", layers.channel_transmittance, wide);
    if (wants(options, "validity")) add_value(channels, "validity.T", layers.validity, wide);
    if (wants(options, "variance")) add_color(channels, "Variance.", layers.variance, true);
    if (wants(options, "halves")) {
        add_color(channels, "half_a.", layers.half_a, true);
        add_color(channels, "half_b.", layers.half_b, true);
    }
    if (!wants(options, "lights")) return channels;

    const std::vector<std::string> names = light_layer_names(layers);
    for (size_t i = 0; i < names.size(); ++i) add_color(channels, names[i] + ".", layers.lights[i].second, wide);
    return channels;
}

float clamped_to_half(float value) { return std::clamp(value, -65504.0f, 65504.0f); }

std::vector<half> as_half(const ExrChannel& channel, size_t count, uint64_t& clamped) {
    std::vector<half> result(count);
    for (size_t i = 0; i < count; ++i) {
        const float value = channel.values[i * channel.stride], inside = clamped_to_half(value);
        clamped += inside != value;
        result[i] = inside;
    }
    return result;
}

// Writes the file's hash over its placeholder in the header.
void add_check(std::vector<std::byte>& file) {
    const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
    const std::string hash = content_hash(bytes);
    std::memcpy(file.data() + bytes.find(before_check) + before_check.size(), hash.data(), hash.size());
}

std::vector<std::byte> encoded(const std::filesystem::path& file, const ExrWindow& frame,
                               std::span<const ExrChannel> channels, const Provenance& provenance, ExrPacking packing) {
    for ([[maybe_unused]] const ExrChannel& channel : channels) assert(channel.values); // the layer was rendered

    // Slices point at the image's own floats, or at halves made here.
    Imf::Header header = make_exr_header(frame, provenance);
    if (packing == ExrPacking::none) header.compression() = Imf::NO_COMPRESSION;
    if (packing == ExrPacking::run_lengths) header.compression() = Imf::RLE_COMPRESSION;
    const Imath::Box2i window = header.dataWindow();
    const size_t width = static_cast<size_t>(frame.size.x), count = width * static_cast<size_t>(frame.size.y);
    Imf::FrameBuffer buffer;
    std::deque<std::vector<half>> halves;
    uint64_t clamped = 0;
    for (const ExrChannel& channel : channels) {
        const Imf::PixelType type = channel.full_float ? Imf::FLOAT : Imf::HALF;
        const void* first = channel.values;
        size_t step = channel.stride * sizeof(float);
        if (!channel.full_float) {
            first = halves.emplace_back(as_half(channel, count, clamped)).data();
            step = sizeof(half);
        }
        header.channels().insert(channel.name, Imf::Channel(type));
        buffer.insert(channel.name, Imf::Slice::Make(type, first, window, step, step * width));
    }
    header.insert("tyndall:clamped", Imf::StringAttribute(std::to_string(clamped)));
    header.insert(check_name, Imf::StringAttribute(std::string(no_check)));

    MemoryStream stream(file.c_str(), count * channels.size() * sizeof(float));
    {
        // Compresses blocks of lines in parallel; 0 = on the calling thread.
        const int threads = thread_count() > 1 ? thread_count() : 0;
        Imf::setGlobalThreadCount(threads);
        Imf::OutputFile output(stream, header, threads);
        output.setFrameBuffer(buffer);
        output.writePixels(frame.size.y);
    }
    add_check(stream.data);
    return std::move(stream.data);
}
}

const std::vector<std::string>& layer_names() {
    static const std::vector<std::string> names{"Z",        "surface",  "background", "inscatter",     "lights",
                                                "ambient",  "emission", "multiple",   "transmittance", "validity",
                                                "variance", "halves"};
    return names;
}

void check_layer_names(const ExrOptions& options) {
    const std::vector<std::string>& known = layer_names();
    for (const std::string& name : options.layers)
        if (std::ranges::find(known, name) == known.end())
            fail(ExitCode::usage, "--aov", unknown_name("layer", name, known));
}

std::vector<std::string> channel_names(const std::vector<std::string>& lights, bool colored_fog,
                                       const ExrOptions& options) {
    Layers layers;
    if (colored_fog) layers.channel_transmittance = Image<vec3>(ivec2(1));
    for (const std::string& light : lights)
        if (std::ranges::find(layers.lights, light, [](const auto& l) { return l.first; }) == layers.lights.end())
            layers.lights.emplace_back(light, Image<vec3>());
    std::vector<std::string> names;
    for (const ExrChannel& channel : make_channels(layers, layers.depth, options)) names.push_back(channel.name);
    std::ranges::sort(names);
    return names;
}

Image<vec3> stored_color(const Layers& layers, const ExrOptions& options) {
    Image<vec3> result = layers.color;
    if (options.full_float) return result;
    for (vec3& color : result.pixels)
        for (int c = 0; c < 3; ++c) color[c] = half(clamped_to_half(color[c]));
    return result;
}

void write_exr(const std::filesystem::path& file, const Layers& layers, const Provenance& given,
               const ExrOptions& options) {
    check_layer_names(options);
    Image<float> depth = layers.depth;
    for (float& z : depth.pixels)
        if (std::isinf(z)) z = no_surface_z;
    Provenance provenance = given;
    if (wants(options, "lights")) {
        std::string& names = provenance.attributes["tyndall:lights"];
        for (const std::string& name : light_layer_names(layers)) names += (names.empty() ? "" : " ") + name;
    }
    write_exr_channels(file, {layers.display, layers.low, layers.size}, make_channels(layers, depth, options),
                       provenance);
}

void write_exr_channels(const std::filesystem::path& file, const ExrWindow& window,
                        std::span<const ExrChannel> channels, const Provenance& provenance, ExrPacking packing) {
    std::vector<std::byte> bytes;
    try {
        bytes = encoded(file, window, channels, provenance, packing);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail(ExitCode::internal, file.string(), error.what());
    }
    write_file_atomically(file, bytes);
}
}
