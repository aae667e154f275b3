#include "viewer/painting/tone.h"

#include "base/parallel.h"
#include "measure/metrics/heatmap.h"
#include "render/frame/layers.h"

#include <algorithm>

namespace tyndall {
namespace {
float median_depth(const Image<float>& depth) {
    std::vector<float> known;
    for (size_t i = 0; i < depth.pixels.size(); i += 17)
        if (std::isfinite(depth.pixels[i])) known.push_back(depth.pixels[i]);
    if (known.empty()) return 1;
    std::nth_element(known.begin(), known.begin() + static_cast<ptrdiff_t>(known.size() / 2), known.end());
    return std::max(known[known.size() / 2], 1e-6f);
}

// An image of `code(x, y)` at every pixel.
template<class Code> Image<glm::u8vec4> coded(const Layers& layers, const Code& code) {
    Image<glm::u8vec4> codes(layers.size);
    parallel_ranges(layers.size.y, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < layers.size.x; ++x) codes.at(x, y) = {code(x, y), 255};
    });
    return codes;
}

// A value in 0..1, or a color of such values, without exposure or tone mapping.
glm::u8vec3 plain_code(vec3 value, int x, int y) { return display_code(value, {0, ViewTransform::srgb}, x, y); }

glm::u8vec3 false_color(vec3 color, float gain) {
    constexpr float middle_gray = 0.18f;
    const float light = gain * luminance(color) / middle_gray;
    if (!(light > 0)) return glm::u8vec3(0);
    return color_of_stop(static_cast<int>(std::floor(std::clamp(std::log2(light), -1e3f, 1e3f))));
}
}

const std::vector<std::string>& shown_layer_names() {
    static const std::vector<std::string> names{"picture",  "fog",   "transmittance", "depth",
                                                "validity", "stops", "error"};
    return names;
}

glm::u8vec3 color_of_stop(int stop) {
    constexpr double stops = highest_stop - lowest_stop;
    return heat_color((std::clamp(stop, lowest_stop, highest_stop - 1) - lowest_stop + 0.5) / stops);
}

Image<glm::u8vec4> tone_map(const Layers& layers, const DisplayOptions& shown) {
    const Display display = shown.display();
    const float gain = static_cast<float>(std::exp2(display.exposure));
    switch (shown.layer) {
    case ShownLayer::picture:
    case ShownLayer::error:
        break;
    case ShownLayer::fog:
        return coded(layers, [&](int x, int y) { return display_code(layers.inscatter.at(x, y), display, x, y); });
    case ShownLayer::transmittance:
        return coded(layers, [&](int x, int y) {
            const bool colored = !layers.channel_transmittance.empty();
            const vec3 passed = colored ? layers.channel_transmittance.at(x, y) : vec3(layers.transmittance.at(x, y));
            return plain_code(passed, x, y);
        });
    case ShownLayer::depth: {
        const float middle = median_depth(layers.depth);
        return coded(layers,
                     [&](int x, int y) { return plain_code(vec3(middle / (middle + layers.depth.at(x, y))), x, y); });
    }
    case ShownLayer::validity:
        return coded(layers, [&](int x, int y) {
            const float gray = 0.05f + 0.4f * std::min(gain * luminance(layers.color.at(x, y)), 1.0f);
            return plain_code(glm::mix(vec3(0.8f, 0.05f, 0.03f), vec3(gray), layers.validity.at(x, y)), x, y);
        });
    case ShownLayer::stops:
        return coded(layers, [&](int x, int y) { return false_color(layers.color.at(x, y), gain); });
    }
    return coded(layers, [&](int x, int y) { return display_code(layers.color.at(x, y), display, x, y); });
}
}
