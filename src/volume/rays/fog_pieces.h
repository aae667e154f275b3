// All fog along a ray in closed form, piece by piece: in every voxel cell trilinear density is a cubic along the ray,
// height fog is an exponential, homogeneous fog a constant. Densities and optical depths are exact at every point.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;

// The density of one medium on low..high.
struct DensityPiece {
    double low = 0, high = 0;
    double c[4] = {};         // c0 + c1·s + c2·s² + c3·s³ with s = t - low ...
    bool exponential = false; // ... or e^(c0 + c1·s)
    double voxels = 0;        // crossed per metre, where the density varies with them

    double density(double t) const;
    double column(double t) const; // the density integrated from low to t
};

// Appends the pieces of a ray's 0..t_end in which the medium has density, ascending and disjoint.
void append_density(const Ray& ray, const Medium& medium, double t_end, std::vector<DensityPiece>& pieces);

// Intervals on which the density of every medium is one DensityPiece.
struct FogPieces {
    struct Piece {
        double low = 0, high = 0;
        double depth = 0;  // optical depth from the ray's start to `low`
        double voxels = 0; // per metre
    };
    std::vector<Piece> pieces; // ascending and disjoint, none empty of fog
    double depth = 0;          // optical depth of the whole ray

    size_t media = 0;
    std::vector<double> extinction;                   // of each medium at density 1
    std::vector<std::vector<DensityPiece>> densities; // of each medium
    std::vector<int> parts;                           // [piece · media + medium]: which of its densities, or -1

    double density(size_t piece, size_t medium, double t) const;
    double depth_at(size_t piece, double t) const; // optical depth from the ray's start
};

// Replaces `fog` by the pieces of the ray 0..t_max. Left out is what lies beyond 1e12 m, behind optical depth 64 of
// fog in closed form, or where the transmittance has sunk below the least one.
void find_fog(const Ray& ray, std::span<const Medium> media, double min_transmittance, FogPieces& fog);
}
