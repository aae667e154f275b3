// Optical depth of the fog between a point and a light, stored in grids aligned with the light.
//
//   sun    orthographic columns along the light, fitted to the fog          u,v across · w along
//   spot   perspective columns in the cone                                  u,v = tangent plane · w = distance
//   point  octahedral directions                                            u,v = octahedron · w = distance
//
// Each cell holds the depth from the light (or the fog's edge) to the cell corner; look-ups are trilinear in depth.
#pragma once
#include "trace/snapshot.h"

#include <vector>

namespace tyndall {
enum class LightTransmittance { off, average, grid, marched };   // `froxel` joins with the froxel cache

struct LightDepthGrid {
    LightKind kind = LightKind::sun;
    mat4 world_to_grid{1};       // sun, spot: world to (u,v,w) before scaling to cells
    vec3 position{0};            // spot, point
    ivec3 size{0};
    vec3 scale{1}, offset{0};    // cell coordinate = coordinate · scale + offset
    float tan_cone = 1;
    std::vector<float> depth;    // [(w·ny + v)·nx + u]
    bool empty() const { return depth.empty(); }
};

// Everything a mode needs to ask for light-side transmittance of one light: closed forms for homogeneous and height fog,
// one grid for all brick media together.
struct LightDepth {
    LightTransmittance method = LightTransmittance::grid;
    Light light;
    LightDepthGrid grid;
    std::vector<const Medium*> analytic;     // homogeneous and height media
    std::vector<const Medium*> marched;      // brick media, when marched
    float average = 0;                       // optical depth used for every point, when average
};

// `resolution`: cells across the longer side of the fog as the light sees it. Built in parallel.
LightDepth make_light_depth(const Snapshot& snapshot, const Light& light, LightTransmittance method, int resolution);

// Optical depth from 16 points to the light (x,y,z of 16 each). Only lanes with active != 0 need be right.
void light_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                  float* optical_depth);
}
