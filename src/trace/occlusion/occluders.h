// The triangles of a moment in Embree: closest hits and shadow transmission. The only user of Embree.
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

// Closest hits of 16 rays. instance < 0 = no hit, and t is infinite.
struct Hits {
    std::array<float, 16> t;
    std::array<int32_t, 16> instance, triangle; // indices into Scene::instances and its mesh's triangles
    std::array<float, 16> u, v;                 // barycentrics of the 2nd and 3rd corner
};

struct SurfacePoint {
    vec3 position{0};
    vec3 normal{0, 1, 0};      // shading normal, toward the viewer
    vec3 face_normal{0, 1, 0}; // geometric, toward the viewer
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

// Instruction set of the ray tracer: "avx2", "avx512", or "auto" (avx2: the same hits on every machine). Call it before
// making the first Occluders. Throws Error if a later call would change it, or if the machine lacks the set.
void set_embree_isa(std::string_view isa);

// How far a ray must start from a surface at `position` to miss it: 32 ulps of the largest coordinate.
inline float shadow_offset(vec3 position) { return 4e-6f * std::max(max_component(glm::abs(position)), 1e-5f); }

// How far a ray that has traveled a distance to `position` must go on to miss the surface there: larger than the
// rounding error of the point, too small to be visible.
inline float surface_skip(vec3 position, float traveled) { return std::max(shadow_offset(position), 4e-6f * traveled); }

// A ray that leaves a surface: it starts off the face, on the side it goes to, and ends where the given one does, short
// of any surface there.
Ray off_surface(vec3 face_normal, const Ray& ray);

class Occluders {
public:
    // World-space triangles of every instance at a moment. Non-finite and degenerate triangles are left out and
    // counted. Shares geometry that does not move with `previous`, which must be of the same, unmodified Scene. The
    // Scene must outlive the result. `only` (a flag per instance) restricts it to some. Throws Error (out_of_memory,
    // internal).
    static std::shared_ptr<const Occluders> make(const Scene& scene, double seconds, const Occluders* previous,
                                                 const std::vector<bool>* only = nullptr);
    ~Occluders();

    bool empty() const;
    Box bounds() const;
    uint64_t triangle_count() const;
    uint64_t dropped() const;                       // triangles left out
    std::string content() const;                    // identifies its instances and their placements
    bool shares_with(const Occluders& other) const; // the same triangles at the same positions, not rebuilt

    // Closest hit of up to 16 rays beyond t_min. Rays pass alpha MASK holes and hit BLEND surfaces. A ray with a
    // non-finite or huge component hits nothing. `coherent`: a hint that the rays start close together.
    void closest(std::span<const Ray> rays, float t_min, Hits& hits, bool coherent = true) const;

    // Fraction of light that passes from each origin along direction to t_max: 1 free, 0 blocked, in between through
    // BLEND. Lanes with active[i] == 0 are left unchanged. Rays start t_min from their origin. A ray with a non-finite
    // or huge component counts as blocked.
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
    // The same for surfaces with alpha only: opaque ones block nothing.
    void alpha_transmission(const ShadowRays& rays, float* visibility) const;
    float transmission(const Ray& ray, float t_min) const; // a single ray: slow, for tests and benchmarks

    SurfacePoint surface(const Ray& ray, const Hits& hits, int lane) const;

    // Exactly the triangles that shadow rays hit, for exact shadows; and whether any of them has alpha.
    std::vector<ShadowTriangle> shadow_triangles() const;
    bool has_alpha() const;

    // Built from these triangles on first use. Thread-safe.
    const ShadowSlices& shadow_slices() const;
    std::shared_ptr<const ShadowMesh> shadow_mesh() const;

private:
    Occluders();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}
