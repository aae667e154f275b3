#include "modes/limits.h"

#include "modes/settings.h"
#include "trace/fluence/light_paths.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <algorithm>
#include <cstdio>

namespace tyndall {
namespace {
constexpr float deep_cell = 0.3f;    // optical depths, across which the dimming of light is far from linear
constexpr float deep_step = 0.15f;   // optical depths
constexpr float detail_voxels = 2;   // of fog that changes from voxel to voxel
constexpr float seen_offset = 0.25f; // pixels

// How thick a medium can be at most across its own bounds, as optical depth.
float thickness(const Medium& medium, const Box& scene_bounds) {
    Box box = medium.world_bounds;
    box.low = glm::max(box.low, scene_bounds.low), box.high = glm::min(box.high, scene_bounds.high);
    return box.empty() ? 0 : medium.majorant() * glm::length(box.size());
}

// How far places as far from the origin as the camera are off, against a pixel in the middle of the scene.
void add_precision_limit(const View& view, const Snapshot& snapshot, std::vector<Limit>& limits) {
    const Camera& camera = view.camera;
    if (snapshot.bounds.empty()) return;
    const float offset = shadow_offset(camera.position);
    const float depth = std::max(glm::dot(snapshot.bounds.center() - camera.position, camera.forward), camera.near);
    const float height =
        camera.ortho_height > 0 ? camera.ortho_height : 2 * depth * std::tan(0.5f * camera.vertical_fov);
    if (offset < seen_offset * height / static_cast<float>(view.size.y)) return;
    limits.push_back({Severity::degraded, "scene",
                      "lies so far from the origin that places are known to " + number_text("%.2g", offset) +
                          " m only: edges and shadows are as coarse"});
}

void add_ambient_limit(const Snapshot& snapshot, std::vector<Limit>& limits) {
    if (max_component(snapshot.ambient) > 0)
        limits.push_back({Severity::info, "ambient", "ambient light is not shadowed by surfaces or fog"});
}
}

std::string number_text(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void add_single_scattering_limits(const View& view, const Snapshot& snapshot, std::vector<Limit>& limits) {
    for (const Medium& medium : snapshot.media) {
        const float scattered = thickness(medium, snapshot.bounds) * max_component(medium.optics.albedo);
        if (scattered <= 0.5f) continue;
        limits.push_back({Severity::degraded, "medium " + medium.name,
                          "light scatters once only; up to " + number_text("%.2g", scattered) +
                              " optical depths of scattering make real fog this thick brighter and softer"});
    }
    add_ambient_limit(snapshot, limits);
    add_precision_limit(view, snapshot, limits);
}

void add_light_grid_limits(const Snapshot& snapshot, int cells, std::vector<Limit>& limits) {
    Box fog;
    for (const Medium& medium : snapshot.media)
        if (medium.kind == DensityKind::bricks) fog.grow(medium.world_bounds);
    if (fog.empty() || snapshot.lights.empty()) return;
    const float cell = max_component(fog.size()) / static_cast<float>(cells);
    for (const Medium& medium : snapshot.media) {
        const float depth = medium.majorant() * cell;
        if (medium.kind == DensityKind::bricks && depth > deep_cell)
            limits.push_back({Severity::degraded, "medium " + medium.name,
                              "cells of the light grid are up to " + number_text("%.2g", depth) +
                                  " optical depths deep: light in its dense parts is blurred"});
    }
}

std::vector<Ray> probing_rays(const View& view, const Snapshot& snapshot) {
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    fog.low = glm::max(fog.low, snapshot.bounds.low), fog.high = glm::min(fog.high, snapshot.bounds.high);
    std::vector<Ray> rays;
    for (const vec2 at : {vec2(0.5f), vec2(0.1f), vec2(0.9f, 0.1f), vec2(0.1f, 0.9f), vec2(0.9f)}) {
        Ray ray = camera_ray(view.camera, view.size, at * vec2(view.size));
        const Interval inside = clip(fog, ray.origin, ray.direction, {0, infinity});
        if (inside.empty()) continue;
        ray.t_max = inside.high;
        rays.push_back(ray);
    }
    return rays;
}

void add_step_limits(const View& view, const Snapshot& snapshot, int steps, const char* row, bool fixed,
                     std::vector<Limit>& limits) {
    const std::vector<Ray> rays = probing_rays(view, snapshot);
    for (const Medium& medium : snapshot.media) {
        float length = 0;
        for (const Ray& ray : rays)
            length = std::max(length, clip(medium.world_bounds, ray.origin, ray.direction, {0, ray.t_max}).length());
        const float step = length / static_cast<float>(steps), depth = step * medium.majorant();
        const std::string text = "steps of about " + number_text("%.2g", step) + " m are ";
        if (medium.kind == DensityKind::bricks) {
            const vec3 voxels = medium.bricks->voxel_size;
            const float voxel = std::min(voxels.x, std::min(voxels.y, voxels.z));
            if (step > voxel)
                limits.push_back({step > detail_voxels * voxel ? Severity::degraded : Severity::info,
                                  "medium " + medium.name,
                                  text + "longer than the detail of its voxels, " + number_text("%.2g", voxel) +
                                      " m, which is seen blurred or as grain; more " + row + " resolve it"});
        }
        if (fixed && depth > deep_step)
            limits.push_back({depth > dark_depth ? Severity::wrong : Severity::degraded, "medium " + medium.name,
                              text + "up to " + number_text("%.2g", depth) +
                                  " optical depths deep: what dims and brightens within them is lost; more " + row +
                                  " resolve it"});
    }
}

void add_fluence_limits(const View& view, const Snapshot& snapshot, const FluenceSettings& settings,
                        std::vector<Limit>& limits) {
    add_ambient_limit(snapshot, limits);
    add_precision_limit(view, snapshot, limits);
    const auto is_endless = [](const Medium& medium) { return !is_finite(medium.world_bounds.size()); };
    const Box fog = fog_bounds(snapshot, light_reach(snapshot));
    if (snapshot.lights.empty() || fog.empty()) return;
    const float cell = max_component(fog.size()) / static_cast<float>(settings.resolution);
    limits.push_back({Severity::info, "fluence.resolution",
                      "light that has been scattered before comes from cells of " + number_text("%.2g", cell) +
                          " m: its detail is no finer, and within them light may leak around corners of walls"});
    limits.push_back({Severity::info, "fluence.orders",
                      "fog lights no surfaces, and surfaces light fog but not each other; ambient light and what glows "
                      "are not scattered again"});
    if (std::ranges::any_of(snapshot.media, is_endless))
        limits.push_back({Severity::info, "fluence.orders",
                          "of endless fog only what lies in and around the scene scatters light again"});
    if (settings.orders < all_orders)
        limits.push_back({Severity::info, "fluence.orders",
                          "light that scatters more than " + std::to_string(settings.orders) + " times is left out"});
}
}
