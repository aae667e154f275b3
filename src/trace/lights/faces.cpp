#include "trace/lights/faces.h"

#include "scene/area_shape.h"
#include "trace/occlusion/occluders.h"
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
// A ray from each surface point to a point of the face, and the unoccluded irradiance along it.
struct FaceRays {
    Occluders::ShadowRays rays{};
    vec3 light[16];
};

void aim(const Snapshot& snapshot, const Light& light, std::span<const SurfacePoint> points, std::span<const vec2> u,
         size_t k, FaceRays& to) {
    const size_t count = u.size() / points.size();
    const vec3 radiance = radiance_of(light) * (light.surface_scale / static_cast<float>(count));
    for (size_t i = 0; i < points.size(); ++i) {
        to.rays.active[i] = 0;
        const SurfacePoint& point = points[i];
        if (!is_lit(light, snapshot, point.instance)) continue;
        const AreaSample sample = sample_area(*light.area, point.position, u[i * count + k]);
        const float cosine = glm::dot(point.normal, sample.direction);
        if (!(cosine > 0) || !(sample.steradians > 0)) continue;
        to.rays.set(i, off_surface(point.face_normal, {point.position, sample.direction, sample.distance * 0.9999f}));
        const vec3 picture = face_texture(*light.area, point.position + sample.distance * sample.direction);
        to.light[i] = radiance * (sample.steradians * cosine) * picture;
    }
}
}

void add_face_light(const Snapshot& snapshot, const Light& light, bool dimmed, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> irradiance) {
    const auto& occluders = shadow_casters(light, snapshot);
    if (!(light.surface_scale > 0)) return;
    FaceRays to;
    for (size_t k = 0; k < u.size() / points.size(); ++k) {
        aim(snapshot, light, points, u, k, to);
        alignas(64) float visibility[16];
        std::fill_n(visibility, 16, 1.0f);
        if (occluders) occluders->transmission(to.rays, visibility);
        for (size_t i = 0; i < points.size(); ++i) {
            if (!to.rays.active[i] || !(visibility[i] > 0)) continue;
            const Ray way{points[i].position, {to.rays.dx[i], to.rays.dy[i], to.rays.dz[i]}, to.rays.t_max[i]};
            double depth = 0;
            for (const Medium& medium : snapshot.media)
                if (dimmed && !only_emits(medium.optics)) depth += optical_depth(medium, way);
            irradiance[i] += to.light[i] * (visibility[i] * static_cast<float>(std::exp(-depth)));
        }
    }
}
}
