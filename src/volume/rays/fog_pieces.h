// A piecewise analytic representation of all fog along a ray: trilinear density is a cubic in every voxel cell, height
// fog an exponential, homogeneous fog a constant. Densities and optical depths are exact at every point.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;

// Density of one medium on low..high.
struct DensityPiece {
    double low = 0, high = 0;
    double c[4] = {};         // c0 + c1·s + c2·s² + c3·s³ with s = t - low ...
    bool exponential = false; // ... or e^(c0 + c1·s)
    double voxels = 0;        // voxels crossed per meter; 0 if the density does not vary by voxel

    double density(double t) const;
    double column(double t) const; // density integrated from low to t
};

// Appends the pieces on 0..t_end with nonzero density, ascending and disjoint.
void append_density(const Ray& ray, const Medium& medium, double t_end, std::vector<DensityPiece>& pieces);

// Intervals on which the density of every medium is one DensityPiece.
struct FogPieces {
    struct Piece {
        double low = 0, high = 0;
        double depth = 0;  // optical depth from the ray's start to `low`
        double voxels = 0; // per meter
    };
    std::vector<Piece> pieces; // ascending and disjoint, each with some fog
    double depth = 0;          // optical depth of the whole ray

    size_t media = 0;
    std::vector<double> extinction;                   // per medium, at density 1
    std::vector<std::vector<DensityPiece>> densities; // per medium
    std::vector<int> parts;                           // [piece · media + medium]: index into densities[medium], or -1

    double density(size_t piece, size_t medium, double t) const;
    double depth_at(size_t piece, double t) const; // optical depth from the ray's start
};

// Replaces `fog` with the pieces of the ray on 0..t_max. Omits fog beyond 1e12 m, behind optical depth 64 of
// homogeneous or height fog, and where the transmittance is below `min_transmittance`.
void find_fog(const Ray& ray, std::span<const Medium> media, double min_transmittance, FogPieces& fog);
}
