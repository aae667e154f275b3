// Beams of spots, of lamps whose shadows rays find by themselves, and what is near to other lamps. Light there follows
// from each ray of the picture itself: its distance from the lamp and the edge of the cone, which froxels would smear.
// They keep what changes slowly: how much of the light gets there at all.
#pragma once
#include "base/recycled.h"
#include "integrate/lobe_cuts.h"
#include "modes/froxel/grid.h"
#include "scene/light.h"
#include "scene/light_filter.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
struct FroxelScene;

// The part of a light that look-ups follow ray by ray: all around the lamp, less and less from half a radius on, until
// froxels have all of it. 0 = none, infinite = all.
struct NearLight {
    float radius = 0; // metres
    float at(float distance) const {
        const float x = std::clamp(2 - 2 * distance / radius, 0.0f, 1.0f);
        return std::isinf(radius) ? 1 : radius > 0 ? x * x * (3 - 2 * x) : 0;
    }
};
NearLight near_light(const FroxelScene& scene, const FroxelGrid& grid, size_t light);

// Of an IES profile or gobo rays see this many pieces across what they see of the light, with two points each.
inline constexpr float filter_pieces = 48;
inline float filter_point_angle(const Light& light) { return whole_angle(light) / (2 * filter_pieces); }

// What is near to a lamp by the size of the froxels around it: from half of that on they show its 1/r², and the fog
// that it lights, as they are. None of a lamp behind the camera.
NearLight near_to(const FroxelGrid& grid, const Light& light);

// Whether rays find the shadows of a light by themselves, exactly but for surfaces with alpha, or there are none.
bool has_exact_shadows(const FroxelScene& scene, const Light& light);

struct FroxelBeams {
    // Slices of a tile that the light may reach in it or in the tiles around it.
    struct Reach {
        int32_t first = 0, end = 0;
        size_t place = 0; // of the first one's share
    };
    // What grid fog at a lamp takes of its light within a few froxels, over which shares would even out how it begins.
    struct LampFog {
        float extinction = 0, reach = 0; // 1/m, of the depth that counts; metres
    };
    std::vector<size_t> lights;      // of the scene
    std::vector<LampFog> fog;        // at each of them
    std::vector<LightDepth> grids;   // of each, without fog of closed form: rays know by themselves how that dims it
    std::vector<bool> exact_shadows; // whether rays find all of them, or there are none
    std::vector<bool> by_rays_alone; // whether rays know all of it: fog of closed form and exact shadows
    LobeCuts lobe;                   // of the scene's fog
    std::vector<Reach> reaches;      // [tile · lights + light]
    RecycledFloats shares; // of the light that would arrive without surfaces, and through LampFog alone: what does
    size_t media = 0;      // of the scene; 0 where there is only one, or all are closed
    RecycledFloats media_shares; // in the extinction [(tile · media + medium) · slices + slice]

    const Reach& reach(size_t tile, size_t beam) const { return reaches[tile * lights.size() + beam]; }
    float share(size_t tile, size_t beam, int slice) const {
        const Reach& of = reach(tile, beam);
        return slice < of.first || slice >= of.end ? 0 : shares[of.place + static_cast<size_t>(slice - of.first)];
    }
    size_t media_place(const FroxelGrid& grid, size_t tile, size_t medium, int slice) const {
        return (tile * media + medium) * static_cast<size_t>(grid.slices()) + static_cast<size_t>(slice);
    }
};

// How much of its optical depth the fog on a light's way counts for where it is asked for by place.
float dimming(const LightDepth& depth);

// Finds what the beams of a scene reach, with room for their shares, which fill_froxels() fills in.
FroxelBeams make_froxel_beams(const FroxelScene& scene, const FroxelGrid& grid);
}
