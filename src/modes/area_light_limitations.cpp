#include "modes/area_light_limitations.h"

#include "integrate/lights/fire_lamps.h"
#include "integrate/lights/mesh_lamps.h"
#include "integrate/lights/path_lights.h"
#include "integrate/terms.h"
#include "modes/shared_limitations.h"
#include "scene/area_shape.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/emission/blackbody.h"
#include "volume/emission/emission_field.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <optional>

namespace tyndall {
namespace {
// Luminous flux of an emissive medium, lumens: 4π times its luminance per meter, integrated over its volume.
double lumens_of(const Medium& medium) {
    const double per_volume = 4 * double(pi) * luminance(medium.optics.emission.radiance);
    const vec3 size = medium.world_bounds.size();
    const double volume = double(size.x) * size.y * size.z;
    const bool bricks = medium.density.kind == DensityKind::bricks;
    return per_volume * volume * (bricks ? double(medium.density.bricks->mean) : 1.0);
}

bool has_emission(const Medium& medium) {
    return max_component(medium.optics.emission.radiance) > 0 && is_finite(medium.world_bounds.size());
}

template<class Visit> void for_emitting_materials(const Snapshot& snapshot, const Visit& visit) {
    if (!snapshot.scene) return;
    for (const Material& material : snapshot.scene->materials)
        if (max_component(material.emission) > 0) visit(material);
}

// Whether the scene has surfaces or scattering fog for light to fall on.
bool can_be_lit(const Snapshot& snapshot) {
    return (snapshot.occluders && !snapshot.occluders->empty()) || std::ranges::any_of(snapshot.media, scatters_light);
}
}

void add_emission(const Snapshot& snapshot, bool lights_nothing, Limitations& limitations) {
    lights_nothing = lights_nothing && can_be_lit(snapshot);
    for (const Medium& medium : snapshot.media) {
        if (!has_emission(medium)) continue;
        const auto add = [&](const LimitationKind& kind, std::array<double, 2> amounts) {
            limitations.push_back({Severity::info, &kind, Subject::medium, medium.name, amounts});
        };
        const auto& field = medium.optics.emission.field;
        if (field && field->out_of_gamut > 0)
            add(limitation::out_of_gamut, {100 * static_cast<double>(field->out_of_gamut), lowest_in_gamut()});
        if (lights_nothing && !field) add(limitation::unscattered_emission, {lumens_of(medium)});
    }
}

namespace {
// Mean luminance of the environment in fog, nits; 0 if there is no environment or no scattering fog.
double nits_in_fog(const Snapshot& snapshot) {
    if (!snapshot.environment || !std::ranges::any_of(snapshot.media, scatters_light)) return 0;
    return double(luminance(snapshot.environment->mean())) * snapshot.environment->volume_scale;
}

// Environment light scattered by fog, as in a march with 16 light samples per ray.
ScatterFunction scattered_sky(const View& view, const Snapshot& snapshot) {
    TermSettings terms;
    terms.light_points = 16;
    const auto fog = scattering_fog(snapshot, {}, terms, view.camera, 0);
    std::vector<PathLight> lights;
    append_environment_light(snapshot, fog, true, lights);
    return with_path_lights(fog, std::move(lights),
                            [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); });
}

// The same for the environment's mean radiance, unattenuated: opacity of the ray times mean albedo along it.
double scattered_mean(const Snapshot& snapshot, const Ray& ray) {
    constexpr int points = 16;
    double scattered = 0, dimmed = 0;
    for (int i = 0; i < points; ++i)
        for (const Medium& medium : snapshot.media) {
            const vec3 point = ray.at(ray.t_max * (static_cast<float>(i) + 0.5f) / points);
            const double extinction = double(density_at(medium, point)) * gray_extinction(medium.optics);
            scattered += extinction * luminance(albedo_at(medium.optics, point)), dimmed += extinction;
        }
    const double share = dimmed > 0 ? scattered / dimmed * -std::expm1(-optical_depth(snapshot.media, ray)) : 0;
    return share * luminance(snapshot.environment->mean()) * snapshot.environment->volume_scale;
}

// Relative RMS error of the mean (rmse_rel), over 8×6 camera rays up to the first surface.
double off_by_mean(const View& view, const Snapshot& snapshot) {
    constexpr int across = 8, down = 6;
    const ScatterFunction exact = scattered_sky(view, snapshot);
    double squares = 0, sum = 0;
    for (uint32_t i = 0; i < across * down; ++i) {
        const vec2 at((static_cast<float>(i % across) + 0.5f) / across, (static_cast<float>(i / across) + 0.5f) / down);
        Ray ray = camera_ray(view.camera, view.size, at * vec2(view.size));
        ray.t_max = std::min(fog_reach(snapshot.media, ray), view.camera.far);
        Hits hits;
        if (snapshot.occluders)
            snapshot.occluders->closest({&ray, 1}, 0, hits), ray.t_max = std::min(ray.t_max, hits.t[0]);
        if (!(ray.t_max > 0)) continue;
        Scatter found;
        exact({.rays = {&ray, 1}, .ids = {&i, 1}}, {&found, 1});
        const double off = scattered_mean(snapshot, ray) - luminance(found.radiance);
        squares += off * off, sum += luminance(found.radiance);
    }
    return sum > 0 ? std::sqrt(squares * across * down) / sum : 0;
}
}

void add_mean_environment(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    const double nits = nits_in_fog(snapshot);
    if (!(nits > 0)) return;
    const double off = off_by_mean(view, snapshot);
    limitations.push_back({off > wrong_error     ? Severity::wrong
                           : off > visible_error ? Severity::degraded
                                                 : Severity::info,
                           &limitation::mean_environment,
                           Subject::light,
                           snapshot.environment->name,
                           {100 * off, nits}});
}

namespace {
// Fraction of the image's height that a sphere covers; 0 where none of it is in the image.
double share_of_height(const View& view, vec3 center, double radius) {
    const Camera& camera = view.camera;
    const float depth = glm::dot(center - camera.position, camera.forward);
    if (glm::distance(center, camera.position) < radius) return 1;
    const double height = view_height(camera, depth);
    const std::optional<vec2> at = pixel_of(camera, view.size, center);
    if (!at || !(height > 0)) return 0;
    const vec2 beyond = glm::max(glm::max(-*at, *at - vec2(view.size)), vec2(0));
    const double share = 2 * radius / height;
    return glm::length(beyond) < 0.5 * share * view.size.y ? std::min(share, 1.0) : 0;
}

// Whether fog attenuates light strongly within a distance of a point: mean optical depth along six axis-aligned rays.
bool ends_within(const Snapshot& snapshot, vec3 center, double distance) {
    constexpr double deep = 0.3; // optical depths
    double depth = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const float way : {-1.0f, 1.0f}) {
            Ray ray{center, vec3(0), static_cast<float>(distance)};
            ray.direction[axis] = way;
            depth += optical_depth(snapshot.media, ray) / 6;
        }
    return depth > deep;
}

// Severity for a lamp that is inaccurate within `distance`: `wrong` where fog scatters much of its light there, or
// where that sphere covers much of the image's height.
Severity severity_within(const View& view, const Snapshot& snapshot, vec3 lamp, double distance) {
    constexpr double much = 0.2;
    const bool wrong = share_of_height(view, lamp, distance) > much || ends_within(snapshot, lamp, distance);
    return wrong ? Severity::wrong : Severity::degraded;
}
}

void add_lamps_for_faces(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    constexpr double tolerated = 0.1;
    if (!std::ranges::any_of(snapshot.media, scatters_light)) return;
    for (const Light& light : snapshot.lights)
        if (light.area && light.volume_scale > 0) {
            const double within = far_distance(*light.area, tolerated);
            limitations.push_back({severity_within(view, snapshot, light.position, within),
                                   &limitation::lamp_for_face,
                                   Subject::light,
                                   light.name,
                                   {light.radius, within}});
        }
}

void add_lamps_for_fire(const Snapshot& snapshot, Limitations& limitations) {
    constexpr double tolerated = 0.1;
    if (!std::ranges::any_of(snapshot.media, scatters_light)) return;
    const std::vector<Light> lamps = fire_lamps(snapshot);
    double reach = 0;
    Severity severity = Severity::degraded;
    for (const Light& lamp : lamps) {
        const double within = far_distance(lamp, tolerated);
        reach = std::max(reach, within);
        if (ends_within(snapshot, lamp.position, within)) severity = Severity::wrong;
    }
    for (const Medium& medium : snapshot.media)
        if (!lamps.empty() && has_emission(medium) && only_emits(medium.optics))
            limitations.push_back(
                {severity, &limitation::lamps_for_fire, Subject::medium, medium.name, {reach, double(lamps.size())}});
}

void add_dark_emission(const Snapshot& snapshot, Limitations& limitations) {
    for_emitting_materials(snapshot, [&](const Material& material) {
        if (material.alpha_mode != AlphaMode::opaque)
            limitations.push_back(
                {Severity::info, &limitation::emission_lights_nothing, Subject::material, material.name});
    });
}

void add_lamps_for_surfaces(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    if (!std::ranges::any_of(snapshot.media, scatters_light)) return;
    const auto found = mesh_lamps(snapshot);
    if (!found || found->lamps.empty()) return;
    const bool wrong = std::ranges::any_of(found->lamps, [&](const Light& lamp) {
        return severity_within(view, snapshot, lamp.position, found->reach) == Severity::wrong;
    });
    for_emitting_materials(snapshot, [&](const Material& material) {
        if (material.alpha_mode == AlphaMode::opaque)
            limitations.push_back({wrong ? Severity::wrong : Severity::degraded,
                                   &limitation::lamps_for_surfaces,
                                   Subject::material,
                                   material.name,
                                   {found->reach, double(found->lamps.size())}});
    });
}

void add_left_out_light(const Snapshot& snapshot, bool surfaces_emit, Limitations& limitations) {
    for (const Medium& medium : snapshot.media)
        if (has_emission(medium))
            limitations.push_back(
                {Severity::wrong, &limitation::emission_left_out, Subject::medium, medium.name, {lumens_of(medium)}});
    if (surfaces_emit) add_dark_emission(snapshot, limitations);
    if (surfaces_emit && std::ranges::any_of(snapshot.media, scatters_light))
        for_emitting_materials(snapshot, [&](const Material& material) {
            if (material.alpha_mode == AlphaMode::opaque)
                limitations.push_back(
                    {Severity::wrong, &limitation::emission_lights_no_fog, Subject::material, material.name});
        });
    if (const double nits = nits_in_fog(snapshot); nits > 0)
        limitations.push_back(
            {Severity::wrong, &limitation::environment_left_out, Subject::light, snapshot.environment->name, {nits}});
}
}
