#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/fill/fill.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/fill/fill.h"

#include <array>
#include <cstring>

#include "base/parallel.h"
#include "modes/froxel/beams/beam_fill_simd.h"
#include "modes/froxel/fill/scatter_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// State of a packet, reused from slice to slice.
struct Packet {
    Lanes where;
    size_t index = 0;                        // among the grid's packets
    std::vector<FirstRays> first;            // per sample
    std::vector<LightInjection> exact;       // likewise
    std::vector<std::array<float, 16>> here; // extinction of each medium, for the current sample
    PacketBeams beams;
};

// Extinction of every medium at the lanes' samples; returns the sum.
Floats find_extinctions(const Fill& fill, Packet& packet, const FroxelLanes& lanes, int slice, int sample) {
    const std::vector<Medium>& media = fill.scene.snapshot.media;
    const size_t k = static_cast<size_t>(slice), slices = static_cast<size_t>(fill.grid.slices());
    const float thickness = fill.grid.thickness(k);
    const size_t samples = static_cast<size_t>(fill.samples());
    const size_t place = ((packet.index * slices + k) * samples + static_cast<size_t>(sample)) * media.size() * 16;
    Floats sum = 0.0f;
    for (size_t m = 0; m < media.size(); ++m) {
        const Floats one =
            fill.pass.known ? load(fill.pass.known + place + 16 * m) : mean_extinction(media[m], lanes, thickness);
        if (fill.pass.noted) store(one, fill.pass.noted + place + 16 * m);
        store(one, packet.here[m].data());
        sum = sum + one;
    }
    return sum;
}

// Stores red, green, blue and extinction of the lanes in their froxels.
void put(const Fill& fill, const Lanes& where, int slice, const Vec3s& light, const Floats& extinction) {
    alignas(64) float rgbs[64];
    for (size_t i = 0; i < vectors_per_packet; ++i)
        hn::StoreInterleaved4(light.x.part[i], light.y.part[i], light.z.part[i], extinction.part[i], FloatTag(),
                              rgbs + 4 * i * lane_step);
    for (size_t i = 0; i < 16; ++i)
        if (where.in_grid[i]) std::memcpy(fill.light.at(fill.grid, where.tile[i], slice), rgbs + 4 * i, 16);
}

HWY_NOINLINE void fill_slice(const Fill& fill, Packet& packet, int slice) {
    const Snapshot& snapshot = fill.scene.snapshot;
    const auto* extinction = reinterpret_cast<const float(*)[16]>(packet.here.data());
    const bool sheet = holds_sheet(fill, slice);

    // Sums extinction and light over the samples.
    Vec3s light = splat(vec3(0));
    Floats total = 0.0f;
    for (std::array<float, 16>& sum : packet.beams.sums) sum.fill(0);
    for (int sample = 0; sample < fill.samples(); ++sample) {
        const size_t s = static_cast<size_t>(sample);
        const FroxelSamples points = froxel_samples(fill, packet.where, packet.first[s], slice, sample);
        const FroxelLanes whole = froxel_lanes(fill.grid, points);
        const Floats here = find_extinctions(fill, packet, whole, slice, sample);
        total = total + here;
        const FroxelLanes lanes = sheet ? in_fog(snapshot.media, whole, extinction) : whole;
        const Mask16 lit = lanes.active & (here > 0.0f) & (load(points.lit) > 0.0f);
        const Job job{packet.where, points,
                      slice,        sample,
                      sheet,        fill.exact() ? &packet.exact[s] : nullptr,
                      extinction,   here * whole.length * fill.scene.style.view_depth};
        if (has_beams(fill)) add_beams(fill, packet.beams, lanes, job);
        if (!any(lit)) continue;
        Vec3s sum = other_light(fill, lanes, extinction);
        for (size_t i = 0; i < snapshot.lights.size(); ++i)
            if (fill.wants(i)) sum = sum + scattered_from(fill, i, lanes, lit, job);
        light = fma(sum, style_fade(fill.scene.style, fill.grid.camera, lanes.point), light);
    }
    const Floats inverse = zero_unless(total > 0.0f, 1.0f / max(total, 1e-30f));
    if (has_beams(fill)) put_beams(fill, packet.where, packet.beams, slice);
    put(fill, packet.where, slice, light * inverse, total * (1 / static_cast<float>(fill.samples())));
}

// Whether any visible froxel of a tile has to be relit.
bool is_wanted(const Fill& fill, const Lanes& lanes, int i) {
    if (!lanes.in_grid[i] || !fill.pass.stale) return lanes.in_grid[i];
    const size_t slices = static_cast<size_t>(fill.grid.slices());
    for (size_t k = 0; k < slices && !is_hidden(fill.grid, fill.tiles, lanes.tile[i], static_cast<int>(k)); ++k)
        if (!fill.pass.stale[lanes.tile[i] * slices + k]) return true;
    return false;
}

// Finds exact light for every sample of the wanted tiles.
void find_all_lit(const Fill& fill, const bool (&wanted)[16], Packet& packet) {
    const Lanes& lanes = packet.where;
    ivec2 at[16];
    for (int i = 0; i < 16; ++i) at[i] = wanted[i] ? lanes.at[i] : fill.grid.size;
    packet.exact.resize(static_cast<size_t>(fill.samples()));
    for (int sample = 0; sample < fill.samples(); ++sample) {
        uint32_t indices[16];
        for (int i = 0; i < 16; ++i) indices[i] = spread_index(fill, lanes.at[i], sample);
        find_froxel_lit(fill.scene, fill.grid, fill.tiles, at, first_ray(fill, sample),
                        fill.spreads() ? indices : nullptr, packet.exact[static_cast<size_t>(sample)]);
    }
}

// Sets lanes `stride` tiles apart, from a corner on; returns false if none is in the grid.
bool set_lanes(const Fill& fill, ivec2 corner, int stride, Lanes& lanes) {
    bool some = false;
    lanes.last = 0;
    for (int i = 0; i < 16; ++i) {
        lanes.at[i] = corner + stride * ivec2(i % 4, i / 4);
        lanes.in_grid[i] = lanes.at[i].x < fill.grid.size.x && lanes.at[i].y < fill.grid.size.y;
        lanes.tile[i] = lanes.in_grid[i] ? fill.grid.tile_index(lanes.at[i]) : 0;
        lanes.farthest[i] = lanes.in_grid[i] ? fill.tiles.farthest[lanes.tile[i]] : -infinity;
        some |= lanes.in_grid[i];
        if (lanes.in_grid[i])
            lanes.last = std::max(lanes.last, static_cast<int>(seen_slices(fill.grid, fill.tiles, lanes.tile[i])));
    }
    return some;
}

// With amortized filling, a packet consists of every second tile in both directions, so that all of it is either relit
// or stale.
int stride_of(const FroxelScene& scene) { return scene.settings.amortize ? 2 : 1; }

// Fills a block of tiles through all slices.
void fill_block(const Fill& fill, ivec2 corner, int stride, size_t block) {
    static thread_local Packet memory;
    Packet& packet = memory;
    packet.here.resize(fill.scene.snapshot.media.size());
    if (!has_beams(fill)) packet.beams.sums.clear();
    for (int phase = 0; phase < stride * stride; ++phase) {
        if (!set_lanes(fill, corner + ivec2(phase % stride, phase / stride), stride, packet.where)) continue;
        packet.index = block * static_cast<size_t>(stride * stride) + static_cast<size_t>(phase);
        packet.first.clear();
        for (int sample = 0; sample < fill.samples(); ++sample)
            packet.first.push_back(first_rays(fill, packet.where, sample));
        bool wanted[16], any_wanted = false;
        for (int i = 0; i < 16; ++i) any_wanted |= wanted[i] = is_wanted(fill, packet.where, i);
        if (fill.pass.statics && !any_wanted && !fill.pass.noted) continue;
        if (fill.exact()) find_all_lit(fill, wanted, packet);
        if (has_beams(fill)) prepare_beams(fill, packet.where, packet.beams);
        for (int slice = 0; slice < packet.where.last; ++slice) fill_slice(fill, packet, slice);
        for (int slice = packet.where.last; has_beams(fill) && slice < fill.grid.slices(); ++slice)
            put_beams(fill, packet.where, packet.beams, slice);
        const size_t behind = static_cast<size_t>(fill.grid.slices() - packet.where.last);
        for (size_t i = 0; i < 16; ++i)
            if (packet.where.in_grid[i])
                std::fill_n(fill.light.at(fill.grid, packet.where.tile[i], packet.where.last), 4 * behind, 0.0f);
    }
}

ivec2 blocks_of(const FroxelGrid& grid, int stride) { return (grid.size + 4 * stride - 1) / (4 * stride); }

void fill_kernel(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const FillPass& pass,
                 FroxelLight& light) {
    const Fill fill{scene, grid, tiles, pass, light};
    const int stride = stride_of(scene);
    const ivec2 blocks = blocks_of(grid, stride);
    parallel_for(int64_t{blocks.x} * blocks.y, [&](int64_t b) {
        fill_block(fill, 4 * stride * ivec2(b % blocks.x, b / blocks.x), stride, static_cast<size_t>(b));
    });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_kernel);
size_t extinction_count(const FroxelScene& scene, const FroxelGrid& grid) {
    const size_t tiles =
        static_cast<size_t>((grid.size.x + 7) / 8 * 8) * static_cast<size_t>((grid.size.y + 7) / 8 * 8);
    return tiles * static_cast<size_t>(grid.slices() * scene.settings.shadow_rays) * scene.snapshot.media.size();
}

FroxelLight fill_froxels(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                         const FillPass& pass) {
    FroxelLight light;
    light.values.resize(4 * grid.tiles() * static_cast<size_t>(grid.slices()));
    HWY_DYNAMIC_DISPATCH(fill_kernel)(scene, grid, tiles, pass, light);
    return light;
}
}
#endif
