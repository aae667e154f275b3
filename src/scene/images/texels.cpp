#include "scene/images/texels.h"

#include "base/srgb.h"

namespace tyndall {
namespace {
Code4 code_of(vec4 texel) {
    const vec4 clamped = glm::clamp(texel, vec4(0), vec4(1));
    const auto coded = [](float value) { return static_cast<uint8_t>(std::lround(255 * value)); };
    return {coded(srgb_encoded(clamped.x)), coded(srgb_encoded(clamped.y)), coded(srgb_encoded(clamped.z)),
            coded(clamped.w)};
}

// `read` makes linear color of a texel, `write` a texel of linear color.
template<class T, class Read, class Write>
Image<T> halved_image(const Image<T>& image, const Read& read, const Write& write) {
    Image<T> result(glm::max(image.size / 2, ivec2(1)));
    for (int y = 0; y < result.size.y; ++y)
        for (int x = 0; x < result.size.x; ++x) {
            vec4 sum(0), plain(0);
            for (int corner = 0; corner < 4; ++corner) {
                const vec4 texel = read(image.at(std::min(2 * x + (corner & 1), image.size.x - 1),
                                                 std::min(2 * y + (corner >> 1), image.size.y - 1)));
                sum += vec4(vec3(texel) * texel.w, texel.w), plain += texel;
            }
            result.at(x, y) = write(sum.w > 0 ? vec4(vec3(sum) / sum.w, sum.w / 4) : plain / 4.0f);
        }
    return result;
}
}

const std::array<float, 256>& srgb_lights() {
    static const std::array<float, 256> lights = [] {
        std::array<float, 256> values;
        for (size_t i = 0; i < values.size(); ++i) values[i] = srgb_decoded(static_cast<float>(i) / 255.0f);
        return values;
    }();
    return lights;
}

vec4 texel_at(const Texels& texels, int x, int y) {
    return texels.codes.empty() ? texels.linear.at(x, y) : linear_texel(srgb_lights(), texels.codes.at(x, y));
}

Texels halved(const Texels& texels) {
    const auto& lights = srgb_lights();
    const auto same = [](vec4 texel) { return texel; };
    if (texels.codes.empty()) return {{}, halved_image(texels.linear, same, same)};
    return {halved_image(
                texels.codes, [&](Code4 code) { return linear_texel(lights, code); }, code_of),
            {}};
}
}
