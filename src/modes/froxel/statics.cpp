#include "modes/froxel/statics.h"
#include "modes/froxel/settings.h"

#include "trace/frame_cache.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr int tail_slices = 12; // for fog that extends behind the scene

bool same(const Box& a, const Box& b) { return a.low == b.low && a.high == b.high; }

bool same(const Camera& a, const Camera& b) {
    return a.position == b.position && a.right == b.right && a.up == b.up && a.forward == b.forward &&
           a.vertical_fov == b.vertical_fov && a.ortho_height == b.ortho_height && a.near == b.near && a.far == b.far;
}

bool same(const std::shared_ptr<const Occluders>& a, const std::shared_ptr<const Occluders>& b) {
    return a == b || (a && b && a->shares_with(*b));
}

// Compares where a medium is and how dense, not how it scatters.
bool same(const Medium& a, const Medium& b) {
    return a.density.kind == b.density.kind && gray_extinction(a.optics) == gray_extinction(b.optics) &&
           same(a.density.bounds, b.density.bounds) && a.density.world_to_local == b.density.world_to_local &&
           same(a.world_bounds, b.world_bounds) && a.density.height_base == b.density.height_base &&
           a.density.height_falloff == b.density.height_falloff && a.density.bricks == b.density.bricks;
}

// Whether a grid's slices still cover the fog and are hardly larger than needed: then froxels stay in place, and
// history needs no resampling.
bool serve(const FroxelGrid& grid, int slices, const FogDepths& depths) {
    constexpr float wider = 1.1f;
    const float near = grid.faces.front(), far = grid.faces[static_cast<size_t>(slices)], end = grid.faces.back();
    const float needed = std::max(depths.far, depths.end);
    return near <= depths.near && depths.far <= far && needed <= end &&
           far - near <= wider * (depths.far - depths.near) && end - near <= wider * (needed - depths.near);
}

// Adds a margin for fog that keeps moving.
FogDepths widened(FogDepths depths) {
    constexpr float room = 1.0f / 32;
    const float margin = room * (depths.far - depths.near);
    depths.near = std::max(depths.near - margin, 0.0f), depths.far += margin, depths.end *= 1 + room;
    return depths;
}

bool same(const std::vector<Medium>& a, const std::vector<Medium>& b) {
    return std::ranges::equal(a, b, [](const Medium& x, const Medium& y) { return same(x, y); });
}
}

FroxelStatics make_statics(const View& view, const Snapshot& snapshot, const FroxelSettings& settings,
                           const FroxelStatics* before) {
    FroxelStatics statics;
    statics.media = snapshot.media, statics.occluders = snapshot.occluders;
    statics.same_view = before && before->grid.image_size == view.size && before->grid.tile == settings.tile &&
                        same(before->grid.camera, view.camera) && same(before->occluders, snapshot.occluders);
    statics.same_fog = statics.same_froxels = statics.same_view && same(before->media, snapshot.media);
    if (statics.same_fog) {
        statics.grid = before->grid, statics.tiles = before->tiles, statics.extinctions = before->extinctions;
        statics.stood = before->stood + 1;
        return statics;
    }
    statics.grid = statics.same_view ? before->grid : make_froxel_grid(view.camera, view.size, settings.tile);
    statics.tiles = statics.same_view ? before->tiles
                                      : *cached(snapshot, "froxel tiles",
                                                CacheKey().add(snapshot.occluders).add(view).add(settings.tile),
                                                [&] { return make_froxel_tiles(statics.grid, snapshot); });
    FogDepths depths = fog_depths(statics.grid, statics.tiles, snapshot);
    if (!(depths.far > depths.near)) return statics;
    if (statics.same_view && serve(before->grid, settings.depth_slices, depths)) {
        statics.same_froxels = true;
        return statics;
    }
    if (statics.same_view) depths = widened(depths);
    set_slices(statics.grid, depths.near, depths.far, settings.depth_slices, settings.depth_growth, depths.end,
               tail_slices);
    set_trust(statics.grid, statics.tiles);
    return statics;
}

FroxelLight fill_still_froxels(const FroxelScene& scene, FroxelStatics& statics, FillPass pass) {
    const bool one_look = scene.settings.visibility == FroxelVisibility::intervals && scene.settings.shadow_rays == 1;
    if (!one_look || !statics.same_fog) return fill_froxels(scene, statics.grid, statics.tiles, pass);
    statics.extinctions.resize(statics.tiles.rays());
    std::shared_ptr<const RecycledFloats>& here =
        statics.extinctions[static_cast<size_t>(pass.frame) % statics.tiles.rays()];
    if (here) {
        pass.known = here->data();
        return fill_froxels(scene, statics.grid, statics.tiles, pass);
    }
    auto noted = std::make_shared<RecycledFloats>(extinction_count(scene, statics.grid));
    pass.noted = noted->data();
    FroxelLight light = fill_froxels(scene, statics.grid, statics.tiles, pass);
    here = std::move(noted);
    return light;
}
}
