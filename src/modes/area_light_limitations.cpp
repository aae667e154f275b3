#include "modes/area_light_limitations.h"

#include "base/random.h"
#include "integrate/lights/fire_lamps.h"
#include "integrate/lights/light_error.h"
#include "integrate/lights/mesh_lamps.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/scene.h"
#include "trace/lights/emissive_bricks.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/emission/blackbody.h"
#include "volume/emission/emission_field.h"

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
        if (can_emit(material)) visit(material);
}

bool has_scattering_fog(const Snapshot& snapshot) { return std::ranges::any_of(snapshot.media, scatters_light); }

}

void add_out_of_gamut(const Snapshot& snapshot, Limitations& limitations) {
    for (const Medium& medium : snapshot.media)
        if (const auto& field = medium.optics.emission.field; field && has_emission(medium) && field->out_of_gamut > 0)
            limitations.push_back({Severity::info,
                                   &limitation::out_of_gamut,
                                   Subject::medium,
                                   medium.name,
                                   {100 * static_cast<double>(field->out_of_gamut), lowest_in_gamut()}});
}

namespace {
// Mean luminance of the environment in fog, nits; 0 if there is no environment or no scattering fog.
double nits_in_fog(const Snapshot& snapshot) {
    if (!snapshot.environment || !has_scattering_fog(snapshot)) return 0;
    return double(luminance(snapshot.environment->mean())) * snapshot.environment->volume_scale;
}
}

void add_mean_environment(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    const double nits = nits_in_fog(snapshot);
    if (!(nits > 0)) return;
    const double off = mean_environment_error(view, snapshot);
    limitations.push_back({severity_of(off),
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

namespace {
// Relative error of the light that leaves a fire's own smoke when lamps inside stand for the fire: RMS over the axes.
double error_behind_smoke(const Snapshot& snapshot, std::span<const Light> lamps) {
    constexpr uint32_t points = 128;
    const auto fire = emissive_bricks(snapshot, Emitting::as_lamps);
    if (!fire) return 0;
    double squares = 0, sum = 0;
    for (const vec3& direction :
         {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)}) {
        // Powers times transmittance, and powers alone.
        glm::dvec2 exact(0), approximate(0);
        const auto add = [&](vec3 position, double power, glm::dvec2& to) {
            to += power * glm::dvec2(std::exp(-optical_depth(snapshot.media, {position, direction, infinity})), 1);
        };
        for (uint32_t i = 0; i < points; ++i) {
            const Sample2 a = sample2(i, 1), b = sample2(i, 2);
            const EmissionSample at = sample_emission(*fire, a.x, {a.y, b.x, b.y});
            if (at.pdf > 0) add(at.position, luminance(at.emission) / at.pdf, exact);
        }
        for (const Light& lamp : lamps) add(lamp.position, luminance(lamp.intensity), approximate);
        const double leaves = exact.x / std::max(exact.y, 1e-300), off = approximate.x / approximate.y - leaves;
        squares += off * off, sum += leaves;
    }
    return sum > 0 ? std::sqrt(6 * squares) / sum : 0;
}
}

namespace {
// Of the light of endless or thick fog, the part that it scatters once: that of the highest albedo.
double scattered_share(const Snapshot& snapshot) {
    double albedo = 0;
    for (const Medium& medium : snapshot.media)
        if (scatters_light(medium)) albedo = std::max(albedo, double{max_component(medium.optics.albedo)});
    return albedo / (1 + albedo);
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
    if (error_behind_smoke(snapshot, lamps) > tolerated)
        reach = std::max(reach, double{snapshot.extent}), severity = Severity::wrong;
    for (const Medium& medium : snapshot.media)
        if (has_emission(medium) && !emits_as_lamps(medium)) {
            const double share = scattered_share(snapshot);
            limitations.push_back(
                {severity_of(share), &limitation::unscattered_emission, Subject::medium, medium.name, {100 * share}});
        } else if (has_emission(medium) && !lamps.empty()) {
            limitations.push_back(
                {severity, &limitation::lamps_for_fire, Subject::medium, medium.name, {reach, double(lamps.size())}});
        }
}

void add_lamps_for_surfaces(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    if (!has_scattering_fog(snapshot)) return;
    const auto found = mesh_lamps(snapshot);
    if (!found || found->lamps.empty()) return;
    const bool wrong = std::ranges::any_of(found->lamps, [&](const Light& lamp) {
        return severity_within(view, snapshot, lamp.position, found->reach) == Severity::wrong;
    });
    for_emitting_materials(snapshot, [&](const Material& material) {
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
    if (surfaces_emit && has_scattering_fog(snapshot))
        for_emitting_materials(snapshot, [&](const Material& material) {
            limitations.push_back(
                {Severity::wrong, &limitation::emission_lights_no_fog, Subject::material, material.name});
        });
    if (const double nits = nits_in_fog(snapshot); nits > 0)
        add(limitation::environment_left_out, Subject::light, snapshot.environment->name, nits);
}
}
