#include "render/image/view_transform.h"

#include "base/parallel.h"
#include "base/random.h"
#include "base/srgb.h"

#include <array>
#include <bit>

namespace tyndall {
namespace {
// A tabulated function: 128 values per power of two from 2^-20 to 2^8, linearly interpolated.
class Curve {
public:
    template<class Function> explicit Curve(const Function& function) {
        for (size_t i = 0; i < values_.size(); ++i)
            values_[i] = static_cast<float>(
                function(double{std::bit_cast<float>((uint32_t{lowest} << 23) + (static_cast<uint32_t>(i) << shift))}));
    }

    float at(float x) const {
        if (!(x > 0x1p-20f)) return x > 0 ? values_[0] * x * 0x1p20f : 0;
        const uint32_t bits = std::bit_cast<uint32_t>(std::min(x, 255.9f)) - (uint32_t{lowest} << 23);
        const uint32_t place = bits >> shift;
        const float part = static_cast<float>(bits & 0xffffu) * 0x1p-16f;
        return values_[place] + part * (values_[place + 1] - values_[place]);
    }
    vec3 at(vec3 v) const { return {at(v.x), at(v.y), at(v.z)}; }

private:
    static constexpr int lowest = 127 - 20, powers = 28, shift = 16;
    std::array<float, powers * 128 + 2> values_;
};

double code_of(double linear) { return 255 * srgb_encoded(std::min(linear, 1.0)); }

// AgX (Troy Sobotka 2022): a matrix narrows the gamut, so that pure colors bleed into the other channels when they get
// bright; a sigmoid maps the logarithm of each channel; a second matrix widens the gamut again. Matrices, polynomial
// and the look "punchy" (contrast, saturation) are those of Benjamin Wrensch (2023).
const mat3 inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f, //
                 0.0784335999999992f, 0.878468636469772f, 0.0784336f,          //
                 0.0792237451477643f, 0.0791661274605434f, 0.879142973793104f);
const mat3 outset(1.19687900512017f, -0.0528968517574562f, -0.0529716355144438f, //
                  -0.0980208811401368f, 1.15190312990417f, -0.0980434501171241f, //
                  -0.0990297440797205f, -0.0989611768448433f, 1.15107367264116f);
constexpr double contrast = 1.35;
constexpr float saturation = 1.4f;

// From 0 at the darkest to 1 at the brightest.
double sigmoid(double linear) {
    constexpr double darkest = -12.47393, brightest = 4.026069; // stops
    const auto polynomial = [](double x) {
        return -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    };
    const double x = std::clamp((std::log2(linear) - darkest) / (brightest - darkest), 0.0, 1.0);
    return std::max(polynomial(x), 0.0) / polynomial(1);
}

vec3 filmic_codes(vec3 linear) {
    static const Curve curve([](double x) { return std::pow(sigmoid(x), contrast); });
    static const Curve codes([](double x) { return code_of(std::pow(x, 2.2)); });
    const vec3 bent = curve.at(inset * linear);
    return codes.at(outset * glm::mix(vec3(luminance(bent)), bent, saturation));
}

// NaN and negative values become 0, infinite ones 1e30.
vec3 cleaned(vec3 color) {
    const auto one = [](float x) { return x > 0 ? std::min(x, 1e30f) : 0.0f; };
    return {one(color.x), one(color.y), one(color.z)};
}
}

const std::vector<std::string>& view_transform_names() {
    static const std::vector<std::string> names{"filmic", "srgb"};
    return names;
}

vec3 display_value(vec3 linear, const Display& display) {
    static const Curve codes(code_of);
    const vec3 color = cleaned(static_cast<float>(std::exp2(display.exposure)) * linear);
    return display.transform == ViewTransform::filmic ? filmic_codes(color) : codes.at(color);
}

glm::u8vec3 display_code(vec3 linear, const Display& display, int x, int y) {
    vec3 value = display_value(linear, display);
    for (uint32_t c = 0; c < 3; ++c)
        value[static_cast<int>(c)] += random_unit(static_cast<uint32_t>(x), static_cast<uint32_t>(y), c, 0);
    return glm::u8vec3(glm::min(value, vec3(255)));
}

Image<glm::u8vec3> display_codes(const Image<vec3>& linear, const Display& display) {
    Image<glm::u8vec3> codes(linear.size);
    parallel_ranges(linear.size.y, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < linear.size.x; ++x) codes.at(x, y) = display_code(linear.at(x, y), display, x, y);
    });
    return codes;
}
}
