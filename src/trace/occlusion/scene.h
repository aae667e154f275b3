// Internals of Occluders: Embree's device, and one set of triangles with its acceleration structure.
#pragma once
#include "scene/mesh.h"
#include "scene/pose.h"
#include "trace/occlusion/embree.h"
#include "trace/occlusion/occluders.h"

#include <mutex>

namespace tyndall {
// Embree's limit for ray and vertex coordinates is 1.844e18; beyond it the packaged library aborts.
inline constexpr float largest_coordinate = 1e18f;

// The one device of the process, made on first use. Throws Error.
RTCDevice embree_device();

// Whether the device natively takes packets of 16 rays; else 8 is its widest.
bool traces_sixteen();

// Throws the first error that Embree reported since the last call, if any.
void check_embree();

// One instance's triangles in world space.
struct OccluderGeometry {
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;    // null = white Lambert
    const Texture* base_texture = nullptr; // null if missing or without texels
    const Texture* emission_texture = nullptr;
    int instance = 0;
    mat3 normal_to_world{1};
    std::vector<vec3> positions;     // one more than the mesh has: Embree loads 16 bytes at a time
    std::vector<vec3> posed_normals; // if the mesh is posed; else its own are used
    std::vector<glm::uvec3> kept;    // the valid triangles if some were left out; else the mesh's own are used
    std::vector<uint32_t> originals; // their indices in the mesh; empty if all are used
    uint64_t left_out = 0;

    uint32_t triangle_in_mesh(uint32_t primitive) const { return originals.empty() ? primitive : originals[primitive]; }
    bool masks() const { return material && material->alpha_mode == AlphaMode::mask; }
    bool blends() const { return material && material->alpha_mode == AlphaMode::blend; }
    // Whether light may pass through: masks, and blended surfaces that are not fully opaque.
    bool passes_light() const {
        return masks() || (blends() && (base_texture || material->alpha < 1 || !mesh->alphas.empty()));
    }
    const std::vector<vec3>& normals() const { return posed_normals.empty() ? mesh->normals : posed_normals; }
    // The triangles that Embree has: all of the mesh, or the valid ones.
    const std::vector<glm::uvec3>& traced() const { return left_out ? kept : mesh->triangles; }
    // Opacity at a point of a triangle of the mesh: 1 for opaque materials, 0 or 1 for masks.
    float opacity(uint32_t triangle, float u, float v) const;
};

// Vertex attributes at barycentrics u (2nd corner) and v (3rd corner).
template<class T> T interpolated(const std::vector<T>& values, glm::uvec3 corners, float u, float v) {
    return (1 - u - v) * values[corners.x] + u * values[corners.y] + v * values[corners.z];
}

// An instance's transform and pose.
struct Placement {
    mat4 matrix{1};
    Pose pose;

    bool operator==(const Placement&) const = default;
};

struct OccluderSet {
    RTCScene scene = nullptr;                 // null = no triangles
    std::vector<OccluderGeometry> geometries; // indexed by Embree's geometry IDs
    std::vector<int> instances;               // what it was built from ...
    std::vector<Placement> placements;        // ... and their placements
    Box bounds;
    uint64_t triangles = 0, dropped = 0;
    bool has_alpha = false;

    // The part that light may pass through, built on first use. Null = none.
    mutable std::once_flag sifted;
    mutable std::shared_ptr<const OccluderSet> passing;

    OccluderSet() = default;
    OccluderSet(const OccluderSet&) = delete;
    OccluderSet& operator=(const OccluderSet&) = delete;
    ~OccluderSet();
};

// Static and moving triangles in separate sets, so that the static one is built once.
struct Occluders::Impl {
    const Scene* scene = nullptr;
    std::shared_ptr<const OccluderSet> still, moving;
    std::vector<const OccluderGeometry*> by_instance; // null = no triangles

    // Built on first use.
    std::once_flag sliced, meshed;
    std::shared_ptr<const ShadowSlices> slices;
    std::shared_ptr<const ShadowMesh> mesh;
};

// Throws Error (out_of_memory) if the triangles of instances would not fit in memory, at so many bytes each: every
// instance has its own.
void check_triangles_fit(const Scene& scene, const std::vector<int>& instances, uint64_t bytes_each);

// Triangles of some instances with their placements, ready to trace. Throws Error.
std::shared_ptr<const OccluderSet> make_occluder_set(const Scene& scene, std::vector<int> instances,
                                                     std::vector<Placement> placements);

// The part of a set that light may pass through; null = none. Throws Error.
const OccluderSet* passing_part(const Scene& scene, const OccluderSet& set);

// State of shadow rays: Embree's context and the transmission of each lane.
struct ShadowContext {
    static constexpr int remembered = 4;
    QueryContext embree;
    double left[16];
    struct Passed {
        uint32_t geometry;
        float t;
    } passed[16][remembered]; // the last surfaces each lane passed through
    int count[16];

    void forget(); // full transmission, no surface passed; needed before tracing geometry with alpha
};

// Embree's callbacks for geometries with alpha.
void pass_mask_holes(const RTCFilterFunctionNArguments* call);
void pass_light(const RTCFilterFunctionNArguments* call);
}
