// The triangles of a moment in Embree: what a ray meets, and whether light gets through. The only user of Embree.
#pragma once
#include "base/math.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct Scene;
struct ShadowMesh;
struct ShadowSlices;

// What 16 rays meet first. instance < 0 = nothing, and t is infinite.
struct Hits {
    std::array<float, 16> t;
    std::array<int32_t, 16> instance, triangle; // indices into Scene::instances and its mesh's triangles
    std::array<float, 16> u, v;                 // barycentrics of the 2nd and 3rd corner
};

struct SurfacePoint {
    vec3 position{0};
    vec3 normal{0, 1, 0};      // shading normal, towards the viewer
    vec3 face_normal{0, 1, 0}; // geometric, towards the viewer
    vec3 base_color{1};
    vec3 emission{0};
    float alpha = 1;
    int instance = -1; // of the scene
};

// A triangle that casts shadows, in world space.
struct ShadowTriangle {
    vec3 corners[3];
    bool has_alpha = false; // MASK or BLEND: light may get through
};

// Instruction set of the ray tracer: "avx2", "avx512", or "auto" (avx2: the same hits on every machine). Takes effect
// before the first Occluders only; later calls that would change it, and sets this machine lacks, throw Error.
void set_embree_isa(std::string_view isa);

// How far a ray must start from a surface at `position` to miss it: 32 ulps of the largest coordinate.
inline float shadow_offset(vec3 position) { return 4e-6f * std::max(max_component(glm::abs(position)), 1e-5f); }

// Where a ray that leaves a surface starts: off the face, on the side that it goes to.
inline vec3 off_surface(vec3 position, vec3 face_normal, vec3 direction) {
    const float side = glm::dot(face_normal, direction) < 0 ? -1.0f : 1.0f;
    return position + face_normal * (side * shadow_offset(position));
}

class Occluders {
public:
    // World-space triangles of every instance at a moment. Non-finite and degenerate triangles are left out and
    // counted. Shares geometry that does not move with `previous`, which must be of the same, unchanged Scene. The
    // Scene must outlive the result. With `only`, a flag for every instance, of those alone. Throws Error
    // (out_of_memory, internal).
    static std::shared_ptr<const Occluders> make(const Scene& scene, double seconds, const Occluders* previous,
                                                 const std::vector<bool>* only = nullptr);
    ~Occluders();

    bool empty() const;
    Box bounds() const;
    uint64_t triangle_count() const;
    uint64_t dropped() const;                       // triangles left out
    std::string content() const;                    // which instances there are, and where they stand
    bool shares_with(const Occluders& other) const; // the same triangles at the same places, not rebuilt

    // First surface of up to 16 rays beyond t_min. Alpha MASK holes are passed; BLEND surfaces are hit.
    // A ray with a non-finite or huge component hits nothing. `coherent`: the rays start together.
    void closest(std::span<const Ray> rays, float t_min, Hits& hits, bool coherent = true) const;

    // Share of light that passes from each origin along direction to t_max: 1 free, 0 blocked, between through BLEND.
    // Lanes with active[i] == 0 are left as they are. Rays start t_min in front of their origin. A ray with a
    // non-finite or huge component counts as blocked.
    struct ShadowRays {
        alignas(64) float ox[16], oy[16], oz[16], dx[16], dy[16], dz[16], t_min[16], t_max[16];
        alignas(64) int32_t active[16]; // -1 = trace, 0 = skip

        void set(size_t lane, const Ray& ray, float near = 0) {
            ox[lane] = ray.origin.x, oy[lane] = ray.origin.y, oz[lane] = ray.origin.z;
            dx[lane] = ray.direction.x, dy[lane] = ray.direction.y, dz[lane] = ray.direction.z;
            t_min[lane] = near, t_max[lane] = ray.t_max, active[lane] = -1;
        }
    };
    void transmission(const ShadowRays& rays, float* visibility) const;
    // Likewise of surfaces with alpha alone: what opaque ones block counts as free.
    void alpha_transmission(const ShadowRays& rays, float* visibility) const;
    float transmission(const Ray& ray, float t_min) const; // a single ray: the slow way, for tests and benchmarks

    SurfacePoint surface(const Ray& ray, const Hits& hits, int lane) const;

    // The very triangles that shadow rays meet, for exact shadows; and whether any of them has alpha.
    std::vector<ShadowTriangle> shadow_triangles() const;
    bool has_alpha() const;

    // Made of them when first asked for, once, by any thread.
    const ShadowSlices& shadow_slices() const;
    std::shared_ptr<const ShadowMesh> shadow_mesh() const;

private:
    Occluders();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}
