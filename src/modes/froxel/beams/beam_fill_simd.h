// Data that froxels store for beams (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_BEAM_FILL_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_BEAM_FILL_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_BEAM_FILL_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_BEAM_FILL_SIMD_H
#endif

#include "modes/froxel/beams/near_simd.h"
#include "modes/froxel/fill/scatter_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// The beams of a packet of tiles, reused from slice to slice.
struct PacketBeams {
    std::vector<FroxelBeams::Reach> reaches; // [beam · 16 + lane]
    std::vector<FroxelBeams::Reach> all;     // per beam, union over lanes
    // Lengths of the rays inside the beams, and of their lit parts: [(sample · beams + beam) · slices + slice]
    std::vector<LightInjection::Depths> inside, lit;
    std::vector<std::array<float, 16>> sums; // per beam, then per medium: sums over the samples of a slice
};

bool has_beams(const Fill& fill) { return fill.pass.beams && !fill.pass.beams->lights.empty(); }

// The ray of a tile that a sample uses for beams: the same in each frame, as beams have no temporal history.
size_t beam_ray(const Fill& fill, int sample) { return static_cast<size_t>(sample) % fill.tiles.rays(); }

// Finds the reaches of all beams, and their lit segments on the rays of every sample.
void prepare_beams(const Fill& fill, const Lanes& where, PacketBeams& beams) {
    const FroxelBeams& kept = *fill.pass.beams;
    const size_t count = kept.lights.size(), slices = static_cast<size_t>(fill.grid.slices());
    beams.reaches.assign(16 * count, {}), beams.all.assign(count, {fill.grid.slices(), 0});
    beams.sums.resize(count + kept.media);
    for (size_t b = 0; b < count; ++b)
        for (size_t i = 0; i < 16; ++i) {
            if (!where.in_grid[i]) continue;
            const FroxelBeams::Reach& reach = beams.reaches[16 * b + i] = kept.reach(where.tile[i], b);
            if (reach.end == 0) continue;
            beams.all[b] = {std::min(beams.all[b].first, reach.first), std::max(beams.all[b].end, reach.end)};
        }
    if (!fill.exact()) return;
    beams.lit.assign(static_cast<size_t>(fill.samples()) * count * slices, {});
    beams.inside = beams.lit;
    for (int sample = 0; sample < fill.samples(); ++sample) {
        uint32_t indices[16];
        for (int i = 0; i < 16; ++i)
            indices[i] =
                static_cast<uint32_t>(((where.at[i].y & 3) * 4 + (where.at[i].x & 3)) * fill.samples() + sample);
        for (size_t b = 0; b < count; ++b) {
            const size_t first = (static_cast<size_t>(sample) * count + b) * slices;
            if (beams.all[b].end > 0 && !kept.by_rays_alone[b] && !fill.scene.has_pixel_views(kept.lights[b]))
                find_beam_lengths(fill.scene, fill.grid, fill.tiles, kept.lights[b], where.at, beam_ray(fill, sample),
                                  fill.samples() > 1 ? indices : nullptr, beams.reaches.data() + 16 * b,
                                  beams.inside.data() + first, beams.lit.data() + first);
        }
    }
}

// Rotates points outside a cone into it, at the same distance from the apex: the light's optical depths are known only
// inside.
Vec3s turned_inside(const Light& light, const Vec3s& point) {
    const float cosine = std::cos(0.999f * light.outer_cone), sine = std::sin(0.999f * light.outer_cone);
    const Vec3s offset = point - splat(light.position), axis = splat(light.direction);
    const Floats along = dot(offset, axis), distance = sqrt(dot(offset, offset));
    const Vec3s across = offset - axis * along;
    const Floats wide = sqrt(dot(across, across));
    const Mask16 outside = wide * cosine > along * sine;
    const Vec3s turned = fma(axis, distance * cosine, across * (distance * sine / max(wide, 1e-20f)));
    const Vec3s inside{select(outside, turned.x, offset.x), select(outside, turned.y, offset.y),
                       select(outside, turned.z, offset.z)};
    return inside + splat(light.position);
}

// Fraction of a beam that surfaces let through to the lanes: the lit fraction of the segments inside the beam or, for
// lanes beside it, the visibility of a point inside it.
Floats beam_visibility(const Fill& fill, const PacketBeams& beams, size_t beam, const FroxelLanes& lanes,
                       const Vec3s& point, const Job& job) {
    const FroxelBeams& kept = *fill.pass.beams;
    const size_t index = kept.lights[beam];
    const Light& light = fill.scene.snapshot.lights[index];
    Floats share = 1.0f;
    Mask16 by_rays = lanes.active;
    if (fill.exact()) {
        const size_t slices = static_cast<size_t>(fill.grid.slices());
        const size_t at =
            (static_cast<size_t>(job.sample) * kept.lights.size() + beam) * slices + static_cast<size_t>(job.slice);
        const Floats inside = load(beams.inside[at].length);
        const Mask16 known = inside > 0.0f;
        by_rays = by_rays & !known;
        share = select(known, min(load(beams.lit[at].length) / max(inside, 1e-30f), 1.0f), share);
        share = share * alpha_share(fill, index, lanes, job, known & (share > 0.0f));
    }
    if (!any(by_rays)) return share;
    FroxelLanes within = lanes;
    within.point = point;
    const Vec3s offset = splat(light.position) - point;
    const Floats distance = max(sqrt(dot(offset, offset)), 1e-12f);
    const LightSamples plain{offset * (1.0f / distance), distance, 1.0f};
    return select(by_rays, traced_share(fill, index, within, job, plain, by_rays), share);
}

// Adds a sample's shares to the sums of a slice, with or without fog there: rays interpolate between froxels.
void add_beams(const Fill& fill, PacketBeams& beams, const FroxelLanes& lanes, const Job& job) {
    const FroxelBeams& kept = *fill.pass.beams;
    for (size_t b = 0; b < kept.lights.size(); ++b) {
        if (job.slice < beams.all[b].first || job.slice >= beams.all[b].end || kept.by_rays_alone[b]) continue;
        const size_t index = kept.lights[b];
        const Light& light = fill.scene.snapshot.lights[index];
        const Vec3s point = has_cone(light) ? turned_inside(light, lanes.point) : lanes.point;
        Floats share = fill.scene.has_pixel_views(index) ? alpha_share(fill, index, lanes, job, lanes.active)
                                                         : beam_visibility(fill, beams, b, lanes, point, job);
        const Mask16 some = lanes.active & (share > 0.0f);
        if (!any(some)) continue;
        if (fill.scene.columns[index]) fill_around(*fill.scene.columns[index], point, some);
        const Vec3s offset = point - splat(light.position);
        const Floats near = depth_at_lamp(kept.fog[b], sqrt(dot(offset, offset)));
        share = share * exp(near - light_depth16(kept.grids[b], point, some));
        share = share * style_fade(fill.scene.style, fill.grid.camera, lanes.point);
        store(load(beams.sums[b].data()) + zero_unless(some, share), beams.sums[b].data());
    }
    for (size_t m = 0; m < kept.media; ++m) {
        float* sum = beams.sums[kept.lights.size() + m].data();
        store(load(sum) + load(job.extinction[m]), sum);
    }
}

// Stores the sums of a slice in its froxels. Those behind what a tile sees repeat its last visible one.
void put_beams(const Fill& fill, const Lanes& where, const PacketBeams& beams, int slice) {
    FroxelBeams& kept = *fill.pass.beams;
    const size_t count = kept.lights.size();
    const float share = 1 / static_cast<float>(fill.samples());
    for (size_t i = 0; i < 16; ++i) {
        if (!where.in_grid[i]) continue;
        const bool hidden = is_hidden(fill.grid, fill.tiles, where.tile[i], slice);
        const auto put = [&](float& value, bool first, float sum) {
            value = !hidden ? sum * share : first ? 0 : (&value)[-1];
        };
        for (size_t b = 0; b < count; ++b) {
            const FroxelBeams::Reach& reach = beams.reaches[16 * b + i];
            if (slice < reach.first || slice >= reach.end) continue;
            const size_t index = reach.index + static_cast<size_t>(slice - reach.first);
            put(kept.shares[index], slice == reach.first, beams.sums[b][i]);
        }
        for (size_t m = 0; m < kept.media; ++m)
            put(kept.extinctions[kept.media_index(fill.grid, where.tile[i], m, slice)], slice == 0,
                beams.sums[count + m][i]);
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
