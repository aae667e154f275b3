// Importance sampling of fog that emits: points by the power of its bricks, and along lines by the brightness of their
// cells. Fog without bricks is sampled by the cells of a box around it.
#pragma once
#include "volume/medium.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tyndall {
struct Snapshot;

struct EmissiveBricks {
    struct Brick {
        uint32_t medium = 0; // index into `fields`
        uint32_t cell = 0;   // index into FieldSampling::bricks->index
    };
    struct FieldSampling {
        std::shared_ptr<const BrickPool> bricks; // the medium's own, or one around its bounds
        std::vector<float> per_volume;           // pdf of the points of each cell, 1/m³
        float line_scale = 0;                    // factor from a brick's maximum to the pdf along a line, 1/m
    };
    std::vector<Medium> fields;          // media that emit
    std::vector<Brick> bricks;           // those that emit
    std::vector<double> cumulative;      // probability of the bricks up to and including each
    std::vector<FieldSampling> sampling; // of each field
};

// Which media: those that only emit; those that a few lamps may approximate; or all.
enum class Emitting { grids, as_lamps, all };

// Whether lamps may approximate a medium that emits: if it only emits, or is bounded and so thin that its light leaves
// it.
bool emits_as_lamps(const Medium& medium);

// The emission of a snapshot's media; null if there is none. Cached while they do not change. Of unbounded fog, the
// part near the scene: beyond, less than 1e-4 of its light arrives.
std::shared_ptr<const EmissiveBricks> emissive_bricks(const Snapshot& snapshot, Emitting which);

// An emitting point and the two pdfs it is sampled with: by volume, and along a line through it.
struct EmissionSample {
    vec3 position{0}, emission{0}; // emission: radiance per meter
    float pdf = 0;                 // 1/m³
    float line_pdf = 0;            // 1/m: approximates that of emission_on_line(), by position alone
};
EmissionSample sample_emission(const EmissiveBricks& fire, float u, vec3 v);
EmissionSample emission_sample_at(const EmissiveBricks& fire, size_t field, vec3 position);

// A point on a line 0..t_max, sampled in proportion to the maximum brightness of each cell along it.
struct EmissionOnLine {
    EmissionSample sample;
    float distance = 0, inverse_pdf = 0; // meters; inverse_pdf: 0 = nothing was found
};
EmissionOnLine emission_on_line(const EmissiveBricks& fire, size_t field, const Ray& line, float u);
}
