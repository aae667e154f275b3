#include "measure/metrics/heatmap.h"

#include "base/text.h"
#include "measure/metrics/metrics.h"
#include "render/image/lettering.h"

#include <numbers>
#include <string>

namespace tyndall {
namespace {
constexpr Color8 not_a_number(0, 255, 0);

int dot_side(int width) { return std::max(1, width / 800); }

struct Tick {
    double position; // 0 to 1
    std::string text;
};

// Powers of ten, or quarters.
std::vector<Tick> ticks_of(const HeatScale& scale) {
    const int steps = scale.logarithmic ? static_cast<int>(std::lround(std::log10(scale.high / scale.low))) : 4;
    std::vector<Tick> ticks;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        const double value =
            scale.logarithmic ? scale.low * std::pow(10, i) : scale.low + share * (scale.high - scale.low);
        ticks.push_back({share, formatted("%g", value)});
    }
    return ticks;
}

// The scale in the rows from `top` on.
void draw_strip(Image<Color8>& picture, int top, const HeatScale& scale) {
    const int width = picture.size.x, dot = dot_side(width);
    for (int y = top; y < picture.size.y; ++y)
        for (int x = 0; x < width; ++x) picture.at(x, y) = heat_color((x + 0.5) / width);

    const std::vector<Tick> ticks = ticks_of(scale);
    int longest = 0;
    for (const Tick& tick : ticks) longest = std::max(longest, text_width(tick.text, dot));
    if ((longest + 8 * dot) * static_cast<int>(ticks.size()) > width) return;
    for (const Tick& tick : ticks) {
        const int room = width - text_width(tick.text, dot) - 2 * dot;
        const int left = static_cast<int>(tick.position * width) - text_width(tick.text, dot) / 2;
        draw_text(picture, {std::clamp(left, 2 * dot, std::max(room, 2 * dot)), top + dot}, dot, tick.text,
                  Color8(tick.position < 0.6 ? 255 : 0));
    }
}
}

Color8 heat_color(double t) {
    constexpr double start = 0.1, rotations = 0.42, saturation = 1.3;
    t = std::clamp(t, 0.0, 1.0);
    const double angle = 2 * std::numbers::pi * (start / 3 + 1 + rotations * t);
    const double amplitude = saturation * t * (1 - t) / 2, u = std::cos(angle), v = std::sin(angle);
    const double rgb[3] = {t + amplitude * (-0.14861 * u + 1.78277 * v), t + amplitude * (-0.29227 * u - 0.90649 * v),
                           t + amplitude * 1.97294 * u};
    Color8 color;
    for (int c = 0; c < 3; ++c) color[c] = static_cast<uint8_t>(std::lround(255 * std::clamp(rgb[c], 0.0, 1.0)));
    return color;
}

double heat_place(double value, const HeatScale& scale) {
    const double low = scale.low, high = scale.high;
    return scale.logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low)
                             : (value - low) / (high - low);
}

Color8 heat_color(double value, const HeatScale& scale) {
    return std::isnan(value) ? not_a_number : heat_color(heat_place(value, scale));
}

int heat_strip_height(int width) { return (letter_height + 2) * dot_side(width); }

Image<Color8> heat_map(const Image<float>& values, const HeatScale& scale) {
    const int width = values.size.x, height = values.size.y;
    Image<Color8> picture({width, height + heat_strip_height(width)});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) picture.at(x, y) = heat_color(double{values.at(x, y)}, scale);
    draw_strip(picture, height, scale);
    return picture;
}

Image<float> error_map(const Image<vec3>& test, const Image<vec3>& reference, double mean_reference) {
    Image<float> map(test.size, std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < map.pixels.size(); ++i) {
        const dvec3 error = dvec3(test.pixels[i]) - dvec3(reference.pixels[i]);
        if (comparable(test.pixels[i], reference.pixels[i]))
            map.pixels[i] = static_cast<float>(relative(std::sqrt(glm::dot(error, error) / 3), mean_reference));
    }
    return map;
}
}
