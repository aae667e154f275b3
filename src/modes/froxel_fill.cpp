#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel_fill.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel_fill.h"

#include "base/parallel.h"
#include "modes/froxel_scatter_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void fill_lanes(const Fill& fill, const Lanes& where, int slice, const std::vector<FroxelLit>& exact) {
    const Snapshot& snapshot = fill.scene.snapshot;
    static thread_local std::vector<std::array<float, 16>> scratch;
    scratch.resize(snapshot.media.size());
    auto* extinction = reinterpret_cast<float(*)[16]>(scratch.data());
    const size_t k = static_cast<size_t>(slice);
    const float thickness = fill.grid.faces[k + 1] - fill.grid.faces[k];

    // Extinctions and lights add up over the samples.
    Vec3s light = splat(vec3(0));
    Floats total = 0.0f;
    for (int sample = 0; sample < fill.samples(); ++sample) {
        const Looks looks = look(fill, where, slice, sample);
        const FroxelLanes lanes = froxel_lanes(fill.grid, looks);
        if (!any(lanes.active)) return;
        Floats here = 0.0f;
        for (size_t m = 0; m < snapshot.media.size(); ++m) {
            const Floats one = mean_extinction(snapshot.media[m], lanes, thickness);
            store(one, extinction[m]);
            here = here + one;
        }
        total = total + here;
        const Mask16 lit = lanes.active & (here > 0.0f) & (load(looks.lit) > 0.0f);
        if (!any(lit)) continue;
        Vec3s sum = fill.wants(snapshot.lights.size()) ? glow_of(snapshot, extinction) : splat(vec3(0));
        const Job job{where,     looks, slice, sample, fill.exact() ? &exact[static_cast<size_t>(sample)] : nullptr,
                      extinction};
        for (size_t i = 0; i < snapshot.lights.size(); ++i)
            if (fill.wants(i)) sum = sum + scattered_from(fill, i, lanes, lit, job);
        light = fused(sum, faded(fill.scene.style, fill.grid, lanes), light);
    }

    const Floats inverse = zero_unless(total > 0.0f, 1.0f / max(total, 1e-30f));
    alignas(64) float rgbs[4][16];
    store(light.x * inverse, rgbs[0]), store(light.y * inverse, rgbs[1]), store(light.z * inverse, rgbs[2]);
    store(total * (1 / static_cast<float>(fill.samples())), rgbs[3]);
    for (size_t i = 0; i < 16; ++i) {
        if (!where.there[i]) continue;
        float* values = fill.light.at(fill.grid, where.tile[i], slice);
        for (int c = 0; c < 4; ++c) values[c] = rgbs[c][i];
    }
}

// Whether any froxel of a tile is to be lit anew.
bool is_wanted(const Fill& fill, const Lanes& lanes, int i) {
    if (!lanes.there[i] || !fill.pass.stale) return lanes.there[i];
    const size_t slices = static_cast<size_t>(fill.grid.slices());
    for (size_t k = 0; k < slices && !is_hidden(fill.grid, fill.tiles, lanes.tile[i], static_cast<int>(k)); ++k)
        if (!fill.pass.stale[lanes.tile[i] * slices + k]) return true;
    return false;
}

// Exact light for every sample of 16 tiles.
std::vector<FroxelLit> find_all_lit(const Fill& fill, const Lanes& lanes) {
    ivec2 wanted[16];
    for (int i = 0; i < 16; ++i) wanted[i] = is_wanted(fill, lanes, i) ? lanes.at[i] : fill.grid.size;
    std::vector<FroxelLit> lit;
    for (int sample = 0; sample < fill.samples(); ++sample) {
        uint32_t indices[16];
        for (int i = 0; i < 16; ++i) indices[i] = spread_index(fill, lanes.at[i], sample);
        lit.push_back(find_froxel_lit(fill.scene, fill.grid, fill.tiles, wanted, first_ray(fill, sample),
                                      fill.spreads() ? indices : nullptr));
    }
    return lit;
}

// A block of tiles through all slices. Every second tile in both directions makes a packet when only a quarter of the
// froxels is new in a frame: then packets are wholly new or wholly remembered.
void fill_block(const Fill& fill, ivec2 corner, int stride) {
    std::vector<FroxelLit> exact;
    for (int phase = 0; phase < stride * stride; ++phase) {
        Lanes lanes;
        bool some = false;
        for (int i = 0; i < 16; ++i) {
            lanes.at[i] = corner + ivec2(phase % stride, phase / stride) + stride * ivec2(i % 4, i / 4);
            lanes.there[i] = lanes.at[i].x < fill.grid.size.x && lanes.at[i].y < fill.grid.size.y;
            lanes.tile[i] = lanes.there[i] ? fill.grid.tile_index(lanes.at[i]) : 0;
            some |= lanes.there[i];
        }
        if (!some) continue;
        if (fill.exact()) exact = find_all_lit(fill, lanes);
        for (int slice = 0; slice < fill.grid.slices(); ++slice) fill_lanes(fill, lanes, slice, exact);
    }
}

void fill_kernel(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const FillPass& pass,
                 FroxelLight& light) {
    const Fill fill{scene, grid, tiles, pass, light};
    const int stride = pass.stale ? 2 : 1, side = 4 * stride;
    const ivec2 blocks = (grid.size + side - 1) / side;
    parallel_for(int64_t{blocks.x} * blocks.y,
                 [&](int64_t b) { fill_block(fill, side * ivec2(b % blocks.x, b / blocks.x), stride); });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_kernel);
FroxelLight fill_froxels(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                         const FillPass& pass) {
    FroxelLight light;
    light.values.assign(4 * grid.tiles() * static_cast<size_t>(grid.slices()), 0.0f);
    HWY_DYNAMIC_DISPATCH(fill_kernel)(scene, grid, tiles, pass, light);
    return light;
}
}
#endif
