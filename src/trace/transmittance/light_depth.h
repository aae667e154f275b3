// Optical depth of the fog between a point and a light, stored in grids aligned with the light.
//
//   sun    orthographic columns along the light, fitted to the fog          u,v across · w along
//   spot   perspective columns in a cone                                    u,v = tangent plane · w = distance
//   point  octahedral directions                                            u,v = octahedron · w = distance
//
// Each cell corner holds the depth from the light (or the fog's edge) to it; lookups are trilinear in depth. The path
// to a local light ends at its `radius`: nothing attenuates it inside the light's sphere.
//
// Or at the corners of froxels: cells of the image times slices of planar depth, whose thickness grows linearly.
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

// Shared by copies and frames.
using SharedFloats = std::shared_ptr<const std::vector<float>>;

struct LightDepthGrid {
    // Parameterization: sun, spot or point, as above. A point light that sees the fog under a small angle has a
    // `perspective` grid, a spot wider than 70° to each side an `all_around` grid.
    LightProjection projection = LightProjection::parallel;
    mat3 world_to_grid{1};    // rotation to the grid's axes, after subtracting `position`
    vec3 position{0};         // the light; for a sun, a point near the fog
    ivec3 size{0};            // corners along u, v, w
    vec3 scale{1}, offset{0}; // corner number = coordinate · scale + offset
    float start = -infinity;  // w at which integration starts
    SharedFloats depth;       // [(w·size.y + v)·size.x + u]
    bool empty() const { return !depth; }
};

// One more cell lies beyond each edge of the image, so that filters and interpolation find corners there.
struct LightDepthFroxels {
    Camera camera;
    ivec3 size{0};            // corners across, down, in depth
    vec2 scale{1}, offset{0}; // corner number = (right, up) in the plane at unit depth · scale + offset
    float near = 0, far = 0;  // planar depths of the first and last corners
    float first = 1;          // thickness of the slices at `near`, relative to their mean
    SharedFloats depth;       // [(slice·size.y + row)·size.x + column]
    bool empty() const { return !depth; }

    // Planar depth of a slice's corners: near + (far - near) (a s + (1 - a) s²), s = 0..1 and a = `first`.
    float planar_depth(int slice) const {
        const float s = static_cast<float>(slice) / static_cast<float>(size.z - 1);
        return near + (far - near) * s * (first + (1 - first) * s);
    }
};

// Serialized to cache files in this order.
template<class Visit> void fields(LightDepthGrid& grid, Visit& visit) {
    visit(grid.projection), visit(grid.world_to_grid), visit(grid.position), visit(grid.size);
    visit(grid.scale), visit(grid.offset), visit(grid.start), visit(grid.depth);
}
template<class Visit> void fields(LightDepthFroxels& froxels, Visit& visit) {
    fields(froxels.camera, visit);
    visit(froxels.size), visit(froxels.scale), visit(froxels.offset);
    visit(froxels.near), visit(froxels.far), visit(froxels.first), visit(froxels.depth);
}

// Everything a mode needs to evaluate transmittance to one light: closed forms for homogeneous and height fog, one grid
// for all brick media together, or froxels with the fog marched outside them.
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

// `resolution`: cells across the longer side of the fog as seen from the light; for froxels, across the longer side of
// the image and in depth. Without a view, or with a lens, a grid replaces froxels. Built in parallel. If not `filled`,
// a grid is left to GridColumns (light_grid.h), unless a prepared plan has all of it in a file.
LightDepth make_light_depth(const Snapshot& snapshot, const Light& light, LightTransmittance method, int resolution,
                            const View* view = nullptr, bool filled = true);

// Optical depth from 16 points to the light (x,y,z of 16 each); 0 in lanes with active == 0. Kernels use
// light_depth16() of trace/transmittance/light_depth_simd.h.
void light_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                  float* optical_depth);

// Cost of marching from one point to the light, in density evaluations.
inline int march_work(const LightDepth& depth) {
    return depth.froxels.empty() ? 8 * static_cast<int>(depth.marched.size()) : 0;
}

// Optical depth of the brick media only, exact for their trilinear densities: what `marched` adds to the closed forms.
void marched_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                    float* optical_depth);
}
