// Beams: light of spots, of lamps with shadows found per ray, and of what is near other lamps. It is integrated along
// each camera ray, which resolves the distance from the lamp and the edge of a cone that froxels would blur. Froxels
// store what varies slowly: the fraction of the light that arrives.
#pragma once
#include "base/recycled.h"
#include "integrate/lobe_cuts.h"
#include "modes/froxel/grid.h"
#include "scene/light.h"
#include "scene/lights/light_filter.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
struct FroxelScene;
struct FroxelSettings;
struct Snapshot;

// The part of a light that look-ups integrate per ray: all of it near the lamp, and less from half the radius on;
// froxels hold the rest. 0 = none, infinite = all.
struct NearLight {
    float radius = 0; // meters
    float at(float distance) const {
        const float x = std::clamp(2 - 2 * distance / radius, 0.0f, 1.0f);
        return std::isinf(radius) ? 1 : radius > 0 ? x * x * (3 - 2 * x) : 0;
    }
};
NearLight near_light(const FroxelScene& scene, const FroxelGrid& grid, size_t light);

// A light with an IES profile or gobo is split into this many angles along a ray, with two points each.
inline constexpr float filter_pieces = 48;
inline float filter_point_angle(const Light& light) { return cone_angle(light) / (2 * filter_pieces); }

// The near part of a lamp by the size of the froxels around it and of the image there: beyond half its radius, froxels
// resolve 1/r². Closer rays sample the fog themselves; since that is more accurate, finer froxels must not make the
// part small. 0 for a lamp behind the camera.
NearLight near_to(const FroxelGrid& grid, const Light& light);

// Whether shadow views of all lamps fit in memory.
bool lamp_views_fit(const Snapshot& snapshot);

// Whether a light's shadows are found exactly along rays, except those of surfaces with alpha, or it has none.
bool has_exact_shadows(const Light& light, const Snapshot& snapshot, const FroxelSettings& settings, bool views_fit);

struct FroxelBeams {
    // Slices of a tile that the light may reach, in the tile or its neighbors.
    struct Reach {
        int32_t first = 0, end = 0;
        size_t index = 0; // index of the first slice's share
    };
    // Attenuation by the grid fog within a few froxels of a lamp, in closed form: interpolated shares would blur its
    // onset.
    struct LampFog {
        float extinction = 0, reach = 0; // 1/m, times light_depth_scale(); meters
    };
    std::vector<size_t> lights;      // indices in the scene
    std::vector<LampFog> fog;        // at each of them
    std::vector<LightDepth> grids;   // for each, grid fog only: rays evaluate closed-form fog themselves
    std::vector<bool> exact_shadows; // for each, whether all its shadows are found along rays, or it has none
    std::vector<bool> by_rays_alone; // for each, whether rays need no froxels: closed-form fog and exact shadows
    LobeCuts lobe;                   // of the scene's fog
    std::vector<Reach> reaches;      // [tile · lights + light]
    RecycledFloats shares;           // fraction of light that arrives, relative to LampFog alone and no surfaces
    size_t media = 0;                // number of media; 0 if there is only one, or none is a grid
    RecycledFloats extinctions;      // of each medium, 1/m [(tile · media + medium) · slices + slice]
    std::vector<int32_t> first_step; // steps of rays close to a lamp: the first of each slice, then their number
    std::vector<float> step_faces;   // planar depths, meters

    const Reach& reach(size_t tile, size_t beam) const { return reaches[tile * lights.size() + beam]; }
    float share(size_t tile, size_t beam, int slice) const {
        const Reach& of = reach(tile, beam);
        return slice < of.first || slice >= of.end ? 0 : shares[of.index + static_cast<size_t>(slice - of.first)];
    }
    int steps(size_t slice) const { return first_step[slice + 1] - first_step[slice]; }
    size_t media_index(const FroxelGrid& grid, size_t tile, size_t medium, int slice) const {
        return (tile * media + medium) * static_cast<size_t>(grid.slices()) + static_cast<size_t>(slice);
    }
};

// Factor on the optical depth between a light and fog, where it is evaluated per point: 0 for methods off and average.
float light_depth_scale(const LightDepth& depth);

// Finds the slices that beams reach and allocates their shares, which fill_froxels() fills in.
FroxelBeams make_froxel_beams(const FroxelScene& scene, const FroxelGrid& grid);
}
