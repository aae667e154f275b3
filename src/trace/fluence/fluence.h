// Multiply scattered light in fog: a grid of fluence and flux, filled from light paths (track-length estimator: Spanier
// & Gelbard 1969) and denoised. The light it scatters toward the eye is added to exact single scattering.
//
// At each point, the light is modeled as a Henyey–Greenstein lobe about the flux F with mean cosine |F|/φ, φ being the
// fluence. Fog of mean cosine g scatters it into a lobe of mean cosine g|F|/φ: exact for isotropic light and for a beam
// scattered twice in thin fog, and always correct to the first moment. Phase functions with several lobes are handled
// lobe by lobe. In a Draine lobe, 3 m² α / (3 + α (1 - m²)) replaces α, m being the mean cosine of the light: correct
// to the second moment if g is 0, and for a beam.
#pragma once
#include "base/math.h"
#include "volume/phase.h"

#include <memory>
#include <vector>

namespace tyndall {
struct FluenceSettings;
struct Snapshot;

struct FluenceGrid {
    Box bounds;
    ivec3 size{0};  // cells
    float cell = 1; // meters
    // Twelve numbers per cell [(x·ny + y)·nz + z]: fluence of red, green, blue; then the flux, [3 + 3·axis + color].
    std::vector<float> values;
    // Per cell, bit `axis`: a surface separates its light from that of the next cell on the axis. Empty = no surfaces.
    std::vector<int32_t> walls;
    // Per cell, the plane of the surface that cuts it: n·p + d, p in cells from the grid's lower corner, positive on
    // the side whose light the cell holds; zeros if none does. As many as walls.
    std::vector<vec4> cuts;

    bool empty() const { return values.empty(); }
};

// Serialized to cache files in this order.
template<class Visit> void fields(FluenceGrid& grid, Visit& visit) {
    visit(grid.bounds), visit(grid.size), visit(grid.cell), visit(grid.values), visit(grid.walls), visit(grid.cuts);
}

inline size_t cell_index(const FluenceGrid& grid, ivec3 cell) {
    return static_cast<size_t>(cell.x * grid.size.y + cell.y) * static_cast<size_t>(grid.size.z) +
           static_cast<size_t>(cell.z);
}

// Grid values interpolated between cell centers: of the cells that no wall separates from the point's own or, for a
// point behind the surface that cuts its cell, of cells behind that surface too. Zeros outside the bounds.
struct FluenceAt {
    vec3 fluence{0}, flux[3]{vec3(0), vec3(0), vec3(0)}; // flux: a vector for each color
};
FluenceAt fluence_at(const FluenceGrid& grid, vec3 point);

inline constexpr int draine_steps = 4; // fixed-point steps for a Draine lobe's g: mean cosine accurate to 3e-3

// Light scattered toward the eye per unit of scattering coefficient and length, along a camera ray of this direction.
vec3 scattered_fluence(const FluenceAt& at, vec3 direction, const Phase& phase);

// Builds the grid; empty without fog or lights. Bit-identical for any number of threads.
FluenceGrid make_fluence(const Snapshot& snapshot, const FluenceSettings& settings, uint32_t seed = 0);

// make_fluence(), cached while lights, media and surfaces do not change (trace/frame_cache.h); null if not needed.
std::shared_ptr<const FluenceGrid> cached_fluence(const Snapshot& snapshot, const FluenceSettings& settings,
                                                  uint32_t seed = 0);
}
