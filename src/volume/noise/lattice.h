// One octave of gradient noise prepared for the SIMD kernels: the position of its lattice and its current gradients.
#pragma once
#include "volume/noise/noise.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall {
// With unit gradients no value exceeds √3/2, reached at the center of a cell whose gradients all point there: the value
// is a weighted mean of |x - corner|·cos with weights that sum to 1, and that mean distance is largest there.
inline constexpr float noise_peak = 0.8660254f;
inline constexpr float noise_mean_size = 0.1564f;    // mean of |value| over space and gradients
inline constexpr float noise_slope_spread = 0.4982f; // RMS of one partial derivative
inline constexpr float noise_slope_peak = 2.80f;     // bound of any first partial derivative
inline constexpr float noise_bend_peak = 10.01f;     // bound of any second derivative along one axis
inline constexpr float noise_twist_peak = 8.44f;     // bound of any mixed second derivative

struct NoiseOctave {
    float scale = 1;                 // the octave adds scale · value (billow: scale · |value|) to the sum
    float frequency = 1;             // cells per meter
    std::array<float, 3> fraction{}; // cell coordinate of the local origin: cell + fraction
    std::array<int32_t, 3> cell{};
    uint32_t seed = 0;
    // The 16 unit gradients at this time; the second eight are opposite to the first.
    alignas(64) std::array<float, 16> gradient_x{}, gradient_y{}, gradient_z{};
};

struct NoiseSum {
    std::vector<NoiseOctave> octaves; // strongest first, two layers interleaved
    std::vector<float> rest;          // rest[k]: upper bound of the sum of octaves k, k+1, ...
    float start = 0;                  // initial value of the sum
    bool billow = false;
};

// One layer of a moving noise field at one time. Two advected layers that crossfade loop seamlessly.
struct NoiseLayer {
    double turn = 0;       // 0 <= turn < 1
    dvec3 displacement{0}; // meters by which the field has been advected
    float weight = 1;
    uint32_t salt = 0; // distinguishes the lattices of layers
};

// The noise around `origin` (meters); kernels pass points relative to it.
NoiseSum noise_sum(const FractalNoise& noise, const std::vector<NoiseLayer>& layers, dvec3 origin);

// A single octave of `frequency` cells per meter on the lattice of `seed`.
NoiseOctave noise_octave(double frequency, uint32_t seed, double turn, dvec3 local_origin);

// Rounds to multiples of 2^-20, which floats above 1 still represent, so that turn and turn + 1 are bit-identical.
double snapped_turn(float turn);

// The fractional part of turns, 0 <= result < 1, rounded to 2^-32 so that equal phases from different sums agree.
double wrapped_turn(double turns);
}
