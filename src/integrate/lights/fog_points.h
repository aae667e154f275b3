// Sampling of scattering points along a ray, and the fog at these points.
#pragma once
#include "integrate/equi_angular.h"
#include "integrate/ray_batch.h"
#include "volume/medium.h"
#include "volume/rays/fog_pieces.h"

#include <utility>
#include <vector>

namespace tyndall {

// Two random numbers for point k of `count` on a ray, stratified over a pixel's samples. `use` decorrelates uses.
vec2 point_numbers(const RayBatch& batch, size_t ray, uint32_t k, uint32_t count, uint32_t use);

// Samples distances on a ray in proportion to extinction times transmittance to the eye.
struct FogSampler {
    const FogPieces& pieces;
    double factor = 1; // on the optical depth to the eye
    double whole = 0;  // ∫ e^(-factor · depth) over the depth of the ray

    // Transmittance to the eye from distance t in a piece.
    double transmittance(size_t piece, double t) const { return std::exp(-factor * pieces.depth_at(piece, t)); }
    double pdf(double extinction, double transmittance) const { return extinction * transmittance / whole; } // 1/m
    double distance(double u, size_t& piece) const;
};
FogSampler fog_sampler(const FogPieces& pieces, double factor);

// Equi-angular sampling of distances around a point, within the part of the ray in fog.
struct EquiAngularSampler {
    EquiAngular<double> angles{};
    Interval<double> stretch{};

    bool empty() const { return !(angles.to > angles.from); }
    double pdf(double t) const { return t >= stretch.low && t <= stretch.high ? angles.pdf(t) : 0; } // 1/m
};
// `radius` is a lower bound on the distance between ray and point.
EquiAngularSampler equi_angular_sampler(const Ray& ray, const FogPieces& fog, dvec3 point, double radius,
                                        Interval<double> reach = {0, infinity});

// Index of the piece that contains t; the number of pieces if t is in a gap.
size_t piece_at(const FogPieces& fog, double t);

// The fog at a point on a ray: each medium's share of the extinction.
struct FogSample {
    vec3 point{0}, direction{0};
    std::vector<float> shares;
};

// Fills `there` for t in a piece; returns the total extinction, 1/m.
double evaluate_fog(const FogPieces& fog, size_t piece, const Ray& ray, double t, FogSample& there);

// Σ share · albedo · p and Σ share · p over the media, for light from unit direction `towards`; p: phase function.
std::pair<vec3, float> scattered(const std::vector<Medium>& media, const FogSample& fog, vec3 towards);

// Samples a direction: selects a medium by its share with `which` in [0,1), then samples its phase function.
vec3 direction_by_phase(const std::vector<Medium>& media, const FogSample& fog, float which, vec2 u);
}
