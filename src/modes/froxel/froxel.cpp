// Fog light cached in froxels (Wronski 2014; Hillaire 2015): filled once per frame, integrated front to back, and
// interpolated for every camera ray.
#include "base/parallel.h"
#include "base/simd/simd.h"
#include "integrate/lights/field_light.h"
#include "integrate/lights/lamps.h"
#include "integrate/style.h"
#include "modes/froxel/glow.h"
#include "modes/froxel/grid.h"
#include "modes/froxel/history/froxel_history.h"
#include "modes/froxel/limitations.h"
#include "modes/froxel/lookup/lookup.h"
#include "modes/froxel/settings.h"
#include "modes/froxel/statics.h"
#include "modes/history.h"
#include "modes/lens_fog.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <mutex>

namespace tyndall {
namespace {
struct FroxelFrame {
    FroxelScene scene;
    FroxelBuffer buffer;
    bool has_history = false;
    int frame = 0;

    // The light's parts, and their indices (see part_count); computed on first use.
    std::once_flag parts_made;
    std::vector<FroxelSums> parts;
    std::vector<size_t> indices;
};

// Fills `scene` with the settings applied. Returns the fields that rays integrate by themselves.
FieldLight set_scene(const View& view, const Snapshot& snapshot, const Settings& settings, FroxelScene& scene) {
    const TermSettings& terms = settings.terms;
    scene.snapshot = with_lamps(snapshot, settings.style, terms);
    FieldLight fields = take_fields(scene.snapshot, settings.style, view.camera);
    scene.settings = with_tile(settings.of<FroxelSettings>(), view.size), scene.style = settings.style;
    scene.sun_media = media_in_sunlight(view, scene.snapshot, scene.settings.tile);
    std::vector<const Medium*> bricks;
    for (const Medium& medium : scene.snapshot.media)
        if (medium.density.kind == DensityKind::bricks) bricks.push_back(&medium);
    // Surfaces need complete grids; without surfaces, columns are filled on demand.
    const bool filled = scene.snapshot.occluders && !scene.snapshot.occluders->empty();
    for (const Light& light : scene.snapshot.lights) {
        scene.depths.push_back(
            make_light_depth(scene.snapshot, light, terms.light, terms.light_resolution, &view, filled));
        LightDepth& depth = scene.depths.back();
        depth.scale = settings.style.light_depth;
        const bool on_demand = depth.method == LightTransmittance::grid && depth.grid.size.x > 0 && !depth.grid.depth;
        scene.columns.push_back(on_demand ? std::make_unique<const GridColumns>(bricks, depth.grid) : nullptr);
        scene.cones.push_back(cone_falloff(light));
    }
    scene.fluence = cached_fluence(scene.snapshot, settings.fluence, view.seed);
    return fields;
}

// A camera whose pixels are the grid's tiles.
Camera tile_camera(const FroxelGrid& grid) {
    Camera camera = grid.camera;
    const float wider = static_cast<float>(grid.size.y * grid.tile) / static_cast<float>(grid.image_size.y);
    camera.vertical_fov = 2 * std::atan(std::tan(0.5f * camera.vertical_fov) * wider);
    camera.ortho_height *= wider;
    return camera;
}

// Selects the lights that camera rays integrate themselves (beams). None with amortized filling, which relights few
// froxels per frame: beams would update all of them.
void set_beams(const FroxelGrid& grid, FroxelScene& scene) {
    if (scene.settings.visibility == FroxelVisibility::intervals) scene.views_fit = lamp_views_fit(scene.snapshot);
    for (size_t i = 0; i < scene.snapshot.lights.size(); ++i) {
        scene.nears.push_back(scene.settings.amortize ? NearLight{} : near_light(scene, grid, i));
        if (scene.nears.back().radius > 0) scene.beams.push_back(i);
    }
}

// Prepares exact shadows of the lights that froxels hold. In frames and samples beyond the first, lines see different
// points of a soft light.
void set_shadows(FroxelFrame& frame, FroxelStatics& statics) {
    FroxelScene& scene = frame.scene;
    const Occluders* occluders = scene.snapshot.occluders.get();
    if (scene.settings.visibility != FroxelVisibility::intervals || !occluders || occluders->empty()) return;
    const bool spread = scene.settings.shadow_rays > 1 || frame.frame > 0;
    constexpr float margin = 0.5f; // tiles are up to half a tile off where the image ends inside one
    const size_t lights = scene.snapshot.lights.size();
    scene.views.resize(lights), scene.slices.resize(lights);
    parallel_for(static_cast<int64_t>(lights), [&](int64_t i) {
        const Light& light = scene.snapshot.lights[static_cast<size_t>(i)];
        const auto& casters = shadow_casters(light, scene.snapshot);
        if (!casters || scene.has_pixel_views(static_cast<size_t>(i))) return;
        if ((is_soft(light) && spread) || (!is_distant(light) && !scene.views_fit)) {
            scene.slices[static_cast<size_t>(i)] = &casters->shadow_slices();
            return;
        }
        const std::shared_ptr<const ShadowVolumes> volumes = cached_shadow_volumes(scene.snapshot, light);
        scene.views[static_cast<size_t>(i)] = std::make_unique<const ShadowView>(
            view_from(*volumes, tile_camera(statics.grid), statics.grid.size, margin));
    });
}

// Prepares the shadows of lamps that are found per camera ray.
void set_pixel_shadows(const View& view, FroxelScene& scene) {
    const Occluders* occluders = scene.snapshot.occluders.get();
    if (scene.settings.visibility != FroxelVisibility::intervals || !occluders || occluders->empty()) return;
    scene.pixel_margin = view.filter == PixelFilter::center ? 0 : std::max(view.filter_radius - 0.5f, 0.0f);
    scene.pixel_views.resize(scene.snapshot.lights.size());
    parallel_for(static_cast<int64_t>(scene.beams.size()), [&](int64_t i) {
        const size_t index = scene.beams[static_cast<size_t>(i)];
        const Light& light = scene.snapshot.lights[index];
        if (shadow_casters(light, scene.snapshot) && scene.has_exact_shadows(light))
            scene.pixel_views[index] = lamp_views(scene.snapshot, light, view, scene.pixel_margin);
    });
}

// The last frame's light at this frame's froxels; moved instead of copied if nothing else owns it.
Reprojection remembered(std::shared_ptr<FroxelHistory> memory, const FroxelStatics& statics) {
    if (!statics.same_froxels) return reproject(*memory, statics.grid, statics.tiles);
    return {memory.use_count() == 1 ? std::move(memory->light) : memory->light, {}};
}

// This frame's sums, blended with the history, which then holds this frame.
FroxelSums sums_with_history(FroxelFrame& frame, FroxelStatics& statics, std::shared_ptr<FroxelHistory>& memory) {
    const FroxelSettings& settings = frame.scene.settings;
    const float view_depth = frame.buffer.view_depth;
    FroxelBeams* beams = &frame.buffer.beams;
    FroxelLight light;
    FroxelSums sums;
    if (frame.frame == 0 || !memory) {
        light = fill_still_froxels(frame.scene, statics, {.beams = beams});
        sums = integrate_froxels(statics.grid, statics.tiles, light, view_depth);
        clear_invalid(statics.grid, statics.tiles, light);
    } else {
        Reprojection past = remembered(std::exchange(memory, nullptr), statics);
        light = std::move(past.light);
        const std::vector<Light>& lights = frame.scene.snapshot.lights;
        std::vector<uint8_t> stale;
        const bool settled = statics.settled();
        if (settings.amortize) stale = stale_froxels(statics.grid, light, lights, frame.frame, settled);
        const uint8_t* skipped = stale.empty() ? nullptr : stale.data();
        const FillPass pass{.frame = frame.frame, .stale = skipped, .statics = settled, .beams = beams};
        const FroxelLight now = fill_still_froxels(frame.scene, statics, pass);
        const float most = 1 - 1 / static_cast<float>(frame.frame + 1); // the mean of all frames so far
        const BlendPass blend{std::min(settings.history, most), view_depth, skipped, settled, past.blur};
        sums = blend_history(statics.grid, statics.tiles, now, blend, light);
        frame.has_history = true;
    }
    memory = std::make_shared<FroxelHistory>(FroxelHistory{statics.grid, std::move(light), std::move(statics)});
    return sums;
}

bool has(const FroxelScene& scene, OtherLight light) {
    if (light == OtherLight::multiple) return scene.fluence != nullptr;
    if (light == OtherLight::ambient) return max_component(scene.snapshot.ambient) > 0;
    return std::ranges::any_of(scene.snapshot.media,
                               [](const Medium& medium) { return max_component(medium.optics.emission.radiance) > 0; });
}

void make_parts(FroxelFrame& frame) {
    const FroxelBuffer& buffer = frame.buffer;
    const size_t lights = frame.scene.snapshot.lights.size();
    for (size_t part = 0; part < part_count(lights); ++part) {
        if (part >= lights ? !has(frame.scene, OtherLight{part - lights}) : frame.scene.is_beam(part)) continue;
        const FillPass pass{.only = static_cast<int>(part), .frame = frame.frame};
        frame.indices.push_back(part);
        frame.parts.push_back(integrate_froxels(
            buffer.grid, buffer.tiles, fill_froxels(frame.scene, buffer.grid, buffer.tiles, pass), buffer.view_depth));
    }
}

// Parts are of this frame only; they are scaled to match the sum after blending with the history. Light that only the
// history has goes to the first part.
void look_up_with_parts(FroxelFrame& frame, const RayBatch& batch, std::span<Scatter> results) {
    std::call_once(frame.parts_made, [&] { make_parts(frame); });
    const size_t parts = frame.parts.size(), beams = frame.scene.beams.size();
    std::vector<vec3> light(batch.rays.size() * parts), of_beams(batch.rays.size() * beams);
    look_up_froxels(frame.buffer, batch, results, frame.parts, light, of_beams);
    for (size_t ray = 0; ray < batch.rays.size(); ++ray) {
        const std::span<const vec3> of_ray{light.data() + ray * parts, parts};
        vec3 sum(0), scale(1), rest(0), remembered = results[ray].radiance;
        for (size_t i = 0; i < beams; ++i) {
            batch.part(ray, frame.scene.beams[i]) += of_beams[ray * beams + i];
            remembered -= of_beams[ray * beams + i];
        }
        for (const vec3& part : of_ray) sum += part;
        for (int c = 0; c < 3 && frame.has_history; ++c)
            (sum[c] > 0 ? scale[c] : rest[c]) = std::max(remembered[c], 0.0f) / (sum[c] > 0 ? sum[c] : 1);
        for (size_t i = 0; i < parts; ++i)
            batch.part(ray, frame.indices[i]) += scale * of_ray[i] + (i == 0 ? rest : vec3(0));
    }
}
}

ScatterFunction prepare_froxel(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    auto frame = std::make_shared<FroxelFrame>();
    if (history) frame->frame = update_history(*history, view, snapshot, settings);
    if (settings.of<FroxelSettings>().history == 0) frame->frame = 0;
    FieldLight fields = set_scene(view, snapshot, settings, frame->scene);

    const FroxelHistory* memory = history ? history->froxels.get() : nullptr;
    FroxelStatics statics =
        make_statics(view, frame->scene.snapshot, frame->scene.settings, memory ? &memory->statics : nullptr);
    if (statics.grid.faces.empty()) { // no fog in view
        if (history) history->froxels = nullptr;
        return with_field_light(std::move(fields), [](const RayBatch&, std::span<Scatter> results) {
            std::ranges::fill(results, Scatter{});
        });
    }
    set_beams(statics.grid, frame->scene);
    set_pixel_shadows(view, frame->scene);
    set_shadows(*frame, statics);

    FroxelBuffer& buffer = frame->buffer;
    buffer.lookup = settings.of<FroxelSettings>().lookup, buffer.view_depth = settings.style.view_depth;
    buffer.grid = statics.grid, buffer.tiles = statics.tiles;
    buffer.beams = make_froxel_beams(frame->scene, buffer.grid);
    buffer.scene = &frame->scene;
    buffer.sums =
        history ? sums_with_history(*frame, statics, history->froxels)
                : integrate_froxels(buffer.grid, buffer.tiles,
                                    fill_froxels(frame->scene, buffer.grid, buffer.tiles, {.beams = &buffer.beams}),
                                    buffer.view_depth);
    ScatterFunction scatter = [frame](const RayBatch& batch, std::span<Scatter> results) {
        if (batch.parts.empty()) return look_up_froxels(frame->buffer, batch, results);
        look_up_with_parts(*frame, batch, results);
    };
    scatter = with_lamps_as_emission(snapshot.lights.size(), frame->scene.snapshot.lights.size(), std::move(scatter));
    return with_field_light(std::move(fields), through_middle(view, std::move(scatter)));
}

Mode froxel_mode() {
    return {.name = "froxel",
            .summary = "fog light cached in voxels of the view frustum: previews at interactive rates",
            .use = "interactive previews, and fog while lights and camera move",
            .accuracy = Accuracy::single_scattering,
            .surfaces = Surfaces::shared,
            .limitations = froxel_limitations,
            .prepare = prepare_froxel,
            .append_rows = append_froxel_rows,
            .set_quality = set_froxel_quality,
            .rungs = froxel_rungs,
            .color = "#E69F00",
            .uses_history = true,
            .adds_fluence = true,
            .interactive = true,
            .often_fastest = true};
}
}
