// Shadow volumes of a mesh in one light (Crow 1977). Every triangle, oriented to face the light, casts its own volume:
// the triangle is its cap, the planes through its edges and the light are its sides, and it extends to infinity. A
// point is in shadow if at least one volume contains it. At an edge, the sides of its two triangles cancel; silhouettes
// remain, where a neighbor is missing or N·L changes sign (there twice). The count is correct for any mesh: open, with
// edges of three triangles, with flipped or duplicate faces.
//
// Volumes depend on mesh and light only; trace/shadows/volumes/shadow_view.h prepares them for a camera.
#pragma once
#include "trace/lights/light_ray.h"
#include "trace/shadows/volumes/shadow_mesh.h"

#include <optional>

namespace tyndall {
struct Light;

// The beam of a spot: shadows outside of it are never needed.
struct ShadowCone {
    dvec3 apex{0}, axis{0, 0, -1}; // unit
    double half_angle = 0;         // of its cone, below π/2
};
std::optional<ShadowCone> shadow_cone(const Light& light); // none = everywhere

struct ShadowVolumes {
    struct Cap {
        uint32_t triangle = 0;
        bool flipped = false; // its corners run clockwise as seen from the light
    };
    struct Side {
        uint32_t edge = 0;
        int volumes = 0; // triangles to the left of a→b as seen from the light, minus those to the right
    };
    std::shared_ptr<const ShadowMesh> mesh;
    LightPoint light;
    std::optional<ShadowCone> reach;
    std::vector<Cap> caps;
    std::vector<Side> sides; // without those of 0 volumes
};

// Triangles seen edge-on from the light, and those inside its sphere, cast none.
ShadowVolumes make_shadow_volumes(std::shared_ptr<const ShadowMesh> mesh, const LightPoint& light,
                                  std::optional<ShadowCone> reach = {});

// The point of a light's sphere at `off` from its center or, if a shadow caster lies between, a point just in front of
// that: behind a wall that cuts through the sphere, it would not light the room.
LightPoint visible_point(const ShadowMesh& mesh, LightPoint center, dvec3 off);

// From a corner toward the light, of any length.
inline dvec3 towards(const LightPoint& light, dvec3 corner) { return light.far ? light.at : light.at - corner; }

// Whether the volume of a cap lies to the left of its k-th edge a→b, as seen from the light.
inline bool is_left(const ShadowMesh::Triangle& triangle, int k, bool flipped) {
    return (triangle.corners[k] < triangle.corners[(k + 1) % 3]) != flipped;
}

// Number of triangles between a point and the light, tested one by one: slow, for tests.
int count_between(const ShadowVolumes& volumes, dvec3 point);
}
