// Intersections of rays with shadow volumes.
#include "integrate/single_scattering/single_scattering.h"
#include "trace/occlusion/occluders.h"

namespace tyndall {
namespace {
bool comes_from(const ShadowView& view, const Camera& camera, const Ray& ray) {
    if (view.parallel) return glm::distance(ray.direction, camera.forward) < 1e-5f;
    if (ray.origin == camera.position) return true;
    const vec3 from = ray.origin - camera.position;
    const float along = glm::dot(from, ray.direction), rounding = 0.25f * shadow_offset(camera.position);
    return glm::length(from - along * ray.direction) <= rounding + 1e-5f * std::abs(along) && along >= -rounding;
}

void find_in_view(const ShadowView& view, ShadowViewRays& rays, std::vector<ShadowCrossing>& crossings,
                  int (&dark)[16]) {
    find_crossings(view, rays, crossings);
    for (int i = 0; i < 16; ++i)
        if (rays.active >> i & 1) dark[i] = view.dark;
}
}

void find_shadows(const SingleScattering& frame, size_t light, const RayBatch& batch,
                  const Interval<double> (&reached)[16], std::vector<ShadowCrossing>& crossings, int (&dark)[16]) {
    const LightShadows& caster = frame.shadows[light];
    crossings.clear(), std::fill(dark, dark + 16, 0);
    if (caster.by != ShadowMethod::volumes) return;
    ShadowViewRays rays;
    rays.edges = frame.shells.has_value();
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        if (reached[i].empty()) continue;
        const Ray ray{batch.rays[i].origin, batch.rays[i].direction,
                      std::nextafter(static_cast<float>(reached[i].high), infinity)};
        const int lane = static_cast<int>(i);
        if (comes_from(*caster.view, frame.camera, ray)) {
            place_ray(*caster.view, ray, lane, rays);
        } else { // not a camera ray: use its origin as the eye
            ShadowViewRays alone;
            alone.edges = rays.edges;
            const ShadowView view = view_from(*caster.volumes, dvec3(ray.origin));
            place_ray(view, ray, lane, alone);
            find_in_view(view, alone, crossings, dark);
        }
    }
    if (!rays.active) return;
    rays.tile = tile_of(*caster.view, batch.positions, frame.margin);
    find_in_view(*caster.view, rays, crossings, dark);
}
}
