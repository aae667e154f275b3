// The intensity of an IES file in a direction, and its total flux.
#include "scene/photometry/ies_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tyndall {
namespace {
constexpr double degrees = 180 / std::numbers::pi;

// The position of a value in a list of ascending angles.
struct Between {
    size_t index = 0;
    double share = 0;
    bool inside = false;
};
Between find(const std::vector<double>& angles, double value) {
    constexpr double rounding = 1e-6;
    if (angles.size() == 1) return {0, 0, true};
    if (value < angles.front() - rounding || value > angles.back() + rounding) return {};
    const auto after = std::upper_bound(angles.begin() + 1, angles.end() - 1, value);
    const size_t index = static_cast<size_t>(after - angles.begin()) - 1;
    return {index, std::clamp((value - angles[index]) / (angles[index + 1] - angles[index]), 0.0, 1.0), true};
}

// Maps a horizontal angle of 0 to 360 degrees to the measured planes by the file's symmetry.
double folded(const IesFile& file, double angle) {
    const double first = file.horizontal.front(), last = file.horizontal.back();
    if (first > 45) return angle < 90 ? 180 - angle : angle > 270 ? 540 - angle : angle; // 90 to 270
    if (last > 270) return angle;
    if (angle > 180) angle = 360 - angle;
    return last > 135 || angle <= 90 ? angle : 180 - angle;
}

// Quadrature weights for ∫ f sin θ dθ of a function that is linear between knots; the knots are in degrees.
std::vector<double> sine_weights(const std::vector<double>& angles) {
    std::vector<double> weights(angles.size());
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const double a = angles[i] / degrees, b = angles[i + 1] / degrees;
        const double all = std::cos(a) - std::cos(b);
        const double upper = (std::sin(b) - std::sin(a)) / (b - a) - std::cos(b); // of (θ - a) / (b - a)
        weights[i] += all - upper, weights[i + 1] += upper;
    }
    return weights;
}

// The same for ∫ f dθ.
std::vector<double> even_weights(const std::vector<double>& angles) {
    std::vector<double> weights(angles.size());
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const double half = 0.5 * (angles[i + 1] - angles[i]) / degrees;
        weights[i] += half, weights[i + 1] += half;
    }
    return weights;
}
}

double candela_at(const IesFile& file, dvec3 direction) {
    double vertical, horizontal;
    const auto latitude = [](double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)) * degrees; };
    if (file.type == Photometry::type_c) {
        vertical = std::atan2(std::hypot(direction.x, direction.y), direction.z) * degrees;
        horizontal = std::atan2(direction.y, direction.x) * degrees;
        horizontal = folded(file, horizontal < 0 ? horizontal + 360 : horizontal);
    } else {
        if (direction.z < 0) return 0;
        // The planes of type B rotate about the horizontal axis, those of type A about the vertical one.
        const bool b = file.type == Photometry::type_b;
        vertical = b ? std::atan2(direction.y, direction.z) * degrees : latitude(direction.y);
        horizontal = b ? latitude(direction.x) : std::atan2(direction.x, direction.z) * degrees;
        if (file.vertical.front() >= 0) vertical = std::abs(vertical);
        if (file.horizontal.front() >= 0) horizontal = std::abs(horizontal);
    }
    const Between v = find(file.vertical, vertical), h = find(file.horizontal, horizontal);
    if (!v.inside || !h.inside) return 0;
    const size_t rows = file.vertical.size();
    const auto along = [&](size_t plane) {
        const double* values = file.candela.data() + plane * rows + v.index;
        return std::lerp(values[0], values[1], v.share);
    };
    return h.share > 0 ? std::lerp(along(h.index), along(h.index + 1), h.share) : along(h.index);
}

double zonal_lumens(const IesFile& file) {
    std::vector<double> rows, planes;
    double mirrored = 1;
    if (file.type == Photometry::type_c) {
        rows = sine_weights(file.vertical);
        planes =
            file.horizontal.size() == 1 ? std::vector<double>{2 * std::numbers::pi} : even_weights(file.horizontal);
        const double covered = file.horizontal.back() - file.horizontal.front();
        mirrored = file.horizontal.size() == 1 ? 1 : 360 / covered;
    } else {
        // Converts latitudes to angles from the pole.
        const auto from_pole = [](std::vector<double> angles) {
            for (double& angle : angles) angle += 90;
            return angles;
        };
        const bool b = file.type == Photometry::type_b;
        rows = b ? even_weights(file.vertical) : sine_weights(from_pole(file.vertical));
        planes = b ? sine_weights(from_pole(file.horizontal)) : even_weights(file.horizontal);
        for (const auto* angles : {&file.vertical, &file.horizontal}) mirrored *= angles->front() >= 0 ? 2 : 1;
    }
    double sum = 0;
    for (size_t plane = 0; plane < planes.size(); ++plane)
        for (size_t row = 0; row < rows.size(); ++row)
            sum += planes[plane] * rows[row] * file.candela[plane * rows.size() + row];
    return sum * mirrored;
}
}
