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
// Luminous flux of fire in bricks, lumens: 4π times its luminance per meter, integrated over its volume.
double lumens_of(const Medium& medium) {
    const double per_volume = 4 * double(pi) * luminance(medium.optics.emission.radiance);
    const vec3 size = medium.world_bounds.size();
    return per_volume * double(size.x) * size.y * size.z * double(medium.density.bricks->mean);
}

// An upper bound of the luminance of emission that follows the density, nits: where the medium is as dense as it gets
// on all its diagonal, or deep.
double max_nits(const Medium& medium, float extent) {
    const double per_meter = luminance(medium.optics.emission.radiance), deepest = gray_extinction(medium.optics);
    const float diagonal = glm::length(medium.world_bounds.size()),
                length = std::isfinite(diagonal) ? diagonal : extent;
    const bool bricks = medium.density.kind == DensityKind::bricks;
    const double depth = double{length} * (bricks ? medium.density.bricks->highest : 1.0f);
    return per_meter * (deepest > 0 ? -std::expm1(-deepest * depth) / deepest : depth);
}

bool has_emission(const Medium& medium) { return max_component(medium.optics.emission.radiance) > 0; }

template<class Visit> void for_emitting_materials(const Snapshot& snapshot, const Visit& visit) {
    if (!snapshot.scene) return;
    for (const Material& material : snapshot.scene->materials)
        if (max_component(material.emission) > 0) visit(material);
}

bool has_scattering_fog(const Snapshot& snapshot) { return std::ranges::any_of(snapshot.media, scatters_light); }

// Whether the scene has surfaces or scattering fog for light to fall on.
bool can_be_lit(const Snapshot& snapshot) {
    return (snapshot.occluders && !snapshot.occluders->empty()) || has_scattering_fog(snapshot);
}
}

void add_emission(const Snapshot& snapshot, bool lights_nothing, Limitations& limitations) {
    lights_nothing = lights_nothing && can_be_lit(snapshot);
    for (const Medium& medium : snapshot.media) {
        if (!has_emission(medium)) continue;
        const auto add = [&](Severity severity, const LimitationKind& kind, std::array<double, 2> amounts) {
            limitations.push_back({severity, &kind, Subject::medium, medium.name, amounts});
        };
        const auto& field = medium.optics.emission.field;
        if (field && field->out_of_gamut > 0)
            add(Severity::info, limitation::out_of_gamut,
                {100 * static_cast<double>(field->out_of_gamut), lowest_in_gamut()});
        if (lights_nothing && !field)
            add(Severity::degraded, limitation::unscattered_emission, {max_nits(medium, snapshot.extent)});
    }
}

namespace {
// Mean luminance of the environment in fog, nits; 0 if there is no environment or no scattering fog.
double nits_in_fog(const Snapshot& snapshot) {
    if (!snapshot.environment || !has_scattering_fog(snapshot)) return 0;
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
dvec3 scattered_mean(const Snapshot& snapshot, const Ray& ray) {
    constexpr int points = 16;
    dvec3 scattered(0);
    double dimmed = 0;
    for (int i = 0; i < points; ++i)
        for (const Medium& medium : snapshot.media) {
            const vec3 point = ray.at(ray.t_max * (static_cast<float>(i) + 0.5f) / points);
            const double extinction = double(density_at(medium, point)) * gray_extinction(medium.optics);
            scattered += extinction * dvec3(albedo_at(medium.optics, point)), dimmed += extinction;
        }
    if (!(dimmed > 0)) return dvec3(0);
    const double opacity = -std::expm1(-optical_depth(snapshot.media, ray));
    return scattered / dimmed * opacity * dvec3(snapshot.environment->mean()) *
           double{snapshot.environment->volume_scale};
}

// Those of a grid of camera rays, up to the first surface, that meet scattering fog.
std::vector<Ray> rays_in_fog(const View& view, const Snapshot& snapshot, uint32_t across, uint32_t down) {
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < across * down; ++i) {
        const vec2 at = (vec2(i % across, i / across) + 0.5f) / vec2(across, down);
        Ray ray = camera_ray(view.camera, view.size, at * vec2(view.size));
        ray.t_max = std::min(fog_reach(snapshot.media, ray), view.camera.far);
        Hits hits;
        if (snapshot.occluders)
            snapshot.occluders->closest({&ray, 1}, 0, hits), ray.t_max = std::min(ray.t_max, hits.t[0]);
        if (ray.t_max > 0 && optical_depth(snapshot.media, ray) > 0) rays.push_back(ray);
    }
    return rays;
}

// Relative RMS error of the mean (rmse_rel), over 8×6 camera rays, or more of a finer grid where few of them meet fog.
double off_by_mean(const View& view, const Snapshot& snapshot) {
    constexpr size_t enough = 12;
    uint32_t across = 8, down = 6;
    std::vector<Ray> rays = rays_in_fog(view, snapshot, across, down);
    for (; rays.size() < enough && across < 128; rays = rays_in_fog(view, snapshot, across, down))
        across *= 2, down *= 2;
    const ScatterFunction exact = scattered_sky(view, snapshot);
    double squares = 0, sum = 0;
    for (uint32_t i = 0; i < rays.size(); ++i) {
        Scatter found;
        exact({.rays = {&rays[i], 1}, .ids = {&i, 1}}, {&found, 1});
        const dvec3 off = scattered_mean(snapshot, rays[i]) - dvec3(found.radiance);
        squares += glm::dot(off, off), sum += found.radiance.x + found.radiance.y + found.radiance.z;
    }
    return sum > 0 ? std::sqrt(3 * squares * across * down) / sum : 0;
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

namespace {
// Distance within which a face seen through fog is too wide for a narrow phase function to take it for a point.
double glowing_distance(const Snapshot& snapshot, const Light& light) {
    constexpr double wide = 0.6; // of the angle at which the phase function has fallen to half
    double distance = 0;
    for (const Medium& medium : snapshot.media)
        if (scatters_light(medium))
            distance = std::max(distance, max_component(vec3(light.area->half, 0)) /
                                              (wide * 0.77 * (1 - double{narrowest_g(medium.optics.phase)})));
    return distance;
}
}

void add_lamps_for_faces(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    constexpr double tolerated = 0.1;
    if (!has_scattering_fog(snapshot)) return;
    for (const Light& light : snapshot.lights)
        if (light.area && light.volume_scale > 0) {
            double within = far_distance(*light.area, tolerated);
            if (const double glow = glowing_distance(snapshot, light); share_of_height(view, light.position, glow) > 0)
                within = std::max(within, glow);
            limitations.push_back({severity_within(view, snapshot, light.position, within),
                                   &limitation::lamp_for_face,
                                   Subject::light,
                                   light.name,
                                   {light.radius, within}});
        }
}

void add_lamps_for_fire(const Snapshot& snapshot, Limitations& limitations) {
    constexpr double tolerated = 0.1;
    if (!has_scattering_fog(snapshot)) return;
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
    if (!has_scattering_fog(snapshot)) return;
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
    const auto add = [&](const LimitationKind& kind, Subject subject, const std::string& name, double amount) {
        limitations.push_back({Severity::wrong, &kind, subject, name, {amount}});
    };
    for (const Medium& medium : snapshot.media)
        if (has_emission(medium) && only_emits(medium.optics))
            add(limitation::fire_left_out, Subject::medium, medium.name, lumens_of(medium));
        else if (has_emission(medium))
            add(limitation::emission_left_out, Subject::medium, medium.name, max_nits(medium, snapshot.extent));
    if (max_component(snapshot.ambient) > 0 && has_scattering_fog(snapshot))
        add(limitation::ambient_left_out, Subject::scene, {}, luminance(snapshot.ambient));
    if (surfaces_emit) add_dark_emission(snapshot, limitations);
    if (surfaces_emit && has_scattering_fog(snapshot))
        for_emitting_materials(snapshot, [&](const Material& material) {
            if (material.alpha_mode == AlphaMode::opaque)
                limitations.push_back(
                    {Severity::wrong, &limitation::emission_lights_no_fog, Subject::material, material.name});
        });
    if (const double nits = nits_in_fog(snapshot); nits > 0)
        add(limitation::environment_left_out, Subject::light, snapshot.environment->name, nits);
}
}
