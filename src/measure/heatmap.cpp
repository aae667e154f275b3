#include "measure/heatmap.h"

#include "measure/metrics.h"

namespace tyndall {
namespace {
constexpr Color8 not_a_number(0, 255, 0);
}

Color8 heat_color(double t) {
    constexpr double start = 0.1, rotations = 0.42, saturation = 1.3;
    t = std::clamp(t, 0.0, 1.0);
    const double angle = 2 * 3.14159265358979323846 * (start / 3 + 1 + rotations * t);
    const double amplitude = saturation * t * (1 - t) / 2, u = std::cos(angle), v = std::sin(angle);
    const double rgb[3] = {t + amplitude * (-0.14861 * u + 1.78277 * v), t + amplitude * (-0.29227 * u - 0.90649 * v),
                           t + amplitude * 1.97294 * u};
    Color8 color;
    for (int c = 0; c < 3; ++c) color[c] = static_cast<uint8_t>(std::lround(255 * std::clamp(rgb[c], 0.0, 1.0)));
    return color;
}

Image<Color8> heat_map(const Image<float>& values, double low, double high, bool log) {
    const int width = values.size.x, height = values.size.y;
    Image<Color8> picture({width, height + heat_strip_height(width)});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double v = values.at(x, y);
            const double t = log ? std::log(std::max(v, low) / low) / std::log(high / low) : (v - low) / (high - low);
            picture.at(x, y) = std::isnan(v) ? not_a_number : heat_color(t);
        }
    for (int y = height; y < picture.size.y; ++y)
        for (int x = 0; x < width; ++x) picture.at(x, y) = heat_color((x + 0.5) / width);
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
