// One octave of gradient noise ready for the vector kernels: where its lattice lies and how its gradients point now.
#pragma once
#include "volume/noise/noise.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall {
// With unit gradients no value passes √3/2, reached at the centre of a cell whose gradients all point there:
// the value is a mean, by weights that sum to 1, of |x - corner|·cos, and that mean of distances is largest there.
inline constexpr float noise_peak = 0.8660254f;
inline constexpr float noise_mean_size = 0.1564f;    // mean of |value| over space and gradients
inline constexpr float noise_slope_spread = 0.4982f; // root mean square of one partial derivative
inline constexpr float noise_slope_peak = 2.80f;     // no partial derivative passes this,
inline constexpr float noise_bend_peak = 10.01f;     // no second derivative along one axis this,
inline constexpr float noise_twist_peak = 8.44f;     // and no mixed second derivative this

struct NoiseOctave {
    float scale = 1;                 // the octave adds scale · value (billow: scale · |value|) to the sum
    float frequency = 1;             // cells per metre
    std::array<float, 3> fraction{}; // cell coordinate of the local origin: cell + fraction
    std::array<int32_t, 3> cell{};
    uint32_t seed = 0;
    // The 16 unit gradients of this moment, the second eight opposite to the first.
    alignas(64) std::array<float, 16> gradient_x{}, gradient_y{}, gradient_z{};
};

struct NoiseSum {
    std::vector<NoiseOctave> octaves; // strongest first, two layers interleaved
    std::vector<float> rest;          // rest[k]: no sum of octaves k, k+1, ... passes it
    float start = 0;                  // what the sum starts with
    bool billow = false;
};

// A moment of a moving noise field. Two layers that are born, throughput and die in turn loop without a seam.
struct NoiseLayer {
    double turn = 0;       // 0 <= turn < 1
    dvec3 displacement{0}; // metres the field has been throughput
    float weight = 1;
    uint32_t salt = 0; // tells the lattices of layers apart
};

// The noise around `origin` (metres): kernels pass points relative to it.
NoiseSum noise_sum(const FractalNoise& noise, const std::vector<NoiseLayer>& layers, dvec3 origin);

// A lone octave of `frequency` cells per metre, the lattice of which is `seed`'s.
NoiseOctave noise_octave(double frequency, uint32_t seed, double turn, dvec3 local_origin);

// Turns on the grid that a float resolves above 1, so that turn and turn + 1 are the same moment to the last bit.
double snapped_turn(float turn);

// The fractional part of turns, 0 <= result < 1, on a grid so fine that equal phases reached by different sums agree.
double wrapped_turn(double turns);
}
