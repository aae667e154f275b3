// Evaluates a scene at one moment: animation, triangles, fog.
#include "trace/snapshot.h"
#include "base/error.h"
#include "base/text.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/light_power.h"
#include "scene/scene.h"
#include "trace/fog/grids.h"
#include "trace/fog/media.h"
#include "trace/fog/motion.h"
#include "trace/frame_cache.h"
#include "trace/lights/environment.h"
#include "trace/lights/light_filters.h"
#include "trace/lights/light_links.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr float core_share = 1e-5f; // fraction of the scene's extent: core radius of its local lights

// Gives a light its brightness: the mean over the moment's share of the exposure.
void set_brightness(const LightSource& source, const Moment& moment, Light& light) {
    const auto intensity = [&](double seconds) { return intensity_of(source, seconds); };
    const auto brightness = [&](double seconds) { return luminance(intensity(seconds)); };
    light.intensity = mean_brightness(moment, intensity);
    light.volume_scale = mean_factor(moment, source.volume_scale, brightness);
    light.surface_scale = mean_factor(moment, source.surface_scale, brightness);
}

Light light_at(const Scene& scene, const LightSource& source, const Moment& moment, vec3& up) {
    const double seconds = moment.seconds;
    Light light;
    up = source.up.at(seconds);
    light.name = source.name;
    light.kind = source.kind;
    if (is_hidden(scene, source, seconds)) {
        light.intensity = vec3(0);
        return light;
    }
    if (source.node >= 0) {
        const NodeFrame frame = node_frame(scene, source.node, seconds, named("light", source.name));
        light.position = frame.position, light.direction = frame.forward, up = frame.up;
    } else {
        light.position = source.position.at(seconds);
        const vec3 direction = source.direction.at(seconds);
        const float length = glm::length(direction);
        if (is_aimed(source) && !(length > 0))
            refuse(scene.file.string(), named("light", source.name) + ": its direction is zero");
        if (length > 0) light.direction = direction / length;
    }
    set_brightness(source, moment, light);
    light.outer_cone = source.outer_cone.at(seconds);
    light.inner_cone = std::min(source.inner_cone.at(seconds), light.outer_cone);
    light.range = source.range.at(moment.seconds);
    light.radius = source.radius.at(seconds), light.angle = source.angle.at(seconds);
    light.shadows = source.shadows;
    return light;
}

// Gives an area light its shape, and makes the rest of it a local light that approximates the shape.
void add_face(const LightSource& source, double seconds, vec3 up, Light& light) {
    AreaShape shape;
    shape.kind = source.kind, shape.center = light.position, shape.normal = light.direction;
    const LightAxes axes = light_axes(shape.normal, up, 0);
    shape.right = axes.right, shape.up = axes.up;
    shape.half = vec2(source.radius.at(seconds));
    if (source.kind == LightKind::rectangle)
        shape.half = 0.5f * vec2(source.width.at(seconds), source.height.at(seconds));
    shape.half = glm::max(shape.half, vec2(0));
    shape.two_sided = source.two_sided, shape.visible = source.visible;
    if (light.filter) shape.texture = light.filter->gobo;
    make_punctual(shape, light);
}

bool shines(const Light& light) {
    return is_finite(light.intensity) && max_component(light.intensity) > 0 &&
           std::max(light.volume_scale, light.surface_scale) > 0;
}
}

void set_extent(const Scene& scene, Snapshot& snapshot) {
    const double seconds = moment_of(scene, scene.first_frame).seconds;
    const auto grow = [&](Box& box, int node, const Keyed<vec3>& position) {
        box.grow(node >= 0 ? vec3(node_matrix(scene, node, seconds)[3]) : position.at(seconds));
    };
    const CameraSource* camera = scene.cameras.empty() ? nullptr : &scene.cameras[static_cast<size_t>(scene.camera)];
    Box box = scene_bounds(scene, seconds);
    if (camera) grow(box, camera->node, camera->position);
    // Lamps may stand for suns, and a camera's target for a direction.
    const auto is_point = [&] { return box.empty() || box.low == box.high; };
    if (is_point())
        for (const LightSource& light : scene.lights)
            if (light.kind != LightKind::sun) grow(box, light.node, light.position);
    if (is_point() && camera && camera->node < 0) box.grow(camera->target.at(seconds));
    if (!box.empty() && is_finite(box.low) && is_finite(box.high)) snapshot.anchor = box.center();
    const float size = box.empty() ? 0 : glm::length(box.size());
    if (size > 0 && std::isfinite(size)) return void(snapshot.extent = size);
    float extinction = 0;
    for (const MediumSource& medium : scene.media) extinction = std::max(extinction, medium.extinction.at(seconds));
    if (extinction > 0) snapshot.extent = 1 / extinction;
}

namespace {
// Whether a box is finite in every direction; fog without bounds does not tell where the scene is.
bool bounded(const Box& box) { return !box.empty() && is_finite(box.low) && is_finite(box.high); }

Box scene_bounds(const Snapshot& snapshot) {
    Box box = snapshot.occluders->bounds();
    for (const Light& light : snapshot.lights) box.grow(light_bounds(light));
    for (const Medium& medium : snapshot.media)
        if (bounded(medium.world_bounds)) box.grow(medium.world_bounds);
    return box;
}
}

Snapshot::Snapshot() = default;
Snapshot::Snapshot(const Snapshot&) = default;
Snapshot::Snapshot(Snapshot&&) noexcept = default;
Snapshot& Snapshot::operator=(const Snapshot&) = default;
Snapshot& Snapshot::operator=(Snapshot&&) noexcept = default;
Snapshot::~Snapshot() = default;

bool is_chromatic(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.media, [](const Medium& medium) { return !is_gray(medium); });
}

Snapshot channel_of(const Snapshot& snapshot, int channel) {
    Snapshot result = snapshot;
    for (Medium& medium : result.media) {
        Optics& optics = medium.optics;
        const float share = optics.channels[static_cast<glm::length_t>(channel)];
        optics.extinction = glm::max(share * optics.extinction, min_extinction), optics.channels = vec3(1);
    }
    return result;
}

Snapshot make_snapshot(const Scene& scene, Moment moment, const Snapshot* previous, MissingFrame missing,
                       std::shared_ptr<CacheFolder> files) {
    Snapshot snapshot;
    snapshot.files = std::move(files);
    snapshot.scene = &scene;
    snapshot.seconds = moment.seconds, snapshot.frame = moment.frame;
    if (previous && previous->scene != &scene) previous = nullptr;
    if (previous)
        snapshot.anchor = previous->anchor, snapshot.extent = previous->extent;
    else
        set_extent(scene, snapshot);
    LightLinks links = light_links(scene, moment.seconds, previous);
    snapshot.casters = std::move(links.casters), snapshot.lit = std::move(links.lit);
    snapshot.emission_links = std::move(links.of_instances);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        vec3 up(0, 1, 0);
        Light light = light_at(scene, scene.lights[i], moment, up);
        add_filter(scene.lights[i], moment, up, missing, previous, snapshot.notes, light);
        if (const auto& gobo = scene.lights[i].gobo; gobo && !gobo->still)
            note_gap(gobo->sequence, moment.frame, MissingFrame::hold, snapshot.notes); // also with skip: gobo_file()
        if (has_area(scene.lights[i])) add_face(scene.lights[i], moment.seconds, up, light);
        if (!links.of_lights.empty()) light.casters = links.of_lights[i].x, light.lit = links.of_lights[i].y;
        light.core = core_share * snapshot.extent;
        if (shines(light)) snapshot.lights.push_back(std::move(light));
    }
    std::ranges::stable_partition(snapshot.lights, [](const Light& light) { return !light.area; });
    snapshot.ambient = mean_brightness(moment, [&](double seconds) { return scene.ambient.at(seconds); });
    snapshot.background = background_at(scene.background, moment);
    snapshot.environment =
        environment_at(scene, moment, links.of_environment, previous ? previous->environment.get() : nullptr);
    add_media(scene, moment, previous, missing, snapshot);

    const double start = steady_seconds();
    snapshot.occluders = Occluders::make(scene, moment.seconds, previous ? previous->occluders.get() : nullptr);
    if (previous && snapshot.occluders->shares_with(*previous->occluders)) snapshot.occluders = previous->occluders;
    record_cost(snapshot.files.get(), "surfaces", steady_seconds() - start);
    snapshot.cache = std::make_shared<FrameCache>();
    if (previous) snapshot.previous_cache = previous->cache;
    const uint64_t dropped = snapshot.occluders->dropped();
    if (dropped > 0 && !(previous && previous->occluders->dropped() == dropped))
        snapshot.notes.push_back(std::to_string(dropped) + " triangles skipped: zero area or coordinates out of range");
    snapshot.bounds = scene_bounds(snapshot);
    return snapshot;
}

namespace {
// How often fog must be rebuilt: once, and whenever it has moved by half a voxel; 16 times per frame where files are
// blended, so that no steps show.
double recipes_wanted(const Scene& scene, double seconds) {
    double most = 1;
    for (const MediumSource& medium : scene.media) {
        if (medium.kind == MediumKind::noise) {
            const double voxel = medium.voxel_size > 0 ? double{medium.voxel_size} : medium.recipe->voxel_size;
            most = std::max(most, std::ceil(2 * double{recipe_speed(*medium.recipe)} * seconds / voxel));
        }
        if (medium.blends && moves(medium)) most = std::max(most, std::ceil(16 * seconds * scene.frame_rate));
    }
    return most;
}

double files_wanted(const Scene& scene, const Snapshot& snapshot, double seconds) {
    double most = 1;
    for (size_t i = 0; i < scene.media.size(); ++i)
        most =
            std::max(most, std::ceil(2 * voxels_per_second(scene, scene.media[i], snapshot.fog_sources[i]) * seconds));
    return most;
}

double bytes_of(const FogSource& fog) {
    std::vector<const BrickPool*> pools{fog.bricks.get()};
    if (const MediumGrids* grids = fog.grids.get()) {
        for (const GridProperty* property : {&grids->albedo, &grids->emission, &grids->temperature, &grids->flame})
            for (const PlacedBricks& channel : property->channels) pools.push_back(channel.bricks.get());
        for (const EmissionPart* part : {&grids->blackbody, &grids->colored})
            pools.push_back(part->luminance.bricks.get());
    }
    std::ranges::sort(pools);
    pools.erase(std::ranges::unique(pools).begin(), pools.end());
    double bytes = 0;
    for (const BrickPool* pool : pools)
        if (pool) bytes += static_cast<double>(pool->bytes());
    return bytes;
}

double growths_affordable(const Scene& scene, const Snapshot& snapshot) {
    constexpr double max_bytes = 1 << 30;
    double bytes = 1;
    for (size_t i = 0; i < scene.media.size(); ++i)
        if (scene.media[i].kind == MediumKind::noise || moves(scene.media[i]))
            bytes += bytes_of(snapshot.fog_sources[i]);
    return std::max(max_bytes / bytes, 1.0);
}

// Divides the moments into about `growths` runs of consecutive ones, each with the fog of its middle.
std::vector<Moment> with_growths(std::vector<Moment> moments, double growths) {
    const size_t count = moments.size();
    const size_t run = static_cast<size_t>(std::ceil(static_cast<double>(count) / std::min(growths, 1.0 * count)));
    for (size_t first = 0; first < count; first += run) {
        const size_t last = std::min(first + run, count) - 1;
        const double middle = 0.5 * (moments[first].seconds + moments[last].seconds);
        for (size_t i = first; i <= last; ++i) moments[i].grown = middle;
    }
    return moments;
}
}

Snapshot make_snapshot(const Scene& scene, const FrameMoments& frame, const Snapshot* previous, MissingFrame missing,
                       std::shared_ptr<CacheFolder> files) {
    if (frame.moments.empty()) return make_snapshot(scene, frame.middle, previous, missing, std::move(files));
    if (previous && previous->moments) previous = &previous->moments->back();
    const double seconds = frame.moments.back().seconds - frame.moments.front().seconds;
    const double wanted = recipes_wanted(scene, seconds);
    // The velocities in files are known only once the first are read.
    const bool by_velocity =
        std::ranges::any_of(scene.media, [](const auto& medium) { return medium.velocity.has_value(); });
    std::vector<Moment> moments = with_growths(frame.moments, by_velocity ? infinity : wanted);
    auto all = std::make_shared<std::vector<Snapshot>>();
    all->reserve(moments.size());
    for (size_t i = 0; i < moments.size(); ++i) {
        all->push_back(make_snapshot(scene, moments[i], i == 0 ? previous : &all->back(), missing, files));
        if (i > 0) continue;
        const double most = growths_affordable(scene, all->front());
        if (!by_velocity && most >= wanted) continue;
        const std::optional<double> grown = moments[0].grown;
        moments =
            with_growths(frame.moments, std::min(std::max(wanted, files_wanted(scene, all->front(), seconds)), most));
        if (moments[0].grown == grown) continue;
        std::vector<std::string> notes = std::move(all->front().notes); // those of files that are now known
        all->front() = make_snapshot(scene, moments[0], &all->front(), missing, files);
        std::ranges::move(all->front().notes, std::back_inserter(notes));
        all->front().notes = std::move(notes);
    }
    Moment middle_moment = frame.middle;
    middle_moment.grown = moments[moments.size() / 2].grown;
    Snapshot middle = make_snapshot(scene, middle_moment, &(*all)[moments.size() / 2], missing, std::move(files));
    for (const Snapshot& moment : *all)
        for (const std::string& note : moment.notes)
            if (!std::ranges::count(middle.notes, note)) middle.notes.push_back(note);
    middle.moments = std::move(all);
    return middle;
}
}
