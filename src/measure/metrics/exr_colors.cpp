#include "measure/metrics/exr_colors.h"

#include "base/error.h"
#include "base/text.h"
#include "render/image/exr.h"

namespace tyndall {
namespace {
using Channels = std::map<std::string, const Image<float>*>; // of one layer, by what follows the last dot

Image<vec3> gray_of(const Image<float>& value) {
    Image<vec3> result(value.size);
    for (size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] = vec3(value.pixels[i]);
    return result;
}

bool is_color(const Channels& channels) {
    return channels.contains("R") && channels.contains("G") && channels.contains("B");
}

[[noreturn]] void refuse_colorless(const std::string& file, const std::map<std::string, Channels>& layers) {
    std::vector<std::string> names;
    for (const auto& [layer, channels] : layers)
        for (const auto& channel : channels) names.push_back((layer.empty() ? "" : layer + ".") + channel.first);
    refuse(file,
           "has no color to compare: neither channels R, G, B nor Y; it has " + printable(joined(names, ", "), 200));
}

std::string size_text(ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }
std::string window_text(const ExrColors& picture) {
    return size_text(picture.beauty.size) + " at " + std::to_string(picture.low.x) + "," +
           std::to_string(picture.low.y);
}
}

const Image<vec3>* ExrColors::layer(const std::string& name) const {
    const auto found = layers.find(name);
    return found == layers.end() ? nullptr : &found->second;
}

ExrColors read_exr_colors(const std::filesystem::path& file) {
    const ExrFile exr = read_exr(file);
    std::map<std::string, Channels> layers;
    for (const auto& [name, image] : exr.channels) {
        const size_t dot = name.rfind('.');
        const bool plain = dot == name.npos;
        layers[plain ? "" : name.substr(0, dot)][plain ? name : name.substr(dot + 1)] = &image;
    }

    ExrColors picture;
    picture.file = file.string(), picture.display = exr.display, picture.low = exr.low;
    const auto style = exr.attributes.find("stylized");
    picture.stylized = style != exr.attributes.end() && style->second != "0";
    const Channels& own = layers[""];
    picture.gray = !is_color(own);
    if (picture.gray && !own.contains("Y")) refuse_colorless(picture.file, layers);
    picture.beauty = picture.gray ? gray_of(*own.at("Y")) : color_of(exr);

    for (const auto& [name, channels] : layers) {
        if (name.empty()) continue;
        if (is_color(channels)) picture.layers[name] = color_of(exr, name);
        if (channels.size() == 1) picture.layers[name] = gray_of(*channels.begin()->second);
    }
    return picture;
}

void check_same_frame(const ExrColors& test, const ExrColors& reference) {
    const std::string other = "the reference " + printable(reference.file, 120);
    if (test.display != reference.display)
        refuse(test.file,
               "has " + size_text(test.display) + " pixels, " + other + " has " + size_text(reference.display));
    if (test.low != reference.low || test.beauty.size != reference.beauty.size)
        refuse(test.file, "contains the crop " + window_text(test) + ", " + other + " the crop " +
                              window_text(reference) + "; render both with the same --crop");
    if (test.gray != reference.gray)
        refuse(test.file, std::string(test.gray ? "has luminance only, " : "has color, ") + other +
                              (test.gray ? " has color" : " has luminance only"));
}
}
