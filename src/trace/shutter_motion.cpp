#include "trace/shutter_motion.h"

#include "scene/camera.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "trace/fog/media.h"
#include "trace/fog/motion.h"
#include "trace/moment.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/shutter_points.h"

#include <algorithm>
#include <bit>
#include <ranges>

namespace tyndall {
namespace {
constexpr int looks = 5;          // moments at which positions are compared
constexpr float spacing = 0.75f;  // pixels between adjacent moments: thin lines ripple by 6.4 %
constexpr int fewest_moments = 4; // if anything changes

// Measured memory that each moment adds: per moving triangle; per light, its grid in voxel fog and its shadow volumes;
// in modes that keep images also per pixel, and per pixel of each light's beam.
constexpr double max_bytes = 8.0 * (1 << 30), bytes_per_triangle = 200, bytes_of_grid = 8 << 20;
constexpr double bytes_per_pixel = 16, bytes_per_beam_pixel = 17;

// Whether a straight way crosses the picture or a quarter of its size around it.
bool crosses_picture(vec2 from, vec2 to, ivec2 size) {
    const vec2 whole(size);
    const Box box{vec3(-0.25f * whole, -1), vec3(1.25f * whole, 1)};
    return !clip(box, vec3(from, 0), vec3(to - from, 0), {0, 1}).empty();
}

bool changes(const Scene& scene, const CameraSource& camera) {
    return !camera.position.constant() || !camera.target.constant() || !camera.up.constant() ||
           !camera.vertical_fov.constant() || !camera.ortho_height.constant() || !camera.aperture.constant() ||
           (camera.focus && !camera.focus->constant()) || !camera.blade_rotation.constant() ||
           is_moving(scene, camera.node);
}
}

bool changes(const Scene& scene, const LightSource& light) {
    const auto all = [](const auto&... values) { return (values.constant() && ...); };
    if (light.gobo && !all(light.gobo->rotation, light.gobo->scale)) return true;
    return is_moving(scene, light.node) ||
           !all(light.position, light.direction, light.up, light.profile_rotation, light.inner_cone, light.outer_cone,
                light.radius, light.angle, light.width, light.height, light.range);
}

namespace {
bool changes(const PhaseSource& phase) {
    const auto all = [](const auto&... values) { return (values.constant() && ...); };
    return !all(phase.g, phase.alpha, phase.droplet_diameter, phase.weight) ||
           std::ranges::any_of(phase.lobes, [](const PhaseSource& lobe) { return changes(lobe); });
}
}

bool changes(const MediumSource& medium) {
    const auto all = [](const auto&... values) { return (values.constant() && ...); };
    if ((medium.recipe && recipe_speed(*medium.recipe) > 0) || moves(medium)) return true;
    if (medium.blackbody && !all(medium.blackbody->scale, medium.blackbody->tint)) return true;
    return !all(medium.extinction, medium.g, medium.albedo, medium.emission, medium.translation, medium.scale,
                medium.rotate, medium.rotation, medium.height_base, medium.height_falloff) ||
           changes(medium.phase);
}

namespace {
// The maps around the scene that turn.
std::vector<const Keyed<float>*> turning_maps(const Scene& scene) {
    std::vector<const Keyed<float>*> result;
    if (!scene.background.rotation.constant()) result.push_back(&scene.background.rotation);
    if (scene.environment && !scene.environment->map.rotation.constant())
        result.push_back(&scene.environment->map.rotation);
    return result;
}

double seconds_of(const Scene& scene, int frame, const Shutter& shutter, float share) {
    return (frame + shutter.open + share * (shutter.close - shutter.open)) / scene.frame_rate;
}
}

float image_motion(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter) {
    const double middle = seconds_of(scene, frame, shutter, 0.5f);
    const ShutterPoints points = shutter_points(scene, camera_at(scene, camera, middle), size, frame, middle);
    std::vector<float> traveled;
    std::vector<std::optional<vec2>> before;
    for (int look = 0; look < looks; ++look) {
        const double seconds = seconds_of(scene, frame, shutter, static_cast<float>(look) / (looks - 1));
        const Camera now = camera_at(scene, camera, seconds);
        const std::vector<vec3> places = points_at(points, seconds);
        traveled.resize(places.size(), 0), before.resize(places.size());
        for (size_t i = 0; i < places.size(); ++i) {
            const std::optional<vec2> at = is_finite(places[i]) ? pixel_of(now, size, places[i]) : std::nullopt;
            if (at && before[i] && crosses_picture(*before[i], *at, size))
                traveled[i] += glm::distance(*at, *before[i]);
            before[i] = at;
        }
    }
    // A camera that turns moves even the background, which has no position.
    const Camera first = camera_at(scene, camera, seconds_of(scene, frame, shutter, 0));
    const Camera last = camera_at(scene, camera, seconds_of(scene, frame, shutter, 1));
    const std::optional<vec2> turned = pixel_of(last, size, last.position + points.extent * first.forward);
    float most = turned ? glm::distance(*turned, 0.5f * vec2(size)) : glm::length(vec2(size));
    for (const float way : traveled)
        if (std::isfinite(way)) most = std::max(most, way);
    const float pixels_per_radian = static_cast<float>(size.y) / first.vertical_fov;
    for (const Keyed<float>* rotation : turning_maps(scene)) {
        const auto at = [&](int look) {
            return rotation->at(seconds_of(scene, frame, shutter, static_cast<float>(look) / (looks - 1)));
        };
        float turn = 0;
        for (int look = 1; look < looks; ++look) turn += std::abs(at(look) - at(look - 1));
        most = std::max(most, turn * pixels_per_radian);
    }
    return most;
}

bool moves_while_open(const Scene& scene, int camera, const Shutter& shutter) {
    if (!shutter) return false;
    return changes(scene, scene.cameras[static_cast<size_t>(camera)]) || !turning_maps(scene).empty() ||
           std::ranges::any_of(scene.lights, [&](const LightSource& light) { return changes(scene, light); }) ||
           std::ranges::any_of(scene.media, [](const MediumSource& medium) { return changes(medium); }) ||
           std::ranges::any_of(scene.instances, [&](const Instance& one) { return is_moving(scene, one); });
}

namespace {
template<class Counts> double count_triangles(const Scene& scene, const Counts& counts) {
    size_t triangles = 0;
    for (const Instance& instance : scene.instances)
        if (instance.mesh >= 0 && counts(instance))
            triangles += scene.meshes[static_cast<size_t>(instance.mesh)].triangles.size();
    return static_cast<double>(triangles);
}

// How many copies of a light's shadow volumes are in memory at most: the volumes themselves, and views of them.
int copies_of_volumes(const LightSource& light, double seconds, bool keeps_images) {
    if (!keeps_images) return 1;
    return light.radius.at(seconds) > 0 ? 5 : 2;
}

// `everything`: all cached data of lights is rebuilt at each moment.
double bytes_of_moment(const Scene& scene, double seconds, double pixels, bool everything, bool keeps_images) {
    const bool voxels = std::ranges::any_of(scene.media, [](const MediumSource& medium) {
        return medium.kind == MediumKind::noise || medium.kind == MediumKind::vdb;
    });
    const double all = count_triangles(scene, [](const Instance&) { return true; });
    const double moving = count_triangles(scene, [&](const Instance& one) { return is_moving(scene, one); });
    double bytes = (keeps_images ? bytes_per_pixel * pixels : 0) + bytes_per_triangle * moving, volumes = 0;
    for (const LightSource& light : scene.lights) {
        const bool anew = everything || changes(scene, light);
        if (anew && voxels) bytes += bytes_of_grid;
        if (!anew && moving == 0) continue;
        const float cone = has_cone(light) ? light.outer_cone.at(seconds) : pi;
        const double share = cone < pi / 4 ? std::tan(cone) : 1; // a narrow beam covers fewer surfaces and pixels
        volumes += share * copies_of_volumes(light, seconds, keeps_images) * bytes_per_shadow_triangle * all;
        if (keeps_images) bytes += share * bytes_per_beam_pixel * pixels;
    }
    return bytes + (volumes <= max_bytes_of_shadows ? volumes : 0); // above the limit, shadows are found in other ways
}
}

int affordable_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter,
                       bool keeps_images) {
    const bool everything = changes(scene, scene.cameras[static_cast<size_t>(camera)]) ||
                            std::ranges::any_of(scene.media, [](const auto& medium) { return changes(medium); });
    const double bytes = bytes_of_moment(scene, seconds_of(scene, frame, shutter, 0.5f),
                                         static_cast<double>(size.x) * size.y, everything, keeps_images);
    const double most = std::clamp(max_bytes / std::max(bytes, 1.0), double(fewest_moments), double(max_auto_moments));
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(most)));
}

int auto_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter, bool keeps_images,
                 int finer) {
    if (!moves_while_open(scene, camera, shutter)) return 1;
    float wanted = image_motion(scene, camera, size, frame, shutter) / spacing;
    if (std::ranges::any_of(scene.media, [](const MediumSource& medium) { return medium.velocity.has_value(); }))
        wanted = std::max(wanted, float(moments_of_velocities));
    const auto count = std::bit_ceil(static_cast<unsigned>(std::min(wanted, float(max_auto_moments)) + 0.999f));
    return std::min(finer * std::max(static_cast<int>(count), fewest_moments),
                    affordable_moments(scene, camera, size, frame, shutter, keeps_images));
}
}
