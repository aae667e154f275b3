// The texels of a texture: linear color and straight alpha. Those of 8-bit images stay 8-bit codes, a quarter as large.
#pragma once
#include "base/image.h"

#include <array>
#include <memory>

namespace tyndall {
using Code4 = glm::vec<4, uint8_t>;

struct Texels {
    Image<Code4> codes; // sRGB color; or else ...
    Image<vec4> linear;

    bool empty() const { return codes.empty() && linear.empty(); }
    ivec2 size() const { return codes.empty() ? linear.size : codes.size; }
    size_t bytes() const { return codes.pixels.size() * sizeof(Code4) + linear.pixels.size() * sizeof(vec4); }
};

// Linear light of each 8-bit sRGB code.
const std::array<float, 256>& srgb_lights();

inline vec4 linear_texel(const std::array<float, 256>& lights, Code4 code) {
    return {lights[code.x], lights[code.y], lights[code.z], static_cast<float>(code.w) / 255.0f};
}

// The texel at a column and row.
vec4 texel_at(const Texels& texels, int x, int y);

// Half the size, each texel the mean of four (alpha-weighted color); odd edges repeat their last texel.
Texels halved(const Texels& texels);

inline std::shared_ptr<const Texels> shared_texels(Image<vec4> linear) {
    return std::make_shared<const Texels>(Texels{{}, std::move(linear)});
}
}
