// Depth of the nearest surface as a light sees it, for shadows that are looked up instead of traced.
//
//   sun    up to four orthographic cascades, the finest first           u,v = metres across · w = metres along
//   spot   one perspective picture of its cone                          u,v = tangents to the axis · w = distance
//   point  the six faces of a cube: +x -x +y -y +z -z                   u,v = tangents · w = distance
//
// A spot wider than 70° to each side has a cube. `w` of local lights is the distance from the light itself, which is
// the same on both sides of a cube's seams. Every picture reaches some texels further than it is asked for, so that
// filters never meet its border.
#pragma once
#include "base/math.h"
#include "trace/lights/light_projection.h"

#include <array>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

inline constexpr float shadow_guard = 2; // texels around a filtered look-up on each side that a picture has to spare

inline constexpr int max_levels = 12; // of blocks: 8192 texels, in blocks of 4 to 8192

struct ShadowMapOptions {
    int resolution = 1024; // texels across each picture
    int cascades = 3;      // most pictures of a sun
    int pcf = 1;           // 0 nearest texel, 1 the four around bilinearly, 2 sixteen
    float bias = 0;        // texels by which surfaces are moved away from the light
};

// One picture. Texel number = coordinate · scale + offset; texel i reaches from i to i + 1.
struct ShadowPicture {
    ivec2 size{0};
    size_t first = 0; // of its texels in ShadowMap::depth, rows of increasing u
    vec2 scale{1}, offset{0};
    int levels = 0; // of its blocks, and where each begins in ShadowMap::blocks
    std::array<size_t, max_levels> first_block{};
};

// Depths of a block of texels.
struct DepthRange {
    float nearest = infinity, farthest = -infinity;
};

struct ShadowMap {
    LightProjection projection = LightProjection::parallel; // how pictures lie, by the three above
    mat3 world_to_map{1};                                   // rotation to u, v, w, after `position` is taken off
    vec3 position{0};                                       // the light; of a sun a point amid the surfaces
    std::vector<ShadowPicture> pictures;
    std::vector<float> depth; // w of the nearest surface, infinite where there is none, unseen_depth where none looks
    std::vector<DepthRange> blocks; // of each picture: of 4×4 texels, of 8×8, and so on to one block
    int pcf = 1;
    float bias = 0;

    bool empty() const { return pictures.empty(); } // nothing casts shadows: all is lit
};

// Of cache files, in this order.
template<class Visit> void fields(ShadowMap& map, Visit& visit) {
    visit(map.projection), visit(map.world_to_map), visit(map.position), visit(map.pictures);
    visit(map.depth), visit(map.blocks), visit(map.pcf), visit(map.bias);
}

// Of texels that no ray of the view's picture comes near while it is in fog: all is dark there.
inline constexpr float unseen_depth = -infinity;

// Where the pictures lie, and their depths by rays. Outside the pictures of a sun all is lit, outside a spot's nothing.
// Holes of MASK surfaces are passed; BLEND surfaces block at an alpha of one half and more, and are passed below. What
// lies inside a light's radius casts no shadow.
ShadowMap make_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                          const ShadowMapOptions& options);

// The same without the depths.
ShadowMap fitted_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                            const ShadowMapOptions& options);

// Pictures of a sun: what the camera sees of the fog, in ranges that grow with the distance (Zhang et al. 2006), and
// where anything can shade it. A finer one that would hardly be finer is left out. Texels keep their places and sizes
// in the world while the camera moves, but for jumps by a fourth of an octave.
void fit_cascades(const View& view, const Snapshot& snapshot, const Box& casters, const ShadowMapOptions& options,
                  ShadowMap& map);

// The depths, as far as the view sees fog.
void fill_shadow_map(const View& view, const Snapshot& snapshot, const Light& light, ShadowMap& map);

// Whether light reaches the points of a box of map coordinates.
enum class Lit { none, some, all };

// Says none or all where blocks of texels prove it for every look-up in the box (min-max mipmaps: Chen et al. 2011),
// else some. Suns only; local lights always get some.
Lit lit_in_box(const ShadowMap& map, vec3 low, vec3 high);

// The longer side of a texel at a point, metres; of the finest picture there. 0 where there is none.
float texel_size(const ShadowMap& map, vec3 point);

// Share of the light that reaches 16 points (x,y,z of 16 each). Kernels use lit_share16() of
// trace/shadows/maps/shadow_map_simd.h.
void lit_shares(const ShadowMap& map, const float* x, const float* y, const float* z, float* share);
}
