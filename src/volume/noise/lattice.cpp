#include "volume/noise/lattice.h"

#include <cassert>
#include <numbers>

namespace tyndall {
namespace {
uint32_t mixed(uint32_t x) { // finalizer of MurmurHash3
    x = (x ^ (x >> 16)) * 0x85ebca6bu;
    x = (x ^ (x >> 13)) * 0xc2b2ae35u;
    return x ^ (x >> 16);
}

// Gradients rotate in four planes whose normals are the diagonals of a cube; each plane holds two perpendicular pairs
// of opposite gradients. The sum of their outer products stays proportional to the identity, so contrast is isotropic
// and does not pulse. The planes rotate at different integer speeds, so no moment mirrors another.
void turn_gradients(NoiseOctave& octave, double turn, int speed) {
    constexpr std::array<std::array<double, 3>, 4> normals{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
    constexpr std::array<int, 4> speeds{1, -1, 2, -2};
    for (size_t plane = 0; plane < 4; ++plane) {
        const dvec3 n = dvec3(normals[plane][0], normals[plane][1], normals[plane][2]) / std::sqrt(3.0);
        const dvec3 u = glm::normalize(glm::cross(n, dvec3(0, 1, 0))), v = glm::cross(n, u);
        const double angle = 2 * std::numbers::pi * (wrapped_turn(turn * speed * speeds[plane]) + plane / 16.0);
        const dvec3 first = u * std::cos(angle) + v * std::sin(angle);
        const dvec3 second = v * std::cos(angle) - u * std::sin(angle);
        for (size_t i = 0; i < 4; ++i) {
            const size_t entry = 2 * plane + i % 2 + i / 2 * 8;
            const dvec3 g = (i % 2 ? second : first) * (i / 2 ? -1.0 : 1.0);
            octave.gradient_x[entry] = static_cast<float>(g.x);
            octave.gradient_y[entry] = static_cast<float>(g.y);
            octave.gradient_z[entry] = static_cast<float>(g.z);
        }
    }
}

NoiseOctave placed_octave(double frequency, uint32_t seed, double turn, int speed, dvec3 local_origin) {
    NoiseOctave octave;
    octave.frequency = static_cast<float>(frequency);
    octave.seed = mixed(seed);
    // Whole cells are split off in double precision, so a field advected far away stays as smooth as near the origin.
    for (int axis = 0; axis < 3; ++axis) {
        const double shift = (mixed(seed + 0x9e3779b9u * (axis + 1)) >> 8) * 0x1p-24;
        const double position = local_origin[axis] * frequency + shift;
        const double cell = std::floor(position);
        octave.fraction[axis] = static_cast<float>(position - cell);
        octave.cell[axis] = static_cast<int32_t>(static_cast<uint32_t>(static_cast<int64_t>(std::fmod(cell, 0x1p32))));
    }
    turn_gradients(octave, turn, speed);
    return octave;
}
}

double snapped_turn(float turn) { return std::nearbyint(double{turn} * 0x1p20) * 0x1p-20; }

double wrapped_turn(double turns) {
    const double snapped = std::nearbyint((turns - std::floor(turns)) * 0x1p32) * 0x1p-32;
    return snapped < 1 ? snapped : 0;
}

NoiseOctave noise_octave(double frequency, uint32_t seed, double turn, dvec3 local_origin) {
    return placed_octave(frequency, seed, turn, 1, local_origin);
}

NoiseSum noise_sum(const FractalNoise& noise, const std::vector<NoiseLayer>& layers, dvec3 origin) {
    assert(noise.octaves >= 1 && noise.scale > 0 && !layers.empty());
    NoiseSum sum;
    sum.billow = noise.billow;
    double total = 0, power = 0;
    for (int o = 0; o < noise.octaves; ++o) total += std::pow(double{noise.gain}, o);
    for (const NoiseLayer& layer : layers) power += double{layer.weight} * layer.weight;

    // Layers are independent fields: weights whose squares sum to 1 preserve the contrast of the mixture.
    // That requires a mean of 0, so the mean of billows |value| is subtracted.
    const double middle = noise.billow ? noise_mean_size : 0;
    double start = 0, frequency = 1 / double{noise.scale};
    for (int o = 0; o < noise.octaves; ++o, frequency *= noise.lacunarity) {
        for (const NoiseLayer& layer : layers) {
            const double scale =
                layer.weight / std::sqrt(power) * std::pow(double{noise.gain}, o) / total / (noise_peak - middle);
            // Small eddies turn faster than large ones.
            sum.octaves.push_back(placed_octave(frequency, mixed(noise.seed ^ layer.salt) + 0x6c8e9cf5u * (o + 1),
                                                layer.turn, 1 + o / 2, origin - layer.displacement));
            sum.octaves.back().scale = static_cast<float>(scale);
            start -= scale * middle;
        }
    }
    sum.start = static_cast<float>(start);

    // Margin for rounding: the error of a float sum of this size is below 1e-5 of its largest terms.
    double rest = 0;
    sum.rest.assign(sum.octaves.size() + 1, 0);
    for (size_t k = sum.octaves.size(); k-- > 0;) {
        rest += double{sum.octaves[k].scale} * noise_peak;
        sum.rest[k] = static_cast<float>(rest * 1.0001 + 1e-5);
    }
    return sum;
}
}
