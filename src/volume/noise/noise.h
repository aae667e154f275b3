// Fractal gradient noise in three dimensions that can evolve over time and loop seamlessly.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <span>

namespace tyndall {
// Sum over octaves o of gain^o · gradient noise(lacunarity^o · point / scale), normalized so that |sum| <= 1. Extremes
// are rare: with five octaves of gain 0.5, two thirds of space lie within ±0.13, and all but a thousandth within ±0.42.
struct FractalNoise {
    int octaves = 5;
    float scale = 1; // meters per cell of the first octave
    float lacunarity = 2;
    float gain = 0.5f;
    uint32_t seed = 0;
    float evolve = 0;    // gradient rotations per second (0 = frozen); whole turns per loop if there is a period
    bool billow = false; // octaves of |noise| (mean removed): round lobes between sharp creases, as on cumulus clouds
};

// Values at points (structure of arrays). Bit-identical on AVX2 and AVX-512.
// `turn` = evolve · seconds: the gradients rotate by integer multiples of it, so turn and turn + 1 are equal.
void fractal_noise(const FractalNoise& noise, float turn, std::span<const float> x, std::span<const float> y,
                   std::span<const float> z, std::span<float> values);

// Conservative upper bound of the noise over a box; tight for boxes smaller than a cell.
float fractal_noise_bound(const FractalNoise& noise, float turn, const Box& box);
}
