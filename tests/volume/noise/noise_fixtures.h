// Gradient noise written out plainly in double precision, and points to ask it at.
#pragma once
#include "base/error.h"
#include "base/simd/isa.h"
#include "volume/noise/lattice.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace tyndall::testing {
// The value of an octave at a local point: eight corners, each a hashed gradient times the way to the point.
inline double plain_noise(const NoiseOctave& octave, dvec3 local) {
    int64_t cell[3];
    double t[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double position = local[axis] * octave.frequency + octave.fraction[axis];
        cell[axis] = static_cast<int64_t>(std::floor(position));
        t[axis] = position - static_cast<double>(cell[axis]);
    }
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
        constexpr uint32_t primes[3] = {501125321u, 1136930381u, 1720413743u};
        uint32_t hash = octave.seed;
        double weight = 1;
        double d[3];
        for (int axis = 0; axis < 3; ++axis) {
            const int side = corner >> axis & 1;
            const int64_t number = cell[axis] + octave.cell[axis] + side;
            hash ^= static_cast<uint32_t>(static_cast<uint64_t>(number)) * primes[axis];
            const double fade = t[axis] * t[axis] * t[axis] * (t[axis] * (t[axis] * 6 - 15) + 10);
            weight *= side ? fade : 1 - fade;
            d[axis] = t[axis] - side;
        }
        const uint32_t entry = hash * 0x27d4eb2du >> 28;
        value += weight *
                 (octave.gradient_x[entry] * d[0] + octave.gradient_y[entry] * d[1] + octave.gradient_z[entry] * d[2]);
    }
    return value;
}

inline double plain_sum(const NoiseSum& sum, dvec3 local) {
    double total = sum.start;
    for (const NoiseOctave& octave : sum.octaves) {
        const double value = plain_noise(octave, local);
        total += octave.scale * (sum.billow ? std::abs(value) : value);
    }
    return total;
}

struct Points {
    std::vector<float> x, y, z;

    size_t size() const { return x.size(); }
    void add(vec3 p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    vec3 at(size_t i) const { return {x[i], y[i], z[i]}; }
};

inline Points random_points(int count, Box box, uint32_t seed = 1) {
    std::mt19937 random(seed);
    Points points;
    for (int i = 0; i < count; ++i) {
        vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = std::uniform_real_distribution<float>(box.low[axis], box.high[axis])(random);
        points.add(p);
    }
    return points;
}

inline std::vector<float> noise_at(const FractalNoise& noise, float turn, const Points& points) {
    std::vector<float> values(points.size());
    fractal_noise(noise, turn, points.x, points.y, points.z, values);
    return values;
}

inline double mean_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values) sum += v;
    return sum / static_cast<double>(values.size());
}
inline double std_dev(const std::vector<float>& values) {
    const double mean = mean_of(values);
    double sum = 0;
    for (const float v : values) sum += (v - mean) * (v - mean);
    return std::sqrt(sum / static_cast<double>(values.size()));
}
inline double correlation(const std::vector<float>& a, const std::vector<float>& b) {
    const double ma = mean_of(a), mb = mean_of(b);
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma) * (b[i] - mb);
    return sum / static_cast<double>(a.size()) / (std_dev(a) * std_dev(b));
}

// Runs a test on another instruction set and goes back afterwards.
struct WithIsa {
    explicit WithIsa(std::string_view name) { set_isa(name); }
    ~WithIsa() { set_isa("auto"); }
    WithIsa(const WithIsa&) = delete;
    WithIsa& operator=(const WithIsa&) = delete;
};
inline bool has_isa(std::string_view name) {
    try {
        const WithIsa there(name);
        return true;
    } catch (const Error&) {
        return false;
    }
}
}
