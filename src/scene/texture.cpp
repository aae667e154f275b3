// Texture lookup.
#include "scene/mesh.h"

#include <cassert>

namespace tyndall {
namespace {
// Texel index after repeating, mirroring or clamping to the edge, for indices within one period of the texture.
int wrapped(int index, int size, bool repeat, bool mirror) {
    if (!repeat && !mirror) return std::clamp(index, 0, size - 1);
    const int period = mirror ? 2 * size : size;
    const int within = index < 0 ? index + period : index < period ? index : index - period;
    return within < size ? within : 2 * size - 1 - within;
}

// Texel coordinate of any number: huge values and NaNs also give some valid texel.
float texel_coordinate(float uv, int size, bool repeat, bool mirror) {
    if (!std::isfinite(uv)) return 0;
    if (mirror)
        uv -= 2 * std::floor(uv / 2);
    else if (repeat)
        uv -= std::floor(uv);
    return std::clamp(uv, -1.0f, 2.0f) * size;
}

// Interpolates value_of(texel) of a texture's image.
template<class T, class ValueOf>
auto interpolated_texel(const Texture& texture, const Image<T>& image, vec2 uv, const ValueOf& value_of) {
    assert(!image.empty());
    const vec2 place(texture.uv_transform * vec3(uv, 1));
    const float x = texel_coordinate(place.x, image.size.x, texture.repeat_u, texture.mirror_u);
    const float y = texel_coordinate(place.y, image.size.y, texture.repeat_v, texture.mirror_v);
    const auto column = [&](int i) { return wrapped(i, image.size.x, texture.repeat_u, texture.mirror_u); };
    const auto row = [&](int j) { return wrapped(j, image.size.y, texture.repeat_v, texture.mirror_v); };
    if (texture.nearest)
        return value_of(image.at(column(static_cast<int>(std::floor(x))), row(static_cast<int>(std::floor(y)))));

    // Texel centers lie at half-integers.
    const float left = std::floor(x - 0.5f), upper = std::floor(y - 0.5f);
    const float across = x - 0.5f - left, down = y - 0.5f - upper;
    const int i[] = {column(static_cast<int>(left)), column(static_cast<int>(left) + 1)};
    const auto along_row = [&](int j) {
        const auto before = value_of(image.at(i[0], j)), behind = value_of(image.at(i[1], j));
        return before + across * (behind - before);
    };
    const auto top = along_row(row(static_cast<int>(upper))), bottom = along_row(row(static_cast<int>(upper) + 1));
    return top + down * (bottom - top);
}
}

vec4 sample_texture(const Texture& texture, vec2 uv) {
    const Texels& texels = *texture.texels;
    const auto same = [](const vec4& texel) -> vec4 { return texel; };
    if (texels.codes.empty()) return interpolated_texel(texture, texels.linear, uv, same);
    const auto& lights = srgb_lights();
    return interpolated_texel(texture, texels.codes, uv, [&](Code4 code) { return linear_texel(lights, code); });
}

float sample_alpha(const Texture& texture, vec2 uv) {
    const Texels& texels = *texture.texels;
    if (texels.codes.empty())
        return interpolated_texel(texture, texels.linear, uv, [](const vec4& texel) { return texel.w; });
    return interpolated_texel(texture, texels.codes, uv,
                              [](Code4 code) { return static_cast<float>(code.w) / 255.0f; });
}
}
