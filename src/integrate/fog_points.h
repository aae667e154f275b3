// Points of a ray at which what the fog scatters is asked for, and the fog there.
#pragma once
#include "integrate/ray_batch.h"
#include "volume/rays/fog_pieces.h"

#include <utility>
#include <vector>

namespace tyndall {
struct Medium;

// Two numbers for point k of `count` of a ray: well spread over the samples of a pixel. `use` tells apart what for.
vec2 point_numbers(const RayBatch& batch, size_t ray, uint32_t k, uint32_t count, uint32_t use);

// Where the optical depth from the ray's start reaches a value below the whole, and the piece that is in.
double distance_at(const FogPieces& fog, double depth, size_t& piece);

// The fog at a point of a ray: what each medium has of the extinction there.
struct FogThere {
    vec3 point{0}, direction{0};
    std::vector<float> shares;
};

// Fills `there` for t in a piece; returns the extinction there, 1/m.
double look_at_fog(const FogPieces& fog, size_t piece, const Ray& ray, double t, FogThere& there);

// Σ albedo p over the media, and Σ p, for light towards `towards` (unit).
std::pair<vec3, float> scattered(const std::vector<Medium>& media, const FogThere& fog, vec3 towards);
}
