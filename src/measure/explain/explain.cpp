// The camera ray from surface to surface, and the deterministic reference on it.
#include "measure/explain/parts.h"
#include "modes/mode.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium.h"

#include "base/error.h"
#include "base/random.h"
#include "integrate/march_steps.h"
#include "render/adaptive/candidates.h"
#include "render/frame/camera_paths.h"
#include "render/frame/channels.h"
#include "scene/lights/area_shape.h"
#include "scene/scene.h"
#include "trace/mattes.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
View centered(View view) {
    view.crop_low = view.crop_high = ivec2(0);
    view.pixel_samples = view.batches = view.lamp_samples = 1;
    view.filter = PixelFilter::center, view.fog_parts = false;
    view.lamps.clear();
    view.camera.lens = {};
    return view;
}

Settings truth_for(const Snapshot& snapshot, const Settings& settings, int light_points) {
    Settings truth = truth_settings(settings);
    truth.fluence.orders = 1;
    if (std::ranges::any_of(snapshot.lights, is_soft))
        truth.terms.light_points = std::max(truth.terms.light_points, light_points);
    return truth;
}

void add_depths(RayScene& scene) {
    const TermSettings& terms = scene.truth.terms;
    for (const Light& light : scene.fog.lights) {
        scene.depths.push_back(make_light_depth(scene.fog, light, terms.light, terms.light_resolution, &scene.view));
        scene.depths.back().scale = scene.truth.style.light_depth;
    }
}

void start_report(const RayScene& scene, ivec2 pixel, RayReport& report) {
    report.pixel = pixel, report.size = scene.view.size;
    for (const Light& light : scene.snapshot.lights) {
        LightOnRay on;
        on.name = light.name, on.kind = light.area ? light.area->kind : light.kind, on.shadows = light.shadows;
        on.points = static_cast<int>(scene.points_of(light));
        const auto& casters = shadow_casters(light, scene.snapshot);
        on.sampled = casters && casters->has_alpha();
        report.lights.push_back(std::move(on));
    }
    for (const Medium& medium : scene.snapshot.media) report.media.push_back({medium.name, 0});
    report.reference.mode = "reference", report.reference.accuracy = Accuracy::single_scattering;
    report.reference.samples = std::ranges::any_of(scene.snapshot.lights, is_soft) ? scene.truth.terms.light_points : 1;
}

// Adds the reference's fog light on one part, light by light, times `through`. Returns the fog's transmittance.
vec3 add_reference(const Prepared& prepared, const RaySegment& segment, vec3 throughput, RayReport& report) {
    const size_t lights = report.lights.size();
    std::vector<vec3> of_lights(part_count(lights), vec3(0));
    RayBatch batch = segment.batch;
    batch.parts = of_lights;
    Scatter scatter;
    prepared.scatter(batch, {&scatter, 1});

    ModeResult& result = report.reference;
    result.inscatter += throughput * scatter.radiance, result.color += throughput * scatter.radiance;
    result.steps += scatter.steps;
    result.transmittance *= scatter.transmittance;
    for (size_t l = 0; l < lights; ++l) report.lights[l].fog += throughput * of_lights[l];
    return scatter.transmittance * scatter.tint;
}

std::string material_of(const RayScene& scene, int instance) {
    const Scene& whole = *scene.snapshot.scene;
    const int material =
        whole.meshes[static_cast<size_t>(whole.instances[static_cast<size_t>(instance)].mesh)].material;
    return material >= 0 ? whole.materials[static_cast<size_t>(material)].name : std::string();
}

// Adds the surface that the ray has reached.
void add_surface(const RayScene& scene, const Prepared& prepared, int layer, const PathPacket& s,
                 const SurfacePoint& point, double distance, RayReport& report) {
    const Path& path = s.path[0];
    const uint32_t points = static_cast<uint32_t>(scene.truth.terms.light_points);
    std::vector<vec2> u(points);
    for (uint32_t p = 0; p < points; ++p) {
        const Sample2 random = sample2(path.sample.index * points + p, hash(path.seed, layer, use_soft_light));
        u[p] = {random.x, random.y};
    }
    SurfaceOnRay surface;
    std::vector<vec3> of_lights;
    shade(scene.snapshot, prepared, {&point, 1}, u, {&surface.radiance, 1}, &of_lights);

    const int instance = s.hits.instance[0];
    surface.distance = distance;
    if (s.face[0] >= 0)
        surface.name = scene.snapshot.lights[static_cast<size_t>(s.face[0])].name;
    else
        surface.name = name_of_instance(*scene.snapshot.scene, instance),
        surface.material = material_of(scene, instance);
    if (is_matte(scene.snapshot, instance)) surface.radiance = vec3(0), of_lights.assign(of_lights.size(), vec3(0));
    surface.alpha = point.alpha, surface.share = mean_component(path.throughput) * point.alpha;
    const vec3 share = path.throughput * point.alpha;
    report.reference.color += share * surface.radiance;
    for (size_t l = 0; l < report.lights.size(); ++l) report.lights[l].surfaces += share * of_lights[l];
    report.surfaces.push_back(std::move(surface));
}

// Follows the ray from surface to surface, as trace_samples() does.
void follow(const RayScene& scene, RayReport& report) {
    const Prepared prepared = prepare_frame(main_mode(), scene.view, scene.snapshot, scene.truth, nullptr);
    PathPacket s;
    PixelSample sample;
    start_paths(scene.view, false, {&report.pixel, 1}, 0, s, {&sample, 1});
    report.origin = s.path[0].ray.origin, report.direction = s.path[0].ray.direction;
    if (scene.snapshot.scene) report.world_origin = scene.snapshot.scene->origin;
    for (int layer = 0; layer < max_layers; ++layer) {
        find_surfaces(scene.snapshot, layer, s);
        Path& path = s.path[0];
        const bool open = !s.hit(0);
        const float length = open ? fog_reach(scene.snapshot.media, path.ray) : s.length[0];
        const Ray ray{path.ray.origin, path.ray.direction, length};
        const RayInputs numbers = ray_inputs(scene.view, layer, s);
        const RayBatch batch{.rays = {&ray, 1},
                             .ids = {numbers.ids, 1},
                             .jitter = {numbers.jitter, 1},
                             .sample_indices = {numbers.sample_indices, 1},
                             .positions = {numbers.positions, 1},
                             .open = {&open, 1}};
        const RaySegment segment{ray, batch, report.end, report.depth, mean_component(path.throughput)};
        const vec3 transmittance = add_reference(prepared, segment, path.throughput, report);
        append_fog(scene, segment, report);
        path.throughput *= transmittance, report.end += length;

        const SurfaceHits hits = surface_hits(scene.snapshot, layer, s);
        if (hits.count == 0) {
            report.background = background_radiance(scene.snapshot.background, path.ray.direction, path.screen);
            report.background_share = mean_component(path.throughput);
            report.reference.color += path.throughput * report.background;
            return;
        }
        add_surface(scene, prepared, layer, s, hits.points[0], report.end, report);
        report.hits = hits.points[0].alpha >= 1;
        if (!advance(scene.view, hits, s, {&sample, 1})) return;
    }
}
}

double difference(const ModeResult& result, const ModeResult& reference) {
    const double is = luminance(result.inscatter), should_be = luminance(reference.inscatter);
    return is == should_be ? 0 : should_be > 0 ? is / should_be - 1 : double(infinity);
}

std::string_view name_of(LightState state) {
    constexpr std::string_view names[] = {"lit", "penumbra", "shadow", "out of reach"};
    return names[static_cast<size_t>(state)];
}

RayReport explain_ray(const View& view, const Snapshot& snapshot, const Settings& settings, ivec2 pixel,
                      const ExplainOptions& options) {
    const Settings truth = truth_for(snapshot, settings, options.light_points);
    RayScene scene{
        centered(view), snapshot, settings, truth, with_terms(stylized(snapshot, truth.style), truth.terms), {},
        options};
    add_depths(scene);
    RayReport report;
    start_report(scene, pixel, report);
    follow(scene, report);
    report.reference.finite = is_finite(report.reference.inscatter) && is_finite(report.reference.color);

    const double parts = static_cast<double>(options.modes.size()) + 1;
    for (size_t i = 0; i < options.modes.size(); ++i) {
        if (options.progress) options.progress(static_cast<double>(i + 1) / parts);
        if (options.cancel && *options.cancel) fail(ExitCode::internal, "explain", "cancelled");
        report.results.push_back(mode_result(*options.modes[i], scene, report));
    }
    return report;
}
}
