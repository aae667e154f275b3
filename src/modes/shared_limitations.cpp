#include "modes/shared_limitations.h"

#include "integrate/march_steps.h"
#include "modes/ambient_limitations.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/fluence/light_paths.h"
#include "trace/fog/motion.h"
#include "trace/lights/emissive_triangles.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/emission/emission_field.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <optional>

namespace tyndall {
namespace {
constexpr float deep_cell = 0.3f;    // optical depth of a cell, across which attenuation is far from linear
constexpr float deep_step = 0.15f;   // optical depth of a step
constexpr float detail_voxels = 2;   // longest step, in voxels, before detail is lost
constexpr float seen_offset = 0.25f; // pixels

// Upper bound on a medium's optical depth within its own and the scene's bounds.
float thickness(const Medium& medium, const Box& scene_bounds) {
    Box box = medium.world_bounds;
    box.low = glm::max(box.low, scene_bounds.low), box.high = glm::min(box.high, scene_bounds.high);
    return box.empty() ? 0 : medium.majorant() * glm::length(box.size());
}

// Compares the float spacing at the camera's distance from the origin with the width of a pixel at the scene's center.
void add_float_precision(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    const Camera& camera = view.camera;
    if (snapshot.bounds.empty()) return;
    const float offset = shadow_offset(camera.position);
    const float depth = std::max(glm::dot(snapshot.bounds.center() - camera.position, camera.forward), camera.near);
    if (offset < seen_offset * view_height(camera, depth) / static_cast<float>(view.size.y)) return;
    limitations.push_back({Severity::degraded, &limitation::float_precision, Subject::scene, "", {offset}});
}

// Reports tabulated phase functions, which the fluence grid approximates by one lobe of the same mean cosine.
void add_table(const Medium& medium, Limitations& limitations) {
    const Phase& phase = medium.optics.phase;
    if (!phase.shape || !phase.shape->lobes.empty()) return;
    const float lobe = phase_value({PhaseKind::henyey_greenstein, mean_cosine(phase)}, 0);
    const float ratio = lobe / std::max(phase_value(phase, 0), 1e-6f);
    if (ratio > 0.9f && ratio < 1.1f) return;
    limitations.push_back({ratio > 0.67f && ratio < 1.5f ? Severity::info : Severity::degraded,
                           &limitation::table_by_mean_cosine,
                           Subject::medium,
                           medium.name,
                           {ratio}});
}
}

bool scatters_light(const Medium& medium) {
    return !only_emits(medium.optics) && max_component(medium.optics.albedo) > 0;
}

std::vector<Medium> thickest_media(const Snapshot& snapshot) {
    std::vector<Medium> media = snapshot.media;
    for (Medium& medium : media) medium.optics.extinction *= std::max(1.0f, max_component(medium.optics.channels));
    return media;
}

void add_single_scattering(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    for (const Medium& medium : thickest_media(snapshot)) {
        const float scattered = thickness(medium, snapshot.bounds) * max_component(medium.optics.albedo);
        if (scattered <= 0.5f) continue;
        limitations.push_back(
            {Severity::degraded, &limitation::single_scattering_only, Subject::medium, medium.name, {scattered}});
    }
    add_unshadowed_ambient(view, snapshot, limitations);
    add_float_precision(view, snapshot, limitations);
}

void add_light_grid_cells(const Snapshot& snapshot, int cells, Limitations& limitations) {
    Box fog;
    for (const Medium& medium : snapshot.media)
        if (medium.density.kind == DensityKind::bricks && !only_emits(medium.optics)) fog.grow(medium.world_bounds);
    const auto emits = [](const Medium& medium) { return only_emits(medium.optics); };
    if (fog.empty() || (snapshot.lights.empty() && std::ranges::none_of(snapshot.media, emits))) return;
    const float cell = max_component(fog.size()) / static_cast<float>(cells);
    for (const Medium& medium : thickest_media(snapshot)) {
        const float depth = medium.majorant() * cell;
        if (medium.density.kind == DensityKind::bricks && depth > deep_cell)
            limitations.push_back(
                {Severity::degraded, &limitation::light_grid_cells, Subject::medium, medium.name, {depth}});
    }
}

std::vector<Ray> probing_rays(const View& view, const Snapshot& snapshot) {
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    fog.low = glm::max(fog.low, snapshot.bounds.low), fog.high = glm::min(fog.high, snapshot.bounds.high);
    std::vector<Ray> in_scene, in_fog;
    for (const vec2 at : {vec2(0.5f), vec2(0.1f), vec2(0.9f, 0.1f), vec2(0.1f, 0.9f), vec2(0.9f)}) {
        const Ray ray = camera_ray(view.camera, view.size, at * vec2(view.size));
        const auto add = [&](Interval<float> stretch, std::vector<Ray>& rays) {
            if (!stretch.empty()) rays.push_back({ray.origin, ray.direction, stretch.high});
        };
        add(clip(fog, ray.origin, ray.direction, {0, infinity}), in_scene);
        add({0, fog_reach(snapshot.media, ray)}, in_fog);
    }
    return in_scene.empty() ? in_fog : in_scene;
}

namespace {
// Longest steps in a medium, of camera rays of which each places `steps` over all fog of the scene, and the longest of
// them that is inside the medium; meters.
struct StepLengths {
    float step = 0, inside = 0;
};
StepLengths step_lengths(const View& view, const Snapshot& snapshot, const Medium& medium, int steps) {
    constexpr int across = 24, down = 14;
    std::vector<vec2> pixels;
    for (int i = 0; i < across * down; ++i)
        pixels.push_back((vec2(i % across, i / across) + 0.5f) / vec2(across, down) * vec2(view.size));
    if (is_finite(medium.world_bounds.size()))
        if (const auto middle = pixel_of(view.camera, view.size, medium.world_bounds.center()))
            pixels.push_back(glm::clamp(*middle, vec2(0), vec2(view.size)));
    StepLengths longest;
    for (const vec2 pixel : pixels) {
        const Ray ray = camera_ray(view.camera, view.size, pixel);
        const Interval<float> fog = scene_part(snapshot, ray, fog_interval(snapshot.media, ray));
        const float inside = clip(medium.world_bounds, ray.origin, ray.direction, fog).length();
        if (!(inside > 0) || !std::isfinite(fog.high)) continue;
        const float step = fog.length() / static_cast<float>(steps);
        longest.step = std::max(longest.step, step), longest.inside = std::max(longest.inside, std::min(step, inside));
    }
    return longest;
}
}

void add_steps(const View& view, const Snapshot& snapshot, int steps, Limitations& limitations) {
    for (const Medium& medium : thickest_media(snapshot)) {
        if (only_emits(medium.optics)) continue; // sampled at its own nodes, not at steps
        const auto [step, inside] = step_lengths(view, snapshot, medium, steps);
        const float depth = inside * medium.majorant();
        if (medium.density.kind == DensityKind::bricks) {
            const vec3 voxels = medium.density.bricks->voxel_size;
            const float voxel = std::min(voxels.x, std::min(voxels.y, voxels.z));
            if (step > voxel)
                limitations.push_back({step > detail_voxels * voxel ? Severity::degraded : Severity::info,
                                       &limitation::long_steps,
                                       Subject::medium,
                                       medium.name,
                                       {step, voxel}});
        }
        if (depth > deep_step)
            limitations.push_back({depth > dark_depth ? Severity::wrong : Severity::degraded,
                                   &limitation::deep_steps,
                                   Subject::medium,
                                   medium.name,
                                   {depth, step}});
    }
}

void add_light_transmittance(const Snapshot& snapshot, LightTransmittance light, Limitations& limitations) {
    if (snapshot.media.empty()) return;
    const auto add = [&](const LimitationKind& kind) {
        for (const Light& one : snapshot.lights)
            limitations.push_back({Severity::degraded, &kind, Subject::light, one.name});
    };
    if (light == LightTransmittance::off) add(limitation::unattenuated_light);
    if (light == LightTransmittance::average) add(limitation::average_light);
}

namespace {
// Whether fire or opaque surfaces light the fog.
bool has_emitters(const Snapshot& snapshot) {
    const auto fire = [](const Medium& medium) { return only_emits(medium.optics); };
    return std::ranges::any_of(snapshot.media, fire) || emissive_triangles(snapshot);
}
}

void add_fluence(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations) {
    add_unshadowed_ambient(view, snapshot, limitations);
    add_float_precision(view, snapshot, limitations);
    const auto is_endless = [](const Medium& medium) { return !is_finite(medium.world_bounds.size()); };
    const Box fog = fog_bounds(snapshot, light_reach(snapshot));
    const bool lamps = settings.terms.emission && has_emitters(snapshot);
    if (!(has_lights(snapshot) || lamps) || fog.empty()) return;
    const float cell = max_component(fog.size()) / static_cast<float>(settings.fluence.resolution);
    const auto add = [&](const LimitationKind& kind, const char* row, double amount = 0,
                         Severity severity = Severity::info) {
        limitations.push_back({severity, &kind, Subject::setting, row, {amount}});
    };
    add(limitation::cached_fluence, "fluence.resolution", cell);
    for (const Medium& medium : snapshot.media) add_table(medium, limitations);
    const bool surfaces = snapshot.occluders && snapshot.occluders->triangle_count() > 0;
    add(limitation::fog_scatters_alone, "fluence.orders", 0, surfaces ? Severity::degraded : Severity::info);
    if (std::ranges::any_of(snapshot.media, is_endless)) add(limitation::unbounded_fluence, "fluence.orders");
    const int orders = settings.fluence.orders;
    if (orders < all_orders) add(limitation::orders_left_out, "fluence.orders", orders);
}

namespace {
// The largest weight, in percent, that the lesser of two blended files has at any time sample.
double lesser_share(const Snapshot& snapshot) {
    double largest = 0;
    for (const Snapshot& moment : *snapshot.moments) {
        const double frames = moment.seconds * snapshot.scene->frame_rate;
        largest = std::max(largest, std::abs(frames - std::round(frames)));
    }
    return 100 * largest;
}

void add_volume_motion(const Snapshot& snapshot, size_t medium, Limitations& limitations) {
    const MediumSource& source = snapshot.scene->media[medium];
    const auto add = [&](Severity severity, const LimitationKind& kind, double amount, double count = 0) {
        limitations.push_back({severity, &kind, Subject::medium, source.name, {amount, count}});
    };
    if (source.velocity) {
        const FogTravel travel = fog_travel(snapshot, medium);
        if (travel.voxels == 0) return;
        const bool in_steps = travel.voxels > travel.places; // the places over ±`voxels` are more than two voxels apart
        add(in_steps ? Severity::degraded : Severity::info, limitation::advected_volumes, travel.voxels, travel.places);
    } else if (moves(source)) {
        add(Severity::degraded, limitation::blended_volumes, lesser_share(snapshot));
    } else if (source.kind == MediumKind::vdb && source.sequence.files.size() > 1) {
        const double open = snapshot.moments->back().seconds - snapshot.moments->front().seconds;
        add(Severity::degraded, limitation::still_volumes, open);
    }
}
}

namespace {
void add_shutter(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    constexpr double separate = 1; // pixels: beyond this, copies of thin lines appear separate
    if (!view.shutter || !snapshot.moments || !snapshot.scene) return;
    const double moments = static_cast<double>(view.shutter->cameras.size()), between = view.shutter->motion / moments;
    limitations.push_back({between > separate ? Severity::degraded : Severity::info,
                           &limitation::shutter_moments,
                           Subject::camera,
                           view.camera.name,
                           {between, moments}});
    for (size_t i = 0; i < snapshot.scene->media.size(); ++i) add_volume_motion(snapshot, i, limitations);
}

// How many times brighter a phase function is in its forward direction than on average over a disc around it.
double peak_ratio(const Phase& phase, float radius) {
    constexpr int rings = 256; // of equal area
    double sum = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const double angle = double{radius} * std::sqrt((ring + 0.5) / rings);
        sum += double{phase_value(phase, static_cast<float>(std::cos(angle)))} / rings;
    }
    return double{phase_value(phase, 1)} / std::max(sum, 1e-30);
}

// Reports suns so large that a narrow lobe would show their discs, as directions are those of their centers.
void add_sun_discs(const Snapshot& snapshot, Limitations& limitations) {
    for (const Light& light : snapshot.lights) {
        if (light.kind != LightKind::sun || !(light.angle > 0)) continue;
        double most = 1;
        for (const Medium& medium : snapshot.media)
            if (scatters_light(medium)) most = std::max(most, peak_ratio(medium.optics.phase, light.angle));
        constexpr float real_sun = 0.3f; // degrees
        const double degrees = double{glm::degrees(light.angle)};
        if (most - 1 > visible_error)
            limitations.push_back({degrees > real_sun ? Severity::degraded : Severity::info,
                                   &limitation::sun_disc,
                                   Subject::light,
                                   light.name,
                                   {100 * (most - 1), degrees}});
    }
}
}

void add_to_every_mode(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    add_shutter(view, snapshot, limitations);
    add_sun_discs(snapshot, limitations);
}

namespace {
void add_mean_color(const LimitationKind& kind, const Medium& medium, float spread, Limitations& limitations) {
    constexpr float visible = 0.02f; // fraction
    limitations.push_back({spread > visible ? Severity::degraded : Severity::info,
                           &kind,
                           Subject::medium,
                           medium.name,
                           {100 * static_cast<double>(spread)}});
}
}

void add_mean_albedo(const Snapshot& snapshot, Limitations& limitations) {
    for (const Medium& medium : snapshot.media)
        if (const auto& field = medium.optics.albedo_field)
            add_mean_color(limitation::mean_albedo, medium, field->spread, limitations);
}

void add_mean_emission(const Snapshot& snapshot, Limitations& limitations) {
    for (const Medium& medium : snapshot.media)
        if (const auto& field = medium.optics.emission.field)
            add_mean_color(limitation::mean_emission_color, medium, field->spread, limitations);
}
}
