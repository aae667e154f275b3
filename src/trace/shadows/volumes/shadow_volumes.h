// Shadow volumes of a mesh in one light (Crow 1977). Every triangle, turned to face the light, casts a volume of its
// own: the triangle is its cap, the planes through its edges and the light are its sides, and it has no end. A point is
// in shadow where it lies in one of them or more. At an edge the sides of the triangles on either hand cancel: what
// remains is the silhouette, where a neighbour is missing or N·L changes its sign (there twice). This counts rightly
// for any mesh: open, with edges of three triangles, flipped or doubled faces.
//
// Volumes depend on mesh and light only; trace/shadows/volumes/shadow_view.h looks at them from a camera.
#pragma once
#include "trace/lights/light_ray.h"
#include "trace/shadows/volumes/shadow_mesh.h"

#include <optional>

namespace tyndall {
struct Light;

// The beam of a spot: shadows outside of it are never asked for.
struct ShadowReach {
    dvec3 apex{0}, axis{0, 0, -1}; // unit
    double half_angle = 0;         // of its cone, below π/2
};
std::optional<ShadowReach> shadow_reach(const Light& light); // none = everywhere

struct ShadowVolumes {
    struct Cap {
        uint32_t triangle = 0;
        bool flipped = false; // its corners run clockwise as the light sees them
    };
    struct Side {
        uint32_t edge = 0;
        int volumes = 0; // triangles to the left of a→b as the light sees them, less those to the right
    };
    std::shared_ptr<const ShadowMesh> mesh;
    LightPoint light;
    std::optional<ShadowReach> reach;
    std::vector<Cap> caps;
    std::vector<Side> sides; // none of 0 volumes
};

// Triangles the light sees edge-on, and those inside the light's ball, cast none.
ShadowVolumes make_shadow_volumes(std::shared_ptr<const ShadowMesh> mesh, const LightPoint& light,
                                  std::optional<ShadowReach> reach = {});

// From a corner towards the light, of any length.
inline dvec3 towards(const LightPoint& light, dvec3 corner) { return light.far ? light.at : light.at - corner; }

// Whether the volume of a cap lies to the left of its k-th edge a→b, as the light sees it.
inline bool is_left(const ShadowMesh::Triangle& triangle, int k, bool flipped) {
    return (triangle.corners[k] < triangle.corners[(k + 1) % 3]) != flipped;
}

// Triangles between a point and the light, one by one: the slow way to ask.
int count_between(const ShadowVolumes& volumes, dvec3 point);
}
