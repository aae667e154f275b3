// Optical depth of the fog between a point and a light, stored in grids aligned with the light.
//
//   sun    orthographic columns along the light, fitted to the fog          u,v across · w along
//   spot   perspective columns in a cone                                    u,v = tangent plane · w = distance
//   point  octahedral directions                                            u,v = octahedron · w = distance
//
// Each cell holds the depth from the light (or the fog's edge) to the cell corner; look-ups are trilinear in depth.
// The path of a local light ends at its `radius`: inside the glowing ball nothing dims it.
//
// Or at the corners of froxels: cells of the picture times slices of planar depth, each slice thicker than the one
// before it by the same length.
#pragma once
#include "scene/camera.h"
#include "scene/light.h"
#include "trace/lights/light_projection.h"
#include "trace/transmittance/light_transmittance.h"
#include "volume/medium.h"

#include <memory>
#include <vector>

namespace tyndall {
struct Snapshot;
struct View;

// Of any number of copies, frames and users.
using SharedFloats = std::shared_ptr<const std::vector<float>>;

struct LightDepthGrid {
    // How cells lie, by the three above. A point light that sees the fog under a small angle has a `perspective` grid,
    // a spot wider than 70° to each side an `all_around` grid.
    LightProjection projection = LightProjection::parallel;
    mat3 world_to_grid{1};    // rotation to the grid's axes, after `position` is taken off
    vec3 position{0};         // a point by the fog (sun), the light
    ivec3 size{0};            // corners along u, v, w
    vec3 scale{1}, offset{0}; // corner number = coordinate · scale + offset
    float start = -infinity;  // w at which the depth begins to count
    SharedFloats depth;       // [(w·size.y + v)·size.x + u]
    bool empty() const { return !depth; }
};

// One more cell lies beyond each edge of the picture, so that filters and neighbours find corners there.
struct LightDepthFroxels {
    Camera camera;
    ivec3 size{0};            // corners across, down, in depth
    vec2 scale{1}, offset{0}; // corner number = (right, up) in the plane at unit depth · scale + offset
    float near = 0, far = 0;  // planar depths of the first and last corners
    float first = 1;          // thickness of the slices at `near`, as a share of their mean
    SharedFloats depth;       // [(slice·size.y + row)·size.x + column]
    bool empty() const { return !depth; }

    // Planar depth of a slice's corners: near + (far - near) (a s + (1 - a) s²), s = 0..1 and a = `first`.
    float planar_depth(int slice) const {
        const float s = static_cast<float>(slice) / static_cast<float>(size.z - 1);
        return near + (far - near) * s * (first + (1 - first) * s);
    }
};

// Of cache files, in this order.
template<class Visit> void fields(LightDepthGrid& grid, Visit& visit) {
    visit(grid.projection), visit(grid.world_to_grid), visit(grid.position), visit(grid.size);
    visit(grid.scale), visit(grid.offset), visit(grid.start), visit(grid.depth);
}
template<class Visit> void fields(LightDepthFroxels& froxels, Visit& visit) {
    fields(froxels.camera, visit);
    visit(froxels.size), visit(froxels.scale), visit(froxels.offset);
    visit(froxels.near), visit(froxels.far), visit(froxels.first), visit(froxels.depth);
}

// Everything a mode needs to ask for light-side transmittance of one light: closed forms for homogeneous and height
// fog, one grid for all brick media together, or froxels with the fog marched outside them.
struct LightDepth {
    LightTransmittance method = LightTransmittance::grid;
    Light light;
    LightDepthGrid grid;
    LightDepthFroxels froxels;
    std::vector<Medium> analytic; // homogeneous and height media
    std::vector<Medium> marched;  // brick media, when marched: everywhere, or outside the froxels
    float average = 0;            // optical depth used for every point, when average
    float scale = 1;              // factor on all depths
};

// `resolution`: cells across the longer side of the fog as the light sees it; of froxels, across the longer side of the
// picture and in depth. Froxels need a view, and are a grid without. Built in parallel. Not `filled`: a grid is left to
// GridColumns (light_grid.h), unless the plan was prepared and the whole of it is in a file.
LightDepth make_light_depth(const Snapshot& snapshot, const Light& light, LightTransmittance method, int resolution,
                            const View* view = nullptr, bool filled = true);

// Optical depth from 16 points to the light (x,y,z of 16 each); 0 in lanes with active == 0. Kernels use
// light_depth16() of trace/transmittance/light_depth_simd.h.
void light_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                  float* optical_depth);

// What marching the fog between one point and the light costs, in evaluations of fog.
inline int march_work(const LightDepth& depth) {
    return depth.froxels.empty() ? 8 * static_cast<int>(depth.marched.size()) : 0;
}

// The share of the brick media alone, exact for their trilinear densities: what `marched` adds to the closed forms.
void marched_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                    float* optical_depth);
}
