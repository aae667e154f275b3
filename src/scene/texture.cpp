// Texture lookup.
#include "scene/mesh.h"

#include <cassert>

namespace tyndall {
namespace {
// Texel index after repeating, mirroring or clamping to the edge.
int wrapped(int index, int size, bool repeat, bool mirror) {
    if (!repeat && !mirror) return std::clamp(index, 0, size - 1);
    const int period = mirror ? 2 * size : size;
    const int within = ((index % period) + period) % period;
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
}

vec4 sample_texture(const Texture& texture, vec2 uv) {
    assert(!texture.texels.empty());
    const Image<vec4>& image = texture.texels;
    const vec2 place(texture.uv_transform * vec3(uv, 1));
    const float x = texel_coordinate(place.x, image.size.x, texture.repeat_u, texture.mirror_u);
    const float y = texel_coordinate(place.y, image.size.y, texture.repeat_v, texture.mirror_v);
    const auto texel = [&](int i, int j) {
        return image.at(wrapped(i, image.size.x, texture.repeat_u, texture.mirror_u),
                        wrapped(j, image.size.y, texture.repeat_v, texture.mirror_v));
    };
    if (texture.nearest) return texel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));

    // Texel centers lie at half-integers.
    const float left = std::floor(x - 0.5f), upper = std::floor(y - 0.5f);
    const float across = x - 0.5f - left, down = y - 0.5f - upper;
    const int i = static_cast<int>(left), j = static_cast<int>(upper);
    const vec4 top = texel(i, j) + across * (texel(i + 1, j) - texel(i, j));
    const vec4 bottom = texel(i, j + 1) + across * (texel(i + 1, j + 1) - texel(i, j + 1));
    return top + down * (bottom - top);
}
}
