#include "modes/lens_fog.h"

#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <cmath>
#include <optional>

namespace tyndall {
namespace {
Ray ray_from_middle(const Camera& camera, const Ray& ray) {
    const float along = glm::dot(ray.direction, camera.forward), start = planar_depth(camera, ray, 0);
    const vec3 in_focus = ray.at((camera.lens.focus - start) / along);
    const vec3 direction = glm::normalize(in_focus - camera.position);
    const float slant = 1 / glm::dot(direction, camera.forward);
    const bool at_lens = start <= 0.25f * shadow_offset(camera.position);
    const vec3 origin = at_lens ? camera.position : camera.position + start * slant * direction;
    return {origin, direction, ray.t_max * along * slant};
}

constexpr int points_of_ray = 64;

float point_of(const Ray& ray, int i) { return ray.t_max * (static_cast<float>(i) + 0.5f) / points_of_ray; }

// Calls visit(ray, t) where the ray enters or leaves the light's cone or a shadow.
template<class Visit>
void visit_edges(const Light& light, const Snapshot& snapshot, const Ray& ray, const Visit& visit) {
    const auto& casters = shadow_casters(light, snapshot);
    std::optional<bool> before;
    for (int i = 0; i < points_of_ray; ++i) {
        const vec3 point = ray.at(point_of(ray, i));
        const LightSample at = arrival(light, point);
        const bool lit = max_component(at.irradiance) > 0 &&
                         (!casters || casters->transmission({point, at.to_light, at.distance}, 0) > 0.5f);
        if (before && *before != lit) visit(ray, point_of(ray, i));
        before = lit;
    }
}

// Distance along the ray at which media with detail of their own first become visible; infinite if none does.
float first_detail(const Snapshot& snapshot, const Ray& ray) {
    const float step = ray.t_max / points_of_ray;
    double depth = 0;
    for (int i = 0; i < points_of_ray; ++i) {
        for (const Medium& medium : snapshot.media)
            if (medium.density.kind == DensityKind::bricks)
                depth += optical_depth(medium, {ray.at(static_cast<float>(i) * step), ray.direction, step});
        if (-std::expm1(-depth) > visible_error) return point_of(ray, i);
    }
    return infinity;
}
}

ScatterFunction through_middle(const View& view, ScatterFunction scatter) {
    if (!view.camera.lens) return scatter;
    return [camera = view.camera, scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        Ray rays[16];
        for (size_t i = 0; i < batch.rays.size(); ++i) rays[i] = ray_from_middle(camera, batch.rays[i]);
        RayBatch middle = batch;
        middle.rays = {rays, batch.rays.size()};
        scatter(middle, results);
    };
}

void add_fog_through_middle(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    const Camera& camera = view.camera;
    if (!camera.lens || snapshot.media.empty()) return;
    double blur = 0, at = 0;
    const auto count = [&](float depth) {
        const double here = std::isfinite(depth) ? blur_diameter(camera, view.size, depth) : 0;
        if (depth > camera.near && here > blur) blur = here, at = depth;
    };
    const auto count_at = [&](const Ray& ray, float t) { count(planar_depth(camera, ray, t)); };
    for (const Ray& ray : probing_rays(view, snapshot)) {
        for (const Light& light : snapshot.lights) visit_edges(light, snapshot, ray, count_at);
        if (const float nearest = first_detail(snapshot, ray); nearest < ray.t_max) count_at(ray, nearest);
        count_at(ray, ray.t_max);
    }
    for (const Light& light : snapshot.lights) {
        const auto seen = is_distant(light) ? std::nullopt : pixel_of(camera, view.size, light.position);
        if (seen && glm::all(glm::greaterThan(*seen, vec2(0))) && glm::all(glm::lessThan(*seen, vec2(view.size))))
            count(glm::dot(light.position - camera.position, camera.forward));
    }
    limitations.push_back({blur > 1 ? Severity::degraded : Severity::info,
                           &limitation::fog_through_middle,
                           Subject::camera,
                           camera.name,
                           {blur, at}});
}

void add_no_fog_picture(const View& view, const char* row, Limitations& limitations) {
    if (view.camera.lens) limitations.push_back({Severity::info, &limitation::no_fog_picture, Subject::setting, row});
}
}
