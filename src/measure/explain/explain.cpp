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
#include "scene/area_shape.h"
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
    Settings truth = truth_of(settings);
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

void start_story(const RayScene& scene, ivec2 pixel, RayStory& story) {
    story.pixel = pixel, story.size = scene.view.size;
    for (const Light& light : scene.snapshot.lights) {
        LightOnRay on;
        on.name = light.name, on.kind = light.area ? light.area->kind : light.kind, on.shadows = light.shadows;
        on.points = static_cast<int>(scene.points_of(light));
        const auto& casters = shadow_casters(light, scene.snapshot);
        on.sampled = casters && casters->has_alpha();
        story.lights.push_back(std::move(on));
    }
    for (const Medium& medium : scene.snapshot.media) story.media.push_back({medium.name, 0});
    story.reference.mode = "reference", story.reference.accuracy = Accuracy::single_scattering;
    story.reference.samples = std::ranges::any_of(scene.snapshot.lights, is_soft) ? scene.truth.terms.light_points : 1;
}

// Adds the reference's fog light on one part, light by light, times `through`. Returns the fog's transmittance.
vec3 add_reference(const Prepared& prepared, const RayPart& part, vec3 through, RayStory& story) {
    const size_t lights = story.lights.size();
    std::vector<vec3> of_lights(part_count(lights), vec3(0));
    RayBatch batch = part.batch;
    batch.parts = of_lights;
    Scatter scatter;
    prepared.scatter(batch, {&scatter, 1});

    Answer& answer = story.reference;
    answer.inscatter += through * scatter.radiance, answer.color += through * scatter.radiance;
    answer.steps += scatter.steps;
    answer.transmittance *= scatter.transmittance;
    for (size_t l = 0; l < lights; ++l) story.lights[l].fog += through * of_lights[l];
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
                 const SurfacePoint& point, double distance, RayStory& story) {
    const Path& path = s.path[0];
    const uint32_t points = static_cast<uint32_t>(scene.truth.terms.light_points);
    std::vector<vec2> u(points);
    for (uint32_t p = 0; p < points; ++p) {
        const Sample2 random = sample2(path.place.index * points + p, hash(path.seed, layer, use_soft_light));
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
        surface.name = name_of_instance(scene.snapshot, instance), surface.material = material_of(scene, instance);
    if (is_matte(scene.snapshot, instance)) surface.radiance = vec3(0), of_lights.assign(of_lights.size(), vec3(0));
    surface.alpha = point.alpha, surface.share = mean_component(path.through) * point.alpha;
    const vec3 share = path.through * point.alpha;
    story.reference.color += share * surface.radiance;
    for (size_t l = 0; l < story.lights.size(); ++l) story.lights[l].surfaces += share * of_lights[l];
    story.surfaces.push_back(std::move(surface));
}

// Follows the ray from surface to surface, as trace_samples() does.
void follow(const RayScene& scene, RayStory& story) {
    const Prepared prepared = prepare_frame(main_mode(), scene.view, scene.snapshot, scene.truth, nullptr);
    PathPacket s;
    PixelSample sample;
    start_paths(scene.view, false, {&story.pixel, 1}, 0, s, {&sample, 1});
    story.origin = s.path[0].ray.origin, story.direction = s.path[0].ray.direction;
    if (scene.snapshot.scene) story.world_origin = scene.snapshot.scene->origin;
    for (int layer = 0; layer < max_layers; ++layer) {
        find_surfaces(scene.snapshot, layer, s);
        Path& path = s.path[0];
        const bool open = !s.hit(0);
        const float length = open ? fog_reach(scene.snapshot.media, path.ray) : s.length[0];
        const Ray ray{path.ray.origin, path.ray.direction, length};
        const RayNumbers numbers = ray_numbers(scene.view, layer, s);
        const RayBatch batch{.rays = {&ray, 1},
                             .ids = {numbers.ids, 1},
                             .jitter = {numbers.jitter, 1},
                             .places = {numbers.places, 1},
                             .positions = {numbers.positions, 1},
                             .open = {&open, 1}};
        const RayPart part{ray, batch, story.end, story.depth, mean_component(path.through)};
        const vec3 transmittance = add_reference(prepared, part, path.through, story);
        append_fog(scene, part, story);
        path.through *= transmittance, story.end += length;

        const SurfacesMet met = surfaces_met(scene.snapshot, layer, s);
        if (met.count == 0) {
            story.background = background_radiance(scene.snapshot.background, path.ray.direction, path.screen);
            story.background_share = mean_component(path.through);
            story.reference.color += path.through * story.background;
            return;
        }
        add_surface(scene, prepared, layer, s, met.points[0], story.end, story);
        story.hits = met.points[0].alpha >= 1;
        if (!advance(scene.view, met, s, {&sample, 1})) return;
    }
}
}

double difference(const Answer& answer, const Answer& reference) {
    const double is = luminance(answer.inscatter), should_be = luminance(reference.inscatter);
    return is == should_be ? 0 : should_be > 0 ? is / should_be - 1 : double(infinity);
}

std::string_view name_of(Lighting state) {
    constexpr std::string_view names[] = {"lit", "penumbra", "shadow", "out of reach"};
    return names[static_cast<size_t>(state)];
}

std::string name_of_instance(const Snapshot& snapshot, int instance) {
    const Scene& scene = *snapshot.scene;
    const Instance& placed = scene.instances[static_cast<size_t>(instance)];
    if (placed.node >= 0 && !scene.nodes[static_cast<size_t>(placed.node)].name.empty())
        return scene.nodes[static_cast<size_t>(placed.node)].name;
    const std::string& name = scene.meshes[static_cast<size_t>(placed.mesh)].name;
    return name.empty() ? "mesh " + std::to_string(placed.mesh) : name;
}

RayStory explain_ray(const View& view, const Snapshot& snapshot, const Settings& settings, ivec2 pixel,
                     const ExplainOptions& options) {
    const Settings truth = truth_for(snapshot, settings, options.light_points);
    RayScene scene{
        centered(view), snapshot, settings, truth, with_terms(stylised(snapshot, truth.style), truth.terms), {},
        options};
    add_depths(scene);
    RayStory story;
    start_story(scene, pixel, story);
    follow(scene, story);
    story.reference.finite = is_finite(story.reference.inscatter) && is_finite(story.reference.color);

    const double parts = static_cast<double>(options.modes.size()) + 1;
    for (size_t i = 0; i < options.modes.size(); ++i) {
        if (options.progress) options.progress(static_cast<double>(i + 1) / parts);
        if (options.cancel && *options.cancel) fail(ExitCode::internal, "explain", "cancelled");
        story.answers.push_back(answer_of(*options.modes[i], scene, story));
    }
    return story;
}
}
