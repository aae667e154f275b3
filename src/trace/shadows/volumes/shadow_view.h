// Shadow volumes as one camera sees them: which sides and caps a ray crosses, found by signs alone.
//
// Seen from the light, a ray from the eye is a half line that walks over a picture of triangles. Each corner lies to
// one side of that line (`corners`, one product per ray); an edge whose corners lie on different sides is crossed ahead
// or behind, which the eye's place relative to the edge decides once for all rays (`start`); and it is crossed between
// ray and light or beyond the ray (`before`). The signs of corners and edges are shared by all faces they belong to, so
// a ray never slips between two neighbours or meets both. What is left to rounding is where a crossing lies, never
// whether: the count behind any number of crossings is right.
//
// An orthographic camera is an eye infinitely far back. Then the crossings from there on are counted.
#pragma once
#include "scene/camera.h"
#include "trace/shadows/volumes/shadow_volumes.h"
#include "volume/bricks/brick_walk.h"

namespace tyndall {
// x·p.x + y·p.y + z·p.z + w; p is a ray's direction, or where it crosses the plane of `place` when rays are parallel.
using RayProduct = glm::dvec4;

inline constexpr int shadow_tile_side = 8; // pixels

// Faces of one kind by tiles of the picture, the nearest first.
struct ShadowTiles {
    struct Face {
        float nearest = 0; // no ray meets it before, metres from the camera along the ray
        uint32_t index = 0;
    };
    std::vector<uint32_t> first; // of the faces of each tile; one more at the end
    std::vector<Face> faces;
};

struct ShadowView {
    struct Edge {
        uint32_t a = 0, b = 0;
        double start = 0;  // above 0 where the eye lies to its left
        RayProduct before; // of another sign than `start` where the edge lies between ray and light
    };
    struct Side {
        uint32_t edge = 0;
        int change = 0;    // of the count, for every ray that crosses it
        RayProduct across; // crossed at t = start / -across, or at across / start when rays are parallel
    };
    struct Cap {
        uint32_t edges[3];
        bool left[3];
        bool dark = false;     // the eye is in its volume
        bool opposite = false; // the point opposite to the eye, beyond the light, is: rays end in it at infinity
        dvec3 normal{0};       // the plane normal·x = height, x from `place`
        double height = 0;
    };
    LightPoint light; // from `place`
    dvec3 place{0}, forward{0, 0, -1};
    bool parallel = false;
    int dark = 0; // volumes the eye is in
    std::vector<RayProduct> corners;
    std::vector<Edge> edges;
    std::vector<Side> sides;
    std::vector<Cap> caps;
    ivec2 tiles{0}; // 0 = not binned
    ShadowTiles side_tiles, cap_tiles;
};

// For rays from one point; or all in one direction, with any origins.
ShadowView view_from(const ShadowVolumes& volumes, dvec3 point);
ShadowView view_along(const ShadowVolumes& volumes, dvec3 place, dvec3 direction);

// For the rays of a camera, which may stray by `margin` pixels from their pixel; binned.
ShadowView view_from(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin);

// Sorts sides and caps into the picture's tiles.
void fill_tiles(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin, ShadowView& view);

// A face that some of sixteen rays cross: where, by each ray's own t (infinite on rays that do not cross it), and by
// how much the count of volumes around the ray changes there.
struct ShadowCrossing {
    alignas(64) float t[16] = {};
    alignas(64) float change[16] = {};
    alignas(
        64) float behind[16] = {}; // metres from there to the edge that casts this shadow; 0 at caps, or not asked for
};

// The tile of the image that all positions lie in, no farther than `margin` pixels outside of it; -1 where there is
// none.
int tile_of(const ShadowView& view, std::span<const vec2> positions, float margin);

// Up to 16 rays of a view.
struct ShadowViewRays {
    alignas(64) double p[3][16] = {};  // see RayProduct
    alignas(64) double start[16] = {}; // of each ray: from the eye, or from the plane of `place` when rays are parallel
    alignas(64) double end[16] = {};   // how far crossings are wanted, counted as `start`
    uint32_t active = 0;               // bits
    int tile = -1;                     // that all of them lie in; -1 = unknown
    bool edges = true;                 // whether crossings tell how far behind an edge they lie
};

// Makes a ray that the view's eye sees the lane-th of `rays`, up to its t_max. A ray along or through the light is
// turned off it by a hair.
void place_ray(const ShadowView& view, const Ray& ray, int lane, ShadowViewRays& rays);

// Appends the crossings of the active rays up to their ends, in no order.
void find_crossings(const ShadowView& view, const ShadowViewRays& rays, std::vector<ShadowCrossing>& crossings);

// Sorts the crossings of each ray (but not `behind`) and appends its stretches of low..high in no volume; `dark`: the
// counts before all crossings.
void append_lit(const int (&dark)[16], std::vector<ShadowCrossing>& crossings, const Interval<double> (&ranges)[16],
                std::vector<Interval<double>> (&lit)[16]);
}
