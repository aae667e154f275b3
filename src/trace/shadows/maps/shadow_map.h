// Shadow maps: depth of the nearest surface as seen from a light.
//
//   sun    up to four orthographic cascades, the finest first           u,v = meters across · w = meters along
//   spot   one perspective picture of its cone                          u,v = tangents to the axis · w = distance
//   point  the six faces of a cube: +x -x +y -y +z -z                   u,v = tangents · w = distance
//
// A spot wider than 70° to each side has a cube. `w` of local lights is the distance from the light, which is
// continuous across a cube's seams. Every picture extends some texels beyond the region it serves, so that filters
// never reach its border.
#pragma once
#include "base/math.h"
#include "trace/lights/light_projection.h"

#include <array>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

inline constexpr float shadow_guard = 2; // texels that a picture has to spare around a filtered lookup, on each side

inline constexpr int max_levels = 12; // of blocks: 8192 texels, in blocks of 4 to 8192

struct ShadowMapOptions {
    int resolution = 1024; // texels across each picture
    int cascades = 3;      // maximum number of pictures of a sun
    int pcf = 1;           // 0 = nearest texel, 1 = bilinear over four, 2 = over sixteen
    float bias = 0;        // texels by which surfaces are moved away from the light
};

// One picture. Texel coordinate = coordinate · scale + offset; texel i spans i to i + 1.
struct ShadowImage {
    ivec2 size{0};
    size_t first = 0; // index of its first texel in ShadowMap::depth; rows of increasing u
    vec2 scale{1}, offset{0};
    int levels = 0; // of its blocks, and where each begins in ShadowMap::blocks
    std::array<size_t, max_levels> first_block{};
};

// Depth range of a block of texels.
struct DepthRange {
    float nearest = infinity, farthest = -infinity;
};

struct ShadowMap {
    LightProjection projection = LightProjection::parallel; // sun, spot or point, as above
    mat3 world_to_map{1};                                   // rotation to u, v, w, after subtracting `position`
    vec3 position{0};                                       // the light; for a sun, a point amid the surfaces
    std::vector<ShadowImage> images;
    std::vector<float> depth;       // w of the nearest surface; infinite if none, unseen_depth where no lookup falls
    std::vector<DepthRange> blocks; // of each picture: blocks of 4×4 texels, of 8×8, and so on up to a single one
    int pcf = 1;
    float bias = 0;

    bool empty() const { return images.empty(); } // nothing casts shadows: all is lit
};

// Serialized to cache files in this order.
template<class Visit> void fields(ShadowMap& map, Visit& visit) {
    visit(map.projection), visit(map.world_to_map), visit(map.position), visit(map.images);
    visit(map.depth), visit(map.blocks), visit(map.pcf), visit(map.bias);
}

// Depth of texels that no ray of the view comes near inside fog; everything is dark there.
inline constexpr float unseen_depth = -infinity;

// Fits the pictures, and traces rays for their depths. Outside a sun's pictures everything is lit, outside a spot's
// nothing is. Rays pass holes of MASK surfaces, and BLEND surfaces with alpha below one half. Surfaces inside a light's
// radius cast no shadow.
ShadowMap make_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                          const ShadowMapOptions& options);

// The same without the depths.
ShadowMap fitted_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                            const ShadowMapOptions& options);

// Cascades of a sun: the fog that the camera sees, in ranges that grow with distance (Zhang et al. 2006), where
// anything can shadow it. Cascades hardly finer than the next are left out. Texels keep their world positions and sizes
// while the camera moves, except for jumps by a quarter of an octave.
void fit_cascades(const View& view, const Snapshot& snapshot, const Box& casters, const ShadowMapOptions& options,
                  ShadowMap& map);

// Fills in the depths, where the view sees fog.
void fill_shadow_map(const View& view, const Snapshot& snapshot, const Light& light, ShadowMap& map);

// How many points of a box, in map coordinates, are lit.
enum class Lit { none, some, all };

// None or all if the blocks of texels prove it for every lookup in the box (min-max mipmaps: Chen et al. 2011), else
// some. Suns only; local lights always return some.
Lit lit_in_box(const ShadowMap& map, vec3 low, vec3 high);

// The longer side of a texel at a point, meters, in the finest picture there; 0 if there is none.
float texel_size(const ShadowMap& map, vec3 point);

// Fraction of the light that reaches 16 points (x,y,z of 16 each). Kernels use lit_fraction16() of
// trace/shadows/maps/shadow_map_simd.h.
void lit_fractions(const ShadowMap& map, const float* x, const float* y, const float* z, float* share);
}
