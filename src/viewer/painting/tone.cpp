#include "viewer/painting/tone.h"

#include "base/parallel.h"
#include "base/random.h"
#include "render/frame/layers.h"

#include <array>
#include <bit>

namespace tyndall {
namespace {
// The display curve of write_png: a shoulder above 0.8, then sRGB (IEC 61966-2-1), times 255.
double display_value(double x) {
    constexpr double shoulder = 0.8;
    if (x > shoulder) x = 1 - (1 - shoulder) * std::exp((shoulder - x) / (1 - shoulder));
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

// That curve at 128 places of each power of two from 2^-20 to 2^6; straight in between.
struct Curve {
    static constexpr int lowest = 127 - 20, powers = 26, shift = 16;
    std::array<float, powers * 128 + 2> values;

    Curve() {
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<float>(
                display_value(std::bit_cast<float>((uint32_t{lowest} << 23) + (static_cast<uint32_t>(i) << shift))));
    }

    float at(float x) const {
        if (!(x > 0x1p-20f)) return x > 0 ? 255 * 12.92f * x : 0;
        const uint32_t bits = std::bit_cast<uint32_t>(std::min(x, 63.9f)) - (uint32_t{lowest} << 23);
        const uint32_t place = bits >> shift;
        const float part = static_cast<float>(bits & 0xffffu) * 0x1p-16f;
        return values[place] + part * (values[place + 1] - values[place]);
    }
};

uint8_t code(const Curve& curve, float linear, int x, int y, uint32_t channel) {
    const float dither = random_unit(static_cast<uint32_t>(x), static_cast<uint32_t>(y), channel, 0);
    return static_cast<uint8_t>(std::min(curve.at(linear) + dither, 255.0f));
}

float median_depth(const Image<float>& depth) {
    std::vector<float> known;
    for (size_t i = 0; i < depth.pixels.size(); i += 17)
        if (std::isfinite(depth.pixels[i])) known.push_back(depth.pixels[i]);
    if (known.empty()) return 1;
    std::nth_element(known.begin(), known.begin() + static_cast<ptrdiff_t>(known.size() / 2), known.end());
    return std::max(known[known.size() / 2], 1e-6f);
}

// What a pixel shows, linear.
template<class Pixel> Image<glm::u8vec4> coded(const Layers& layers, const Pixel& pixel) {
    static const Curve curve;
    Image<glm::u8vec4> codes(layers.size);
    parallel_ranges(layers.size.y, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < layers.size.x; ++x) {
                const vec3 light = pixel(x, y);
                codes.at(x, y) = {code(curve, light.x, x, y, 0), code(curve, light.y, x, y, 1),
                                  code(curve, light.z, x, y, 2), 255};
            }
    });
    return codes;
}
}

const std::vector<std::string>& shown_layer_names() {
    static const std::vector<std::string> names{"picture", "fog", "transmittance", "depth", "validity", "error"};
    return names;
}

Image<glm::u8vec4> toned(const Layers& layers, const Shown& shown) {
    const float gain = std::exp2(shown.exposure);
    switch (shown.layer) {
    case ShownLayer::picture:
    case ShownLayer::error:
        break;
    case ShownLayer::fog:
        return coded(layers, [&](int x, int y) { return gain * layers.inscatter.at(x, y); });
    case ShownLayer::transmittance:
        return coded(layers, [&](int x, int y) { return vec3(0.8f * layers.transmittance.at(x, y)); });
    case ShownLayer::depth: {
        const float middle = median_depth(layers.depth);
        return coded(layers, [&](int x, int y) { return vec3(0.8f * middle / (middle + layers.depth.at(x, y))); });
    }
    case ShownLayer::validity:
        return coded(layers, [&](int x, int y) {
            const float grey = 0.05f + 0.4f * std::min(gain * luminance(layers.color.at(x, y)), 1.0f);
            return glm::mix(vec3(0.8f, 0.05f, 0.03f), vec3(grey), layers.validity.at(x, y));
        });
    }
    return coded(layers, [&](int x, int y) { return gain * layers.color.at(x, y); });
}
}
