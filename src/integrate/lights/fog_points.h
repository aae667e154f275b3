// Points of a ray at which what the fog scatters is asked for, and the fog there.
#pragma once
#include "integrate/equi_angular.h"
#include "integrate/ray_batch.h"
#include "volume/medium.h"
#include "volume/rays/fog_pieces.h"

#include <utility>
#include <vector>

namespace tyndall {

// Two numbers for point k of `count` of a ray: well spread over the samples of a pixel. `use` tells apart what for.
vec2 point_numbers(const RayBatch& batch, size_t ray, uint32_t k, uint32_t count, uint32_t use);

// Distances on a ray in proportion to what the eye sees of the fog's extinction there.
struct SeenFog {
    const FogPieces& pieces;
    double factor = 1; // on the optical depth towards the eye
    double whole = 0;  // ∫ e^(-factor · depth) over the depth of the ray

    // Share of light that comes to the eye from a distance in a piece.
    double passing(size_t piece, double t) const { return std::exp(-factor * pieces.depth_at(piece, t)); }
    double density(double extinction, double passing) const { return extinction * passing / whole; } // 1/m
    double distance(double u, size_t& piece) const;
};
SeenFog seen_fog(const FogPieces& pieces, double factor);

// Distances even in the angle that a point is seen at, within a stretch that lies in the fog.
struct AngleDistances {
    EquiAngular<double> angles{};
    Interval<double> stretch{};

    bool empty() const { return !(angles.to > angles.from); }
    double density(double t) const { return t >= stretch.low && t <= stretch.high ? angles.density(t) : 0; } // 1/m
};
// Around a point no closer than a radius.
AngleDistances angle_distances(const Ray& ray, const FogPieces& fog, dvec3 point, double radius,
                               Interval<double> reach = {0, infinity});

// The piece of fog that a distance lies in; their number in a gap.
size_t piece_at(const FogPieces& fog, double t);

// The fog at a point of a ray: what each medium has of the extinction there.
struct FogThere {
    vec3 point{0}, direction{0};
    std::vector<float> shares;
};

// Fills `there` for t in a piece; returns the extinction there, 1/m.
double look_at_fog(const FogPieces& fog, size_t piece, const Ray& ray, double t, FogThere& there);

// Σ albedo p over the media, and Σ p, for light towards `towards` (unit).
std::pair<vec3, float> scattered(const std::vector<Medium>& media, const FogThere& fog, vec3 towards);

// A direction as the fog at the point scatters: of a medium by its share, `which` in [0,1), then by its phase function.
vec3 direction_by_phase(const std::vector<Medium>& media, const FogThere& fog, float which, vec2 u);
}
