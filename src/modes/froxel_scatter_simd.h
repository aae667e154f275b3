// What sixteen froxels send towards the eye (see base/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_SCATTER_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_SCATTER_SIMD_H
#undef TYNDALL_MODES_FROXEL_SCATTER_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_SCATTER_SIMD_H
#endif

#include "modes/froxel_lit.h"
#include "modes/froxel_look_simd.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// What arrives of a light in each lane, through the surfaces in its way, and where.
struct LaneArrivals {
    Vec3s point;
    Floats amount;
};

// A packet of froxels under way: 16 tiles, one slice, one sample.
struct Job {
    const Lanes& where;
    const Looks& looks;
    int slice, sample;
    const FroxelLit* exact;        // with slices
    const float (*extinction)[16]; // of each medium
};

// Froxels whose size counts beside their distance from a local light. An exact line answers for their depth, and for
// their width where that is a single ray.
Mask16 near_lanes(const Fill& fill, const Light& light, const FroxelLanes& lanes, const Floats& distance) {
    constexpr float near = 4; // beyond, the centre stands for the froxel within 1 %
    if (light.kind == LightKind::sun || (fill.exact() && fill.tiles.rays() == 1)) return Floats(1.0f) < Floats(0.0f);
    const Floats wide2 = lanes.width2 * 4.0f, size2 = fill.exact() ? wide2 : max(lanes.length * lanes.length, wide2);
    return lanes.active & (distance * distance < size2 * (near * near));
}

LaneArrivals arrivals(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    const Arriving plain = arriving(light, fill.scene.cones[index], lanes.point);
    alignas(64) float v[4][16], wanted[16], near[16], traced[16] = {}, visible[16];
    store(lanes.point.x, v[0]), store(lanes.point.y, v[1]), store(lanes.point.z, v[2]), store(plain.amount, v[3]);
    store(select(lit, 1.0f, 0.0f), wanted);
    store(select(near_lanes(fill, light, lanes, plain.distance), 1.0f, 0.0f), near);
    const size_t ray = first_ray(fill, job.sample);
    for (size_t i = 0; i < 16; ++i) {
        if (!(wanted[i] > 0)) continue;
        const bool sliced = job.exact && job.looks.ray[i] == static_cast<int>(ray) && !(near[i] > 0);
        traced[i] = !sliced && !(near[i] > 0) && v[3][i] > 0;
        if (!sliced && !(near[i] > 0)) continue;
        const FroxelArrival one = sliced ? job.exact->at(i, index, job.slice)
                                         : near_arrival(fill.scene, fill.grid, fill.tiles, job.where.at[i], job.slice,
                                                        index, spread_index(fill, job.where.at[i], job.sample));
        v[3][i] = one.amount;
        for (int c = 0; c < 3 && one.amount > 0; ++c) v[c][i] = one.point[c];
    }
    const Mask16 by_rays = load(traced) > 0.0f;
    const Occluders* occluders = fill.scene.snapshot.occluders.get();
    Floats amount = zero_unless(lit, load(v[3]));
    if (light.shadows && occluders && !occluders->empty() && any(by_rays) &&
        fill.scene.settings.visibility != FroxelVisibility::off) {
        Sample2 places[16];
        const bool soft = is_soft(light) && fill.spreads();
        for (size_t i = 0; i < 16 && soft; ++i) {
            const ivec2 at = job.where.at[i];
            const auto block = static_cast<uint32_t>((at.y >> 2) * fill.grid.size.x + (at.x >> 2));
            const uint32_t key = hash(block, static_cast<uint32_t>(job.slice), static_cast<uint32_t>(index));
            places[i] = sample2(spread_index(fill, at, job.sample), key);
        }
        store(visible_at_points(*occluders, light, lanes, plain, by_rays, soft ? places : nullptr), visible);
        amount = select(by_rays, amount * load(visible), amount);
    }
    return {{load(v[0]), load(v[1]), load(v[2])}, amount};
}

// Light of one kind scattered towards the eye, per metre.
Vec3s scattered_from(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    const LaneArrivals arrived = arrivals(fill, index, lanes, lit, job);
    const Mask16 reached = arrived.amount > 0.0f;
    if (!any(reached)) return splat(vec3(0));

    Floats cosine = dot(splat(-light.direction), lanes.toward);
    if (light.kind != LightKind::sun) {
        const Vec3s offset = splat(light.position) - arrived.point;
        cosine = dot(offset, lanes.toward) / max(sqrt(dot(offset, offset)), 1e-12f);
    }
    Vec3s scattering = splat(vec3(0));
    for (size_t m = 0; m < fill.scene.snapshot.media.size(); ++m) {
        const Optics& optics = fill.scene.snapshot.media[m].optics;
        const Floats weight = load(job.extinction[m]) * phase_value(optics.phase, cosine);
        scattering = fused(splat(optics.albedo), weight, scattering);
    }
    const Floats dimmed = exp(-light_depth16(fill.scene.depths[index], arrived.point, reached));
    const Floats amount = zero_unless(reached, arrived.amount * dimmed);
    return scattering * amount * splat(light.intensity * light.volume_scale);
}

// Emission and ambient light, per metre.
Vec3s glow_of(const Snapshot& snapshot, const float (*extinction)[16]) {
    Vec3s glow = splat(vec3(0));
    for (size_t m = 0; m < snapshot.media.size(); ++m) {
        const vec3 each = glow_per_extinction(snapshot.media[m].optics, snapshot.ambient);
        glow = fused(splat(each), load(extinction[m]), glow);
    }
    return glow;
}

Floats faded(const StyleSettings& style, const FroxelGrid& grid, const FroxelLanes& lanes) {
    const Vec3s offset = lanes.point - splat(grid.camera.position);
    const float scale = 1 / (0.2f * style.range);
    return max(min((style.range - sqrt(dot(offset, offset))) * scale, 1.0f), 0.0f);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
