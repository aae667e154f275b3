#include "trace/lights/faces.h"

#include "scene/lights/area_shape.h"
#include "trace/lights/surface_rays.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
bool shows_faces(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.lights, [](const Light& light) { return light.area && light.area->visible; });
}

FaceHit visible_face(const Snapshot& snapshot, const Ray& ray) {
    FaceHit hit;
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const AreaShape* face = snapshot.lights[i].area.get();
        if (!face || !face->visible) continue;
        const float distance = area_hit(*face, ray);
        if (distance < hit.distance && distance <= ray.t_max) hit = {static_cast<int>(i), distance};
    }
    return hit;
}

namespace {
// A ray from each surface point to a point of the face, with the irradiance along it.
SurfaceRays aim(const Snapshot& snapshot, const Light& light, std::span<const SurfacePoint> points,
                std::span<const vec2> u, size_t k) {
    SurfaceRays to;
    const size_t count = u.size() / points.size();
    const vec3 radiance = radiance_of(light) * (light.surface_scale / static_cast<float>(count));
    for (size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint& point = points[i];
        if (!is_lit(light, snapshot, point.instance)) continue;
        const AreaSample sample = sample_area(*light.area, point.position, u[i * count + k]);
        const float cosine = glm::dot(point.normal, sample.direction);
        if (!(cosine > 0) || !(sample.steradians > 0)) continue;
        const vec3 picture = face_texture(*light.area, point.position + sample.distance * sample.direction);
        to.set(i, point, sample.direction, sample.distance * shadow_reach<float>,
               radiance * (sample.steradians * cosine) * picture);
    }
    return to;
}
}

void add_face_light(const Snapshot& snapshot, const Light& light, bool dimmed, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> irradiance) {
    const auto& occluders = shadow_casters(light, snapshot);
    if (!(light.surface_scale > 0)) return;
    const std::span<const Medium> media = dimmed ? snapshot.media : std::span<const Medium>();
    for (size_t k = 0; k < u.size() / points.size(); ++k)
        add_unblocked(aim(snapshot, light, points, u, k), occluders.get(), media, points, 1, irradiance);
}
}
