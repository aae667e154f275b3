// Light in the fog that has been scattered before: a grid of fluence and flux, filled by the flights of light paths
// (track-length estimator: Spanier & Gelbard 1969) and smoothed where noise hides the light. What it scatters towards
// the eye is added to exact single scattering.
//
// Around each point the light is taken for a Henyey–Greenstein lobe about the flux F with the mean cosine |F|/φ. Fog of
// mean cosine g turns it into a lobe of mean cosine g|F|/φ: exact for a beam scattered twice in thin fog and for light
// from all around, and right to the first moment always. Phase functions of several lobes do so lobe by lobe;
// Draine's lobe becomes one of 3 m² α / (3 + α (1 - m²)) instead of α, m the mean cosine of the light: right to the
// second moment where g is 0, and for a beam.
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
    float cell = 1; // metres
    // Twelve numbers per cell [(x·ny + y)·nz + z]: fluence of red, green, blue; then the flux of each, x, y, z by
    // colour: [3 + 3·axis + colour].
    std::vector<float> values;
    // Per cell, bit `axis`: a surface lies between its light and that of the next cell. Empty = there are no surfaces.
    std::vector<int32_t> walls;
    // Per cell the surface that cuts it, n·p + d in cells from the lower corner, above 0 on the side whose light the
    // cell holds; zeros where none does. As many as walls.
    std::vector<vec4> cuts;

    bool empty() const { return values.empty(); }
};

// Of cache files, in this order.
template<class Visit> void fields(FluenceGrid& grid, Visit& visit) {
    visit(grid.bounds), visit(grid.size), visit(grid.cell), visit(grid.values), visit(grid.walls), visit(grid.cuts);
}

inline size_t cell_index(const FluenceGrid& grid, ivec3 cell) {
    return static_cast<size_t>(cell.x * grid.size.y + cell.y) * static_cast<size_t>(grid.size.z) +
           static_cast<size_t>(cell.z);
}

// A grid's values between cell centres, of those that no wall parts from the cell around the point, or that lie on the
// point's side of the surface that cuts this cell; zeros outside the bounds.
struct FluenceAt {
    vec3 fluence{0}, flux[3]{vec3(0), vec3(0), vec3(0)}; // flux: of each colour, by axis
};
FluenceAt fluence_at(const FluenceGrid& grid, vec3 point);

inline constexpr int draine_steps = 4; // towards the g of such a lobe: the mean cosine is right to 3e-3

// What a particle of scattering cross section 1 sends towards the eye, whose ray has this direction.
vec3 scattered_fluence(const FluenceAt& at, vec3 direction, const Phase& phase);

// The same bits at any thread count.
FluenceGrid make_fluence(const Snapshot& snapshot, const FluenceSettings& settings, uint32_t seed = 0);

// Cached while lights, media and surfaces stand still (trace/frame_cache.h). Null when settings or scene ask for none.
std::shared_ptr<const FluenceGrid> cached_fluence(const Snapshot& snapshot, const FluenceSettings& settings,
                                                  uint32_t seed = 0);
}
