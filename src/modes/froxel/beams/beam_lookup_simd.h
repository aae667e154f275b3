// Light of a beam along 16 camera rays, slice by slice (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#endif

#include "base/simd/reduce_simd.h"
#include "modes/froxel/beams/beam_step_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Slices that a beam may reach, per ray and for any of them.
struct RaysReach {
    Floats first, end;
    FroxelBeams::Reach all;
};
RaysReach reach_of(const FroxelBeams& beams, size_t beam, const Ints& own) {
    alignas(64) int32_t tiles[16];
    alignas(64) float first[16], end[16];
    store(own, tiles);
    FroxelBeams::Reach all{std::numeric_limits<int32_t>::max(), 0};
    for (size_t i = 0; i < 16; ++i) {
        const FroxelBeams::Reach& one = beams.reach(static_cast<size_t>(tiles[i]), beam);
        first[i] = static_cast<float>(one.first), end[i] = static_cast<float>(one.end);
        if (one.end > 0) all = {std::min(all.first, one.first), std::max(all.end, one.end)};
    }
    return {load(first), load(end), all};
}

// Optical depths from the rays' starts to the steps' faces [face · 16 + ray], computed on demand with one density
// sample at the middle of each step.
struct RayDepths {
    std::vector<float> depths;
};
Floats own_depth_to(const BeamWalk& walk, int face, RayDepths& known) {
    const std::vector<float>& faces = walk.froxels.beams.step_faces;
    const auto length_to = [&](size_t k) HWY_ATTR { return max(Floats(faces[k]) - walk.taps.start, 0.0f); };
    if (known.depths.empty()) known.depths.assign(16, 0.0f);
    for (size_t k = known.depths.size() / 16; k <= static_cast<size_t>(face); ++k) {
        const Floats low = length_to(k - 1) * walk.taps.slant, high = length_to(k) * walk.taps.slant;
        const Vec3s point = fma(walk.rays.direction, (low + high) * 0.5f, walk.rays.origin);
        Floats extinction = 0.0f;
        for (const Medium& medium : walk.froxels.scene->snapshot.media)
            extinction = extinction + density16(medium, point) * gray_extinction(medium.optics);
        known.depths.resize(16 * (k + 1));
        store(fma(extinction, high - low, load(&known.depths[16 * (k - 1)])), &known.depths[16 * k]);
    }
    return load(&known.depths[16 * static_cast<size_t>(face)]);
}

// Optical depth up to the face before a slice's step `step` of `steps`, for a slant of 1.
HWY_INLINE Floats depth_to(const BeamWalk& walk, int slice, int step, int steps, RayDepths& known) {
    const auto mean_at = [&](int face) HWY_ATTR {
        return between_tiles(walk.taps,
                             [&](size_t tile) { return walk.froxels.sums.at(walk.froxels.grid, tile, face)[3]; });
    };
    const float share = static_cast<float>(step) / static_cast<float>(steps);
    if (!any(walk.close > 0.0f)) return mean_at(slice + step);
    const int face = walk.froxels.beams.first_step[static_cast<size_t>(slice)] + step;
    const Floats own = (own_depth_to(walk, face, known) + walk.depth_before) / walk.taps.slant;
    if (walk.own) return own;
    Floats mean = mean_at(step < steps ? slice : slice + 1);
    if (0 < step && step < steps) mean = lerp(mean, mean_at(slice + 1), share);
    return nearer(walk, mean, own);
}

// How close rays pass a lamp inside its beam, 0..1: close to it, so much light comes from there that fog is sampled
// along the rays themselves.
Floats proximity(const BeamWalk& walk, const Interval<Floats>& chord, const Mask16& met) {
    const Floats u = max(max(chord.low, -chord.high), 0.0f);
    return zero_unless(met, near_share(walk.around, sqrt(fma(u, u, walk.by_lamp.height2))));
}

// The lit segments of the beam; null if froxels store the lit fraction instead.
const LitIntervals* find_lit_intervals(const BeamWalk& walk, const RayBatch& batch, const Interval<Floats>& chord,
                                       const Mask16& met) {
    const FroxelScene& scene = *walk.froxels.scene;
    const size_t light = walk.froxels.beams.lights[walk.beam];
    if (!scene.has_pixel_views(light)) return nullptr;
    static thread_local LitIntervals lit;
    alignas(64) float low[16], high[16];
    store(zero_unless(met, max(chord.low + walk.by_lamp.nearest, 0.0f)), low);
    store(zero_unless(met, chord.high + walk.by_lamp.nearest), high);
    find_lit_segments(scene.pixel_views[light], walk.light.position, batch, scene.pixel_margin, low, high, lit);
    return &lit;
}

// Light of a beam on the lit segments of a part of the rays inside a step.
Vec3s lit_part(const BeamWalk& walk, const LitIntervals* lit, const Interval<Floats>& part, const BeamStep& here,
               const Mask16& wanted) {
    if (!lit) return light_between_kinks(walk, part, here, wanted);
    Vec3s sum = splat(vec3(0));
    const Floats from = part.low + walk.by_lamp.nearest, to = part.high + walk.by_lamp.nearest;
    const Interval<float> all{least(select(wanted, from, infinity)), most(select(wanted, to, -infinity))};
    for (const LitIntervals::Row& row : lit->rows) {
        if (!(row.all.high > all.low && row.all.low < all.high)) continue;
        Interval<Floats> one{max(part.low, load(row.low) - walk.by_lamp.nearest),
                             min(part.high, load(row.high) - walk.by_lamp.nearest)};
        const Mask16 some = wanted & (one.high > one.low);
        if (!any(some)) continue;
        one = {zero_unless(some, one.low), zero_unless(some, one.high)};
        sum = fma(light_between_kinks(walk, one, here, some), zero_unless(some, load(row.share)), sum);
    }
    return sum;
}

// Light of a beam on a chord of the rays, slice by slice, in steps if the rays sample the fog themselves. Rays that do
// and rays that do not go in two passes, so that none depends on its neighbors.
Vec3s light_in_slices(const BeamWalk& walk, const LitIntervals* lit, const RaysReach& reach,
                      const Interval<Floats>& chord, const Mask16& met, RayDepths& depths) {
    const FroxelBeams& beams = walk.froxels.beams;
    const auto length_to = [&](float z) HWY_ATTR {
        return (Floats(z) - walk.taps.start) * walk.taps.slant - walk.by_lamp.nearest;
    };
    const bool close = any(walk.close > 0.0f);
    Vec3s sum = splat(vec3(0));
    Floats before = 0.0f;
    for (int slice = reach.all.first, last = -1; slice < reach.all.end; ++slice) {
        const size_t k = static_cast<size_t>(slice);
        const float* faces =
            close ? &beams.step_faces[static_cast<size_t>(beams.first_step[k])] : &walk.froxels.grid.faces[k];
        const int steps = close ? beams.steps(k) : 1;
        const float number = static_cast<float>(slice);
        const Mask16 here = met & (reach.first <= number) & (reach.end > number) &
                            (chord.low < length_to(faces[steps])) & (chord.high > length_to(faces[0]));
        if (!any(here)) continue;
        const Floats share = between_tiles(walk.taps, [&](size_t tile) { return beams.share(tile, walk.beam, slice); });
        if (last != slice) before = depth_to(walk, slice, 0, steps, depths);
        last = slice + 1;
        for (int step = 0; step < steps; ++step) {
            const Floats behind = depth_to(walk, slice, step + 1, steps, depths);
            const float thickness = faces[step + 1] - faces[step];
            const Floats across = max(behind - before, 0.0f);
            const BeamStep on{slice, faces[step], thickness, before, across, across * (1 / thickness), share};
            before = behind;
            Interval<Floats> part{max(chord.low, length_to(faces[step])), min(chord.high, length_to(faces[step + 1]))};
            const Mask16 wanted = here & (part.high > part.low) & (share * across > 0.0f);
            if (!any(wanted)) continue;
            part = {zero_unless(wanted, part.low), zero_unless(wanted, part.high)};
            sum = sum + lit_part(walk, lit, part, on, wanted);
        }
    }
    return sum;
}

// Light of a beam along the rays.
Vec3s beam_light(const FroxelBuffer& froxels, size_t beam, const BeamRays& rays, const RayBatch& batch,
                 const FroxelTaps& taps, const Floats& depth_before, RayDepths& depths) {
    Vec3s sum = splat(vec3(0));
    const RaysReach reach = reach_of(froxels.beams, beam, rays.own);
    if (reach.all.end == 0) return sum;
    const size_t index = froxels.beams.lights[beam];
    const Light& light = froxels.scene->snapshot.lights[index];
    BeamWalk walk{froxels,
                  taps,
                  rays,
                  beam,
                  light,
                  froxels.scene->cones[index],
                  froxels.scene->near(index),
                  near_to(froxels.grid, light),
                  seen_from(light, rays.origin, rays.direction),
                  depth_before,
                  0.0f,
                  0.0f,
                  {0.0f, 0.0f}};
    if (light.filter) walk.filter_level = gobo_mip_level(*light.filter, filter_point_angle(light));
    const Floats nearest = walk.by_lamp.nearest;
    const float radius = std::min(light.range, walk.near.radius);
    Interval<Floats> chord = inside_ball(std::min(radius, 1e15f), walk.by_lamp);
    if (has_cone(light)) {
        if (light.inner_cone < light.outer_cone) walk.full = inside_cone(light.inner_cone, walk.by_lamp);
        const Interval<Floats> cone = inside_cone(light.outer_cone, walk.by_lamp);
        chord = {max(chord.low, cone.low), min(chord.high, cone.high)};
    }
    chord.low = max(chord.low, rays.first - nearest), chord.high = min(chord.high, rays.last - nearest);
    const Mask16 met = taps.seen & (chord.high > chord.low);
    if (!any(met)) return sum;
    chord.low = zero_unless(met, chord.low), chord.high = zero_unless(met, chord.high);
    walk.whole = max(EquiAngular16(chord, walk.by_lamp.away).angle, 1e-20f);

    const LitIntervals* lit = find_lit_intervals(walk, batch, chord, met);
    if (lit && lit->rows.empty()) return sum;
    if (froxels.beams.by_rays_alone[beam])
        return closed_beam_light(walk, lit, chord, met) * splat(light.intensity * light.volume_scale);

    walk.close = proximity(walk, chord, met);
    const Mask16 close = met & (walk.close > 0.0f), away = met & !(walk.close > 0.0f);
    walk.own = !any(close & (walk.close < 1.0f));
    if (any(close)) sum = sum + light_in_slices(walk, lit, reach, chord, close, depths);
    walk.close = 0.0f, walk.own = false;
    if (any(away)) sum = sum + light_in_slices(walk, lit, reach, chord, away, depths);
    return sum * splat(light.intensity * light.volume_scale);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
