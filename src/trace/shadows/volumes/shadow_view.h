// Shadow volumes as seen by one camera: which sides and caps a ray crosses, found by signs alone.
//
// Seen from the light, a ray from the eye is a half line across an image of the triangles. Each corner lies on one side
// of that line (`corners`, one product per ray). An edge whose corners lie on different sides is crossed ahead of the
// eye or behind it, which the eye's position relative to the edge decides for all rays at once (`start`), and lies
// between ray and light or beyond the ray (`before`). All faces of a corner or edge share its signs, so a ray never
// slips between two neighbors or hits both. Rounding affects only where a crossing lies, never whether there is one:
// the count of volumes is correct after any number of crossings.
//
// An orthographic camera is an eye infinitely far back, and crossings are counted from there.
#pragma once
#include "scene/camera.h"
#include "trace/shadows/volumes/shadow_volumes.h"
#include "volume/bricks/brick_walk.h"

namespace tyndall {
// x·p.x + y·p.y + z·p.z + w; p is a ray's direction or, if rays are parallel, where it crosses the plane of `anchor`.
using RayProduct = glm::dvec4;

inline constexpr int shadow_tile_side = 8; // pixels

// Faces of one kind by image tile, the nearest first.
struct ShadowTiles {
    struct Face {
        float nearest = 0; // lower bound of hit distances, meters from the camera along the ray
        uint32_t index = 0;
    };
    std::vector<uint32_t> first; // index of the first face of each tile; one more at the end
    std::vector<Face> faces;
};

struct ShadowView {
    struct Edge {
        uint32_t a = 0, b = 0;
        double start = 0;  // positive if the eye lies to its left
        RayProduct before; // its sign differs from that of `start` if the edge lies between ray and light
    };
    struct Side {
        uint32_t edge = 0;
        int change = 0;    // of the volume count, for every ray that crosses it
        RayProduct across; // crossed at t = start / -across, or at across / start if rays are parallel
    };
    struct Cap {
        uint32_t edges[3];
        bool left[3];
        bool dark = false;     // the eye is in its volume
        bool opposite = false; // so is the point opposite the eye, beyond the light: rays end in it at infinity
        dvec3 normal{0};       // the plane normal·x = height, x from `anchor`
        double height = 0;
    };
    LightPoint light; // relative to `anchor`
    dvec3 anchor{0}, forward{0, 0, -1};
    bool parallel = false;
    int dark = 0; // volumes the eye is in
    std::vector<RayProduct> corners;
    std::vector<Edge> edges;
    std::vector<Side> sides;
    std::vector<Cap> caps;
    ivec2 tiles{0}; // 0 = not binned
    ShadowTiles side_tiles, cap_tiles;
};

// Views for rays from one point, and for parallel rays with any origins.
ShadowView view_from(const ShadowVolumes& volumes, dvec3 point);
ShadowView view_along(const ShadowVolumes& volumes, dvec3 anchor, dvec3 direction);

// For a camera's rays, which may deviate by `margin` pixels from their pixel; faces are binned.
ShadowView view_from(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin);

// Bins sides and caps into the image's tiles.
void fill_tiles(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin, ShadowView& view);

// A face that some of sixteen rays cross: each ray's t there (infinite if it does not cross), and by how much the
// number of volumes around the ray changes.
struct ShadowCrossing {
    alignas(64) float t[16] = {};
    alignas(64) float change[16] = {};
    alignas(
        64) float behind[16] = {}; // meters from there to the edge that casts this shadow; 0 at caps, or if not needed
};

// The image tile that contains all positions, at most `margin` pixels outside; -1 if there is none.
int tile_of(const ShadowView& view, std::span<const vec2> positions, float margin);

// Up to 16 rays of a view.
struct ShadowViewRays {
    alignas(64) double p[3][16] = {};  // see RayProduct
    alignas(64) double start[16] = {}; // t of its origin: from the eye or, if rays are parallel, the plane of `anchor`
    alignas(64) double end[16] = {};   // t up to which crossings are found, measured like `start`
    uint32_t active = 0;               // bits
    int tile = -1;                     // that all of them lie in; -1 = unknown
    bool edges = true;                 // whether crossings have their distance behind an edge
};

// Sets the lane-th of `rays` to a ray of the view's eye, up to its t_max. A ray along or through the light is turned
// off it by a tiny angle.
void place_ray(const ShadowView& view, const Ray& ray, int lane, ShadowViewRays& rays);

// Appends the crossings of the active rays up to their ends, in any order.
void find_crossings(const ShadowView& view, const ShadowViewRays& rays, std::vector<ShadowCrossing>& crossings);

// Sorts the crossings of each ray (but not `behind`) and appends the parts of its range that lie in no volume; `dark`:
// the counts before all crossings.
using LitSegments = std::vector<Interval<double>>[16];
void append_lit(const int (&dark)[16], std::vector<ShadowCrossing>& crossings, const Interval<double> (&ranges)[16],
                LitSegments& lit);

// The same for up to 16 rays from the view's eye; rays with empty ranges get none. `tile`: as in ShadowViewRays.
void append_lit(const ShadowView& view, std::span<const Ray> rays, const Interval<double> (&ranges)[16], int tile,
                LitSegments& lit);
}
