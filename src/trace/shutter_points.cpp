#include "trace/shutter_points.h"

#include "base/error.h"
#include "scene/camera.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_profile.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "trace/lights/light_frame.h"
#include "trace/shutter_motion.h"
#include "volume/vdb/vdb.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
using Points = std::vector<vec3>;
constexpr float widest = 1.5f; // radians: beams beyond this are measured there

bool is_bounded(const Box& box) { return !box.empty() && is_finite(box.low) && is_finite(box.high); }

void add_corners(const mat4& matrix, const Box& box, Points& points) {
    if (!is_bounded(box)) return;
    for (int i = 0; i < 8; ++i) points.push_back(vec3(matrix * glm::vec4(box.corner(i), 1)));
}

// Up to 256 vertices spread over a posed mesh.
void add_vertices(const mat4& matrix, const Mesh& mesh, const Pose& pose, Points& points) {
    constexpr size_t enough = 256;
    const size_t count = mesh.positions.size();
    for (size_t i = 0; i < std::min(count, enough); ++i)
        points.push_back(vec3(matrix * vec4(posed_position(mesh, pose, i * count / std::min(count, enough)), 1)));
}

// The light's position and points along its axis.
void add_axis(const LightSource& light, const NodeFrame& frame, float reach, Points& points) {
    const bool aimed = light.kind != LightKind::point && frame.forward != vec3(0);
    for (const float share : {0.0f, 0.25f, 0.5f, 1.0f})
        points.push_back(aimed ? frame.position + share * reach * frame.forward : frame.position);
}

// What turns with a light: the axes of its image or profile, or of its face. A plain beam looks the same however it is
// turned about its axis: its axes follow the shortest turn from `middle`, the axis in the middle of the exposure.
LightAxes axes_of(const LightSource& light, const NodeFrame& frame, vec3 middle, double seconds) {
    if (light.gobo) return light_axes(frame.forward, frame.up, light.gobo->rotation.at(seconds));
    if (light.profile) return light_axes(frame.forward, frame.up, light.profile_rotation.at(seconds));
    if (has_area(light)) return light_axes(frame.forward, frame.up, 0);
    vec3 right, up;
    make_frame(middle, right, up);
    const auto turned = [&](vec3 axis) {
        return axis - glm::dot(axis, frame.forward) / (1 + glm::dot(middle, frame.forward)) * (middle + frame.forward);
    };
    return {turned(right), turned(up)};
}

// The tangent of the angle from the axis at which a beam, its image or its profile is measured.
float tangent_of(const LightSource& light, double seconds) {
    const float cone = has_cone(light) ? light.outer_cone.at(seconds) : pi;
    const float angle = light.profile ? std::min(cone, std::min(light.profile->reach, pi / 3)) : cone;
    return std::tan(std::min(angle, widest)) * (light.gobo ? light.gobo->scale.at(seconds) : 1);
}

// Points around the axis: of an area light on its rim, of others at the edge of the beam.
void add_rim(const LightSource& light, const NodeFrame& frame, vec3 middle, double seconds, float reach,
             Points& points) {
    constexpr int around = 8;
    const LightAxes axes = axes_of(light, frame, middle, seconds);
    vec2 half(light.radius.at(seconds));
    if (light.kind == LightKind::rectangle) half = 0.5f * vec2(light.width.at(seconds), light.height.at(seconds));
    for (int i = 0; i < around; ++i) {
        const float angle = pi / 4 * static_cast<float>(i);
        vec2 turn(std::cos(angle), std::sin(angle));
        if (light.kind == LightKind::rectangle) turn /= std::max(std::abs(turn.x), std::abs(turn.y));
        if (has_area(light)) {
            points.push_back(frame.position + turn.x * half.x * axes.right + turn.y * half.y * axes.up);
            continue;
        }
        const vec3 across = turn.x * axes.right + turn.y * axes.up;
        const vec3 edge = glm::normalize(frame.forward + tangent_of(light, seconds) * across);
        for (const float share : {0.25f, 0.5f, 1.0f}) points.push_back(frame.position + share * reach * edge);
    }
}

void add_light(const ShutterPoints& all, size_t index, double seconds, Points& points) {
    const LightSource& light = all.scene.lights[index];
    const NodeFrame frame = light_frame(all.scene, light, seconds);
    const float reach = std::min(light.range.at(seconds), all.extent);
    add_axis(light, frame, reach, points);
    const bool has_rim = has_cone(light) || has_area(light) || light.profile;
    if (has_rim && changes(all.scene, light)) add_rim(light, frame, all.forward[index], seconds, reach, points);
}

void add_instance(const ShutterPoints& all, const Instance& instance, double seconds, Points& points) {
    if (instance.mesh < 0) return;
    const auto mesh = static_cast<size_t>(instance.mesh);
    const Pose pose = pose_of(all.scene, instance, seconds);
    const mat4 matrix = instance_matrix(all.scene, instance, seconds);
    if (pose.empty())
        add_corners(matrix, all.meshes[mesh], points);
    else
        add_vertices(matrix, all.scene.meshes[mesh], pose, points);
}

bool changes_height(const MediumSource& medium) {
    return medium.kind == MediumKind::height && !(medium.height_base.constant() && medium.height_falloff.constant());
}

// The velocities of a recipe's noise: of its fog and of its flames. What swirls and evolves goes nowhere.
std::array<vec3, 2> velocities_of(const FogRecipe& recipe) {
    return {recipe.wind, vec3(0, recipe.fire ? recipe.fire->rise : 0, 0)};
}

void add_medium(const ShutterPoints& all, size_t index, double seconds, Points& points) {
    const MediumSource& medium = all.scene.media[index];
    const mat4 matrix = medium_matrix(medium, seconds);
    points.push_back(vec3(matrix[3]));
    add_corners(matrix, all.media[index], points);
    const auto passed = static_cast<float>(seconds - all.middle);
    for (const vec3 place : all.noise[index])
        for (const vec3 velocity : velocities_of(*medium.recipe))
            points.push_back(vec3(matrix * vec4(place + passed * velocity, 1)));
    if (!changes_height(medium)) return;
    const float base = medium.height_base.at(seconds), falloff = medium.height_falloff.at(seconds);
    for (const vec3 place : all.view)
        for (const float height : {base, base + falloff}) points.push_back({place.x, height, place.z});
}

Box bounds_of(const MediumSource& medium, int frame) {
    if (medium.recipe) return medium.recipe->bounds;
    if (medium.kind != MediumKind::vdb) return medium.bounds;
    try {
        const auto file = sequence_file(medium.sequence, frame, MissingFrame::hold);
        return file ? stated_bounds(*file, medium.density_grid, medium.density_map) : Box{};
    } catch (const Error&) {
        return {}; // reported when the file is read
    }
}

float extent_of(const Scene& scene, double seconds) {
    const Box box = scene_bounds(scene, seconds);
    const float size = box.empty() ? 0 : glm::length(box.size());
    return size > 0 && std::isfinite(size) ? size : 10.0f;
}

// Places at several distances behind nine points of the image.
Points places_in_view(const Camera& camera, ivec2 size, float extent) {
    Points places;
    for (int i = 0; i < 9; ++i) {
        const Ray ray = camera_ray(camera, size, vec2(size) * vec2(i % 3, i / 3) / 2.0f);
        for (const float share : {0.125f, 0.25f, 0.5f, 1.0f}) places.push_back(ray.at(share * extent));
    }
    return places;
}

// Places in noise that drifts: the corners of its bounds, and what of it is in view.
Points places_in_noise(const MediumSource& medium, const Points& view, double seconds) {
    Points places;
    if (!medium.recipe || velocities_of(*medium.recipe) == std::array{vec3(0), vec3(0)}) return places;
    add_corners(mat4(1), medium.recipe->bounds, places);
    const mat4 to_medium = glm::inverse(medium_matrix(medium, seconds));
    for (const vec3 place : view) {
        const vec3 own(to_medium * vec4(place, 1));
        if (!clip(medium.recipe->bounds, own, vec3(0), {0, 1}).empty()) places.push_back(own);
    }
    return places;
}
}

ShutterPoints shutter_points(const Scene& scene, const Camera& camera, ivec2 size, int frame, double seconds) {
    ShutterPoints points{scene, extent_of(scene, seconds), {}, {}, {}, {}, {}, {}, seconds};
    for (const LightSource& light : scene.lights) points.forward.push_back(light_frame(scene, light, seconds).forward);
    for (const Mesh& mesh : scene.meshes) points.meshes.push_back(posed_bounds(mesh, {}));
    for (const MediumSource& medium : scene.media) points.media.push_back(bounds_of(medium, frame));
    points.view = places_in_view(camera, size, points.extent);
    for (const MediumSource& medium : scene.media)
        points.noise.push_back(places_in_noise(medium, points.view, seconds));
    points.shadows = shadow_rays(scene, seconds, points.extent);
    return points;
}

std::vector<vec3> points_at(const ShutterPoints& all, double seconds) {
    Points points;
    for (size_t i = 0; i < all.scene.lights.size(); ++i) add_light(all, i, seconds, points);
    for (const Instance& instance : all.scene.instances) add_instance(all, instance, seconds, points);
    for (size_t i = 0; i < all.scene.media.size(); ++i) add_medium(all, i, seconds, points);
    add_shadows(all.scene, all.shadows, seconds, all.extent, points);
    points.insert(points.end(), all.view.begin(), all.view.end()); // only a camera moves them
    return points;
}
}
