// Fog that gives off light by grids, as a target: points in it are picked by the power of its bricks.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tyndall {
struct Medium;

struct EmissiveBricks {
    struct Brick {
        uint32_t medium = 0; // of those that only emit
        uint32_t cell = 0;   // of its bricks' index
    };
    // Of each medium.
    struct MediumChances {
        std::vector<float> per_volume; // of each cell: chance per m³ with which its points are picked
        float line_scale = 0;          // brightest light of a brick, its maximum 1, to chance per metre of a line
    };
    std::vector<Brick> bricks;
    std::vector<double> cumulative; // chance of the bricks up to and with each
    std::vector<MediumChances> media;

    bool empty() const { return bricks.empty(); }
};
EmissiveBricks make_emissive_bricks(std::span<const Medium> fields);

struct EmissivePlace {
    vec3 position{0}, emission{0}; // emission: radiance per metre
    float density = 0;             // chance per m³
    float line_density = 0;        // a guess at that of lines through it, which look for light by themselves, per metre
};
EmissivePlace pick_emissive_place(const EmissiveBricks& glow, std::span<const Medium> fields, float u, vec3 v);

// The two densities of a point that some other way has led to.
struct EmissiveDensities {
    float volume = 0, line = 0;
};
EmissiveDensities emissive_densities(const EmissiveBricks& glow, std::span<const Medium> fields, size_t medium,
                                     vec3 point);
}
