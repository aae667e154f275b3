// Fog that gives off light by grids, as a target: points in it are picked by the power of its bricks, and along lines
// by the brightness of their cells.
#pragma once
#include "volume/medium.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tyndall {
struct Snapshot;

struct EmissiveBricks {
    struct Brick {
        uint32_t medium = 0; // of the fields
        uint32_t cell = 0;   // of its bricks' index
    };
    // Of each field.
    struct FieldChances {
        std::vector<float> per_volume; // of each cell: chance per m³ with which its points are picked
        float line_scale = 0;          // brightest light of a brick, its maximum 1, to chance per metre of a line
    };
    std::vector<Medium> fields;     // media that only emit
    std::vector<Brick> bricks;      // those with light in them
    std::vector<double> cumulative; // chance of the bricks up to and with each
    std::vector<FieldChances> chances;
};

// Of the media of a snapshot that only emit; null where none gives off light. Made once for as long as they stay as
// they are.
std::shared_ptr<const EmissiveBricks> emissive_bricks(const Snapshot& snapshot);

// A place in the fire, and the two chances with which it is found: by picking it, and by a line through it.
struct EmissivePlace {
    vec3 position{0}, emission{0}; // emission: radiance per metre
    float density = 0;             // per m³
    float line_density = 0;        // per metre: a guess at that of emission_on_line(), the same from both sides
};
EmissivePlace pick_emissive_place(const EmissiveBricks& fire, float u, vec3 v);
EmissivePlace emissive_place_at(const EmissiveBricks& fire, size_t field, vec3 position);

// A place on a line 0..t_max, picked in proportion to how bright each cell of the line can be.
struct EmissionOnLine {
    EmissivePlace place;
    float distance = 0, inverse_density = 0; // metres per unit of chance; 0 = nothing was found
};
EmissionOnLine emission_on_line(const EmissiveBricks& fire, size_t field, const Ray& line, float u);
}
