// Light that 16 froxels send towards the eye (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_FILL_SCATTER_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_FILL_SCATTER_SIMD_H
#undef TYNDALL_MODES_FROXEL_FILL_SCATTER_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_FILL_SCATTER_SIMD_H
#endif

#include "integrate/scattering_simd.h"
#include "integrate/style_simd.h"
#include "modes/froxel/beams/near_simd.h"
#include "modes/froxel/fill/light_injection.h"
#include "modes/froxel/fill/samples_simd.h"
#include "modes/froxel/settings.h"
#include "trace/transmittance/light_grid_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Light that arrives in each lane, with shadows, and the point where it is evaluated.
struct LaneLightSamples {
    Vec3s point;
    Floats amount;
};

// The packet of froxels being filled: 16 tiles, one slice, one sample.
struct Job {
    const Lanes& where;
    const FroxelSamples& points;
    int slice, sample;
    bool sheet;                    // segments are shortened to fog thinner than the slice
    const LightInjection* exact;   // null unless FroxelVisibility::intervals
    const float (*extinction)[16]; // of each medium
    Floats depth;                  // optical depth of the segments, times style.view_depth
};

// Mean position of uniform light as seen through a segment of this optical depth, as a fraction of the segment.
Floats mean_seen_position(const Floats& depth) {
    const Floats square = depth * depth;
    const Floats series = fma(depth, fma(square, fma(square, -1.0f / 30240, 1.0f / 720), -1.0f / 12), 0.5f);
    const Floats large = max(depth, 0.5f);
    return select(depth < 0.5f, series, 1.0f / large - 1.0f / (exp(min(large, 80.0f)) - 1.0f));
}

// Attenuates light inside a slice by the slice's own fog: light near its far end counts less. Light is taken as uniform
// around its mean position, and evaluated where the eye sees it on average. A sun's light extends to the nearer end of
// the slice; a lamp's, which falls as 1/(h² + z²) at a distance h, has an extent with its variance h L / atan(L/h) - h²
// (fitted within 3 %).
void see_through_slice(const Light& light, const FroxelLanes& lanes, const Job& job, const Mask16& which,
                       LaneLightSamples& arrived) {
    constexpr float clear = 0.01f;
    const Mask16 dim = which & (arrived.amount > 0.0f) & (job.depth > clear);
    if (!any(dim)) return;
    const Floats length = max(lanes.length, 1e-30f);
    const Floats mean = max(min(dot(arrived.point - lanes.start, lanes.toward) / length, 1.0f), 0.0f);
    Floats spread = min(mean, 1.0f - mean) * 2.0f;
    if (!is_distant(light)) {
        const Vec3s offset = splat(light.position) - arrived.point;
        const float least = capped_radius(light);
        const Floats ratio = spread * length * 0.5f / max(sqrt(dot(offset, offset)), least);
        spread = spread / sqrt(fma(ratio * (pi / 6), ratio / (ratio + 1.5f), 1.0f));
    }
    const Floats begin = mean - spread * 0.5f, within = job.depth * spread;
    const Floats seen = exp(-(job.depth * begin)) * mean_transmittance(within) / mean_transmittance(job.depth);
    const Floats moved = (mean_seen_position(within) - 0.5f) * spread * lanes.length;
    arrived.amount = select(dim, arrived.amount * seen, arrived.amount);
    arrived.point = fma(lanes.toward, zero_unless(dim, moved), arrived.point);
}

// Froxels that are large relative to their distance from a local light. Exact lines account for their depth, and for
// their width if a tile has a single ray.
Mask16 near_lanes(const Fill& fill, size_t index, const FroxelLanes& lanes, const Floats& distance) {
    const Light& light = fill.scene.snapshot.lights[index];
    constexpr float near = 4; // farther away, the center represents the froxel within 1 %
    if (is_distant(light) || (fill.exact() && fill.tiles.rays() == 1)) return Floats(1.0f) < Floats(0.0f);
    const Floats wide2 = lanes.width2 * 4.0f, size2 = fill.exact() ? wide2 : max(lanes.length * lanes.length, wide2);
    // Closer to the light than `all_near`, rays integrate all of it.
    const Floats all_near = 0.5f * fill.scene.near(index).radius - sqrt(wide2 + lanes.length * lanes.length);
    return lanes.active & (distance * distance < size2 * (near * near)) & (distance > all_near);
}

// Fraction of a light that surfaces let through to the lanes in `by_rays`, by shadow rays.
Floats traced_share(const Fill& fill, size_t index, const FroxelLanes& lanes, const Job& job, const LightSamples& plain,
                    const Mask16& by_rays) {
    const Light& light = fill.scene.snapshot.lights[index];
    const auto& occluders = shadow_casters(light, fill.scene.snapshot);
    if (!occluders) return 1.0f;
    if (fill.scene.settings.visibility == FroxelVisibility::off) return 1.0f;
    Sample2 places[16];
    const bool soft = is_soft(light) && fill.spreads();
    for (size_t i = 0; i < 16 && soft; ++i) {
        const ivec2 at = job.where.at[i];
        const auto block = static_cast<uint32_t>((at.y >> 2) * fill.grid.size.x + (at.x >> 2));
        const uint32_t key = hash(block, static_cast<uint32_t>(job.slice), static_cast<uint32_t>(index));
        places[i] = sample2(spread_index(fill, at, job.sample), key);
    }
    return visible_at_points(*occluders, light, lanes, plain, by_rays, soft ? places : nullptr);
}

// A point in each lane's froxel, and one on a soft light.
struct SpreadPoints {
    FroxelLanes froxels;
    Sample2 of_light[16];
};

// Point `k` of `count` points spread over the fog of the froxels; different in each sample and frame.
SpreadPoints spread_points(const Fill& fill, size_t index, const FroxelLanes& fog, const Job& job, int k, int count) {
    const float froxel = static_cast<float>(fill.grid.tile);
    const int turn = fill.pass.frame * fill.samples() + job.sample;
    const auto number = static_cast<uint32_t>(turn * count + k);
    const bool soft = is_soft(fill.scene.snapshot.lights[index]);
    alignas(64) uint32_t keys[16];
    alignas(64) float u[3][16];
    for (size_t i = 0; i < 16; ++i)
        keys[i] = hash(static_cast<uint32_t>(job.where.tile[i]), static_cast<uint32_t>(job.slice),
                       static_cast<uint32_t>(index));
    for (size_t i = 0; i < 16; ++i) {
        const Sample2 across = sample2(number, keys[i]);
        u[0][i] = (across.x - 0.5f) * froxel, u[1][i] = (across.y - 0.5f) * froxel;
        u[2][i] = random_unit(number, 0, 0, keys[i]);
    }
    SpreadPoints points{fog, {}};
    for (size_t i = 0; i < 16 && soft; ++i) points.of_light[i] = sample2(number, hash(keys[i], 1u));
    const Floats x = load(u[0]), y = load(u[1]);
    Vec3s& point = points.froxels.point;
    point = fma(fog.toward, fog.length * load(u[2]), fog.start);
    point = fma(splat(fill.grid.step_x), x * fog.z, fma(splat(fill.grid.origin_x), x, point));
    point = fma(splat(fill.grid.step_y), y * fog.z, fma(splat(fill.grid.origin_y), y, point));
    return points;
}

// Fraction of a light that surfaces with alpha let through, where intervals account for opaque ones: the mean over
// points spread over the froxels, as a single point would make each leaf as large as a froxel. Points shadowed by
// opaque surfaces do not count. Those that are dark by alpha alone may be shadowed by opaque surfaces too, and are
// weighted by the fraction of the other points that are not.
Floats alpha_share(const Fill& fill, size_t index, const FroxelLanes& lanes, const Job& job, const Mask16& wanted) {
    const Light& light = fill.scene.snapshot.lights[index];
    const auto& occluders = shadow_casters(light, fill.scene.snapshot);
    if (!fill.exact() || !occluders || !occluders->has_alpha() || !any(wanted)) return 1.0f;
    constexpr int points = 8; // over all samples of a froxel
    const int count = std::max(points / fill.samples(), 1);
    const FroxelLanes fog = in_fog(fill.scene.snapshot.media, lanes, job.extinction);
    Floats passed = 0.0f, all = 0.0f, open = 0.0f, shaded = 0.0f;
    for (int k = 0; k < count; ++k) {
        const SpreadPoints at = spread_points(fill, index, fog, job, k, count);
        const LightSamples arrival = arrival16(light, fill.scene.cones[index], at.froxels.point);
        const auto visible = [&](const Mask16& which, Through surfaces) HWY_ATTR {
            return visible_at_points(*occluders, light, at.froxels, arrival, which,
                                     is_soft(light) ? at.of_light : nullptr, surfaces);
        };
        const Floats by_alpha = visible(wanted, Through::alpha), by_all = visible(by_alpha > 0.0f, Through::all);
        passed = passed + by_all, all = all + by_alpha;
        open = open + select(by_all > 0.0f, 1.0f, 0.0f);
        shaded = shaded + select((by_alpha > 0.0f) & (by_all <= 0.0f), 1.0f, 0.0f);
    }
    const float total = static_cast<float>(count);
    const Floats lit = open / max(open + shaded, 1.0f), dark = Floats(total) - open - shaded;
    return select(open > 0.0f, passed / max(open + dark * lit, 1.0f), all * (1.0f / total));
}

// Replaces the light in froxels that are large relative to their distance from the light.
void put_near(const Fill& fill, size_t index, const Job& job, const Mask16& near, LaneLightSamples& arrived) {
    alignas(64) float is_near[16], amount[16], point[3][16];
    store(select(near, 1.0f, 0.0f), is_near), store(arrived.amount, amount);
    store(arrived.point.x, point[0]), store(arrived.point.y, point[1]), store(arrived.point.z, point[2]);
    for (size_t i = 0; i < 16; ++i) {
        if (!(is_near[i] > 0)) continue;
        const FroxelLightSample one = near_arrival(fill.scene, fill.grid, fill.tiles, job.where.at[i], job.slice, index,
                                                   spread_index(fill, job.where.at[i], job.sample));
        amount[i] = one.amount;
        for (int c = 0; c < 3 && one.amount > 0; ++c) point[c][i] = one.point[c];
    }
    arrived = {{load(point[0]), load(point[1]), load(point[2])}, load(amount)};
}

// Evaluates light in the middle of a sheet if its point is outside, or if the sheet fills less than half the slice.
void hold_in_fog(const FroxelLanes& lanes, const FroxelSamples& points, const Mask16& which,
                 LaneLightSamples& arrived) {
    const Floats place = dot(arrived.point - lanes.start, lanes.toward);
    const Floats slice = (load(points.high) - load(points.low)) * sqrt(dot(lanes.step, lanes.step));
    const Mask16 held = which & ((place < 0.0f) | (place > lanes.length) | (lanes.length < slice * 0.5f));
    arrived.point = {select(held, lanes.point.x, arrived.point.x), select(held, lanes.point.y, arrived.point.y),
                     select(held, lanes.point.z, arrived.point.z)};
}

LaneLightSamples arrivals(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    LightSamples plain = arrival16(light, fill.scene.cones[index], lanes.point);
    plain.amount = plain.amount * (1.0f - near_share(fill.scene.near(index), plain.distance));
    LaneLightSamples arrived{lanes.point, zero_unless(lit, plain.amount)};
    const Mask16 near = lit & near_lanes(fill, index, lanes, plain.distance);
    Mask16 by_rays = arrived.amount > 0.0f, along = near; // along: light is known over the whole segment
    by_rays = by_rays & !near;
    if (job.exact) {
        const Mask16 sliced = lit & !near & (load(job.points.first) > 0.0f);
        const size_t at = index * static_cast<size_t>(fill.grid.slices()) + static_cast<size_t>(job.slice);
        by_rays = by_rays & !sliced, along = along | sliced;
        if (is_distant(light)) {
            const LightInjection::Depths& depths = job.exact->depths[at];
            const Floats length = zero_unless(sliced, load(depths.length));
            const Mask16 some = length > 0.0f;
            const Floats low = load(job.points.low), deep = max(load(job.points.high) - low, 1e-30f);
            const Floats z = select(some, load(depths.first) / max(length, 1e-30f), lanes.z);
            arrived.point = fma(lanes.step, z - lanes.z, lanes.point);
            arrived.amount = select(sliced, min(length / deep, 1.0f), arrived.amount);
        } else {
            const LightInjection::Arrivals& exact = job.exact->arrivals[at];
            const Floats amount = load(exact.amount);
            const Mask16 some = sliced & (amount > 0.0f);
            arrived.amount = select(sliced, amount, arrived.amount);
            arrived.point = {select(some, load(exact.point[0]), arrived.point.x),
                             select(some, load(exact.point[1]), arrived.point.y),
                             select(some, load(exact.point[2]), arrived.point.z)};
        }
        if (job.sheet) hold_in_fog(lanes, job.points, sliced, arrived);
        const Mask16 reached = sliced & (arrived.amount > 0.0f);
        arrived.amount =
            select(reached, arrived.amount * alpha_share(fill, index, lanes, job, reached), arrived.amount);
    }
    if (any(near)) put_near(fill, index, job, near, arrived);
    see_through_slice(light, lanes, job, along, arrived);
    if (!any(by_rays)) return arrived;
    const Floats share = traced_share(fill, index, lanes, job, plain, by_rays);
    arrived.amount = select(by_rays, arrived.amount * share, arrived.amount);
    return arrived;
}

// One light's light scattered towards the eye, per meter.
Vec3s scattered_from(const Fill& fill, size_t index, const FroxelLanes& lanes, const Mask16& lit, const Job& job) {
    const Light& light = fill.scene.snapshot.lights[index];
    const LaneLightSamples arrived = arrivals(fill, index, lanes, lit, job);
    const Mask16 reached = arrived.amount > 0.0f;
    if (!any(reached)) return splat(vec3(0));

    Floats cosine = dot(splat(-light.direction), lanes.toward);
    if (!is_distant(light)) {
        const Vec3s offset = splat(light.position) - arrived.point;
        cosine = dot(offset, lanes.toward) / max(sqrt(dot(offset, offset)), 1e-12f);
    }
    if (fill.scene.columns[index]) fill_around(*fill.scene.columns[index], arrived.point, reached);
    const std::vector<Medium>& media =
        is_distant(light) && !fill.scene.sun_media.empty() ? fill.scene.sun_media : fill.scene.snapshot.media;
    const Vec3s towards =
        scattering(media, arrived.point, cosine, [&](size_t m) HWY_ATTR { return load(job.extinction[m]); });
    return scattered_light(light, fill.scene.depths[index], arrived.point, arrived.amount, towards);
}

// Ambient, emitted and multiply scattered light, as far as the pass wants it.
Vec3s other_light(const Fill& fill, const FroxelLanes& lanes, const float (*extinction)[16]) {
    const Snapshot& snapshot = fill.scene.snapshot;
    const FluenceGrid* fluence = fill.scene.fluence.get();
    const auto extinction_of = [&](size_t m) HWY_ATTR { return load(extinction[m]); };
    if (fill.pass.only < 0) return other_source(snapshot, fluence, lanes.point, lanes.toward, extinction_of);
    const size_t part = static_cast<size_t>(fill.pass.only), lights = snapshot.lights.size();
    if (part < lights) return splat(vec3(0));
    return other_source(OtherLight{part - lights}, snapshot, fluence, lanes.point, lanes.toward, extinction_of);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
