// Fog light cached in froxels (Wronski 2014; Hillaire 2015): filled once per frame, integrated front to back, found
// again for every camera ray.
#include "modes/froxel_lookup.h"
#include "modes/froxel_memory.h"
#include "modes/style.h"
#include "modes/techniques.h"

#include <mutex>

namespace tyndall {
namespace {
constexpr int tail_slices = 12; // for fog that goes on behind the scene

struct FroxelFrame {
    FroxelScene scene;
    FroxelPicture picture;
    bool has_history = false;
    int frame = 0;

    // Of each light, and of ambient light and emission: made when first asked for.
    std::once_flag parts_made;
    std::vector<FroxelSums> parts;
};

// The scene as the settings see it.
void set_scene(const View& view, const Snapshot& snapshot, const Settings& settings, FroxelScene& scene) {
    const MarchSettings& terms = settings.march;
    scene.snapshot = stylised(snapshot, settings.style);
    scene.settings = settings.froxel, scene.style = settings.style;
    if (!terms.heterogeneity) scene.snapshot.media = even_media(scene.snapshot.media);
    for (Medium& medium : scene.snapshot.media) {
        if (!terms.phase) medium.optics.phase.kind = PhaseKind::isotropic;
        if (!terms.emission) medium.optics.emission = vec3(0);
    }
    if (!terms.ambient) scene.snapshot.ambient = vec3(0);
    for (const Light& light : scene.snapshot.lights) {
        scene.depths.push_back(make_light_depth(scene.snapshot, light, terms.light, terms.light_resolution, &view));
        scene.depths.back().scale = settings.style.light_depth;
        scene.cones.push_back(cone_falloff(light));
    }
    if (scene.settings.visibility != FroxelVisibility::slices || !snapshot.occluders) return;
    if (snapshot.occluders->has_alpha())
        scene.settings.visibility = FroxelVisibility::rays;
    else
        scene.slices = snapshot.occluders->shadow_slices();
}

// This frame's light, with what the history knows of it; the history then knows this frame.
FroxelLight light_with_history(FroxelFrame& frame, History& history) {
    const FroxelGrid& grid = frame.picture.grid;
    const FroxelTiles& tiles = frame.picture.tiles;
    const FroxelSettings& settings = frame.scene.settings;
    FroxelLight light;
    if (frame.frame == 0 || !history.froxels) {
        light = fill_froxels(frame.scene, grid, tiles, {});
    } else {
        const FroxelLight remembered = recall(*history.froxels, grid, tiles);
        std::vector<uint8_t> stale;
        if (settings.amortise) stale = stale_froxels(grid, remembered, frame.scene.snapshot.lights, frame.frame);
        const uint8_t* skipped = stale.empty() ? nullptr : stale.data();
        light = fill_froxels(frame.scene, grid, tiles, {-1, frame.frame, skipped});
        const float most = 1 - 1 / static_cast<float>(frame.frame + 1); // the mean of all frames so far
        blend_history(grid, tiles, remembered, skipped, std::min(settings.history, most), light);
        frame.has_history = true;
    }
    history.froxels = std::make_shared<const FroxelMemory>(memory_of(grid, tiles, light));
    return light;
}

void make_parts(FroxelFrame& frame) {
    const FroxelPicture& picture = frame.picture;
    const int lights = static_cast<int>(frame.scene.snapshot.lights.size());
    for (int part = 0; part < lights + frame.has_history; ++part)
        frame.parts.push_back(integrate_froxels(
            picture.grid, picture.tiles,
            fill_froxels(frame.scene, picture.grid, picture.tiles, {part, frame.frame, nullptr}), picture.view_depth));
}

// The lights' parts are those of this frame alone; where the history changed their sum they change alike.
void look_up_with_parts(FroxelFrame& frame, const RayBatch& batch, std::span<Scatter> results) {
    std::call_once(frame.parts_made, [&] { make_parts(frame); });
    const size_t lights = frame.scene.snapshot.lights.size(), parts = frame.parts.size();
    std::vector<vec3> light(batch.rays.size() * parts);
    look_up_froxels(frame.picture, batch, results, frame.parts, light);
    for (size_t ray = 0; ray < batch.rays.size(); ++ray) {
        const std::span<const vec3> of_ray{light.data() + ray * parts, parts};
        vec3 sum(0), scale(1);
        for (const vec3& part : of_ray) sum += part;
        for (int c = 0; c < 3 && frame.has_history; ++c) scale[c] = sum[c] > 0 ? results[ray].radiance[c] / sum[c] : 0;
        for (size_t i = 0; i < lights; ++i) batch.per_light[ray * lights + i] = scale * of_ray[i];
    }
}
}

ScatterFunction prepare_froxel(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    auto frame = std::make_shared<FroxelFrame>();
    if (history) frame->frame = follow(*history, view, snapshot, settings);
    if (settings.froxel.history == 0) frame->frame = 0;
    set_scene(view, snapshot, settings, frame->scene);

    FroxelPicture& picture = frame->picture;
    picture.lookup = settings.froxel.lookup, picture.view_depth = settings.style.view_depth;
    picture.grid = make_froxel_grid(view.camera, view.size, settings.froxel.tile);
    picture.tiles = *kept(snapshot, KeptKey().add(snapshot.occluders).add(view).add(settings.froxel.tile),
                          [&] { return make_froxel_tiles(picture.grid, snapshot); });
    const FogDepths depths = fog_depths(picture.grid, picture.tiles, frame->scene.snapshot);
    if (!(depths.far > depths.near)) { // no fog in view
        if (history) history->froxels = nullptr;
        return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
    }
    set_slices(picture.grid, depths.near, depths.far, settings.froxel.depth_slices, settings.froxel.depth_growth,
               depths.end, tail_slices);
    set_trust(picture.grid, picture.tiles);

    const FroxelLight light =
        history ? light_with_history(*frame, *history) : fill_froxels(frame->scene, picture.grid, picture.tiles, {});
    picture.sums = integrate_froxels(picture.grid, picture.tiles, light, picture.view_depth);
    return [frame](const RayBatch& batch, std::span<Scatter> results) {
        if (batch.per_light.empty()) return look_up_froxels(frame->picture, batch, results);
        look_up_with_parts(*frame, batch, results);
    };
}
}
