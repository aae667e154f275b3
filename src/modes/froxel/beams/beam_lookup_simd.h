// Light of a beam along 16 camera rays: its strength is evaluated along the rays, its attenuation comes from froxels
// (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_BEAM_LOOKUP_SIMD_H
#endif

#include "base/simd/reduce_simd.h"
#include "integrate/scattering_simd.h"
#include "modes/froxel/beams/closed_beam_simd.h"
#include "trace/transmittance/light_grid_simd.h"

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

// Interpolates a per-tile value between the tiles around the rays.
template<class Value> HWY_INLINE Floats between_tiles(const FroxelTaps& taps, const Value& value_of) {
    Floats sum = 0.0f;
    for (int t = 0; t < taps.count; ++t) {
        const Floats weight = load(taps.weights[t]);
        if (taps.together) {
            sum = fma(weight, value_of(static_cast<size_t>(taps.tiles[t][0])), sum);
            continue;
        }
        alignas(64) float values[16];
        for (size_t i = 0; i < 16; ++i) values[i] = value_of(static_cast<size_t>(taps.tiles[t][i]));
        sum = fma(weight, load(values), sum);
    }
    return sum;
}

// One slice, interpolated between the froxels around the rays.
struct BeamSlice {
    Floats before, across; // optical depth for a slant of 1, up to the slice and in it
    Floats extinction;     // 1/m
    Floats share;          // fraction of the beam's light that arrives
};

// Blends from the froxels' value, for rays that pass the lamp far away, to the ray's own, for rays close to it.
HWY_INLINE Floats nearer(const BeamWalk& walk, const Floats& of_froxels, const Floats& own) {
    return select(walk.close < 1.0f, of_froxels + (own - of_froxels) * walk.close, own);
}

// Extinction of a medium in the froxels of a slice around the rays.
HWY_INLINE Floats mean_extinction(const BeamWalk& walk, const BeamSlice& here, size_t medium, int slice) {
    const FroxelBeams& beams = walk.froxels.beams;
    if (beams.media == 0) return here.extinction;
    return here.extinction * between_tiles(walk.taps, [&](size_t tile) {
               return beams.media_shares[beams.media_index(walk.froxels.grid, tile, medium, slice)];
           });
}

// Extinction of a medium at points of the rays; grids are sampled only for rays close to the lamp.
HWY_INLINE Floats extinction_at(const BeamWalk& walk, const BeamSlice& here, size_t medium, int slice,
                                const Vec3s& point) {
    const Medium& of = walk.froxels.scene->snapshot.media[medium];
    const bool grid = of.density.kind == DensityKind::bricks;
    if (grid && !any(walk.close > 0.0f)) return mean_extinction(walk, here, medium, slice);
    const Floats exact = density16(of, point) * gray_extinction(of.optics);
    if (!grid || !any(walk.close < 1.0f)) return exact;
    const Floats mean = mean_extinction(walk, here, medium, slice);
    return nearer(walk, mean, exact);
}

// Fraction of a beam's light that grid fog and the style's fade let through to points of the rays, for rays close to
// the lamp.
HWY_INLINE Floats exact_share(const BeamWalk& walk, const Vec3s& point, const Mask16& wanted) {
    const FroxelScene& scene = *walk.froxels.scene;
    const auto& columns = scene.columns[walk.froxels.beams.lights[walk.beam]];
    if (columns) fill_around(*columns, point, wanted);
    return exp(-light_depth16(walk.froxels.beams.grids[walk.beam], point, wanted)) *
           style_fade(scene.style, walk.froxels.grid.camera, point);
}

// Mean of e^-x over a segment of optical depth d, relative to its value at the middle: sinh(d/2) / (d/2), as a series.
HWY_INLINE Floats mean_over(const Floats& depth) {
    const Floats square = depth * depth;
    return fma(square, fma(square, 1.0f / 1920, 1.0f / 24), 1.0f);
}

// Light of a beam on a segment of the rays inside a slice: two Gauss points in each of several equal angles seen from
// the lamp, in which dt/r² is constant. Their number is proportional to the segment's part of the beam's whole angle; a
// small angle has a single point at its middle.
Vec3s light_within(const BeamWalk& walk, const EquiAngular16& angles, int slice, const BeamSlice& here,
                   const Mask16& wanted) {
    constexpr float gauss = 0.2113248654f; // (1 - 1/√3) / 2
    const float pieces = walk.light.filter ? filter_pieces : 6;
    const FroxelGrid& grid = walk.froxels.grid;
    const float low = grid.faces[static_cast<size_t>(slice)],
                thickness = grid.faces[static_cast<size_t>(slice) + 1] - low;
    const Mask16 close = wanted & (walk.close > 0.0f);
    const bool exact = walk.froxels.beams.exact_shadows[walk.beam] && any(close);
    const Mask16 single = (angles.angle < walk.whole * (0.25f / pieces)) & (angles.angle < 0.2f);
    const Floats cut = min(floor(angles.angle / walk.whole * pieces), pieces - 1) + 1.0f, share = 1.0f / cut;
    // Grid fog attenuates light to each point as to the middle of the slice, corrected for the fog in between.
    const float dims = dimming(walk.froxels.scene->depths[walk.froxels.beams.lights[walk.beam]]);
    const FroxelBeams::LampFog& fog = walk.froxels.beams.fog[walk.beam];
    Floats grids = 0.0f; // extinction of grid fog
    for (size_t m = 0; m < walk.froxels.scene->snapshot.media.size(); ++m)
        if (walk.froxels.scene->snapshot.media[m].density.kind == DensityKind::bricks)
            grids = grids + mean_extinction(walk, here, m, slice);
    const auto to_lamp = [&](const Floats& distance)
                             HWY_ATTR { return grids * distance * dims - depth_at_lamp(fog, distance); };
    const Floats middle = (Floats(low + 0.5f * thickness) - walk.taps.start) * walk.taps.slant - walk.by_lamp.nearest;
    const Floats to_middle = sqrt(fma(middle, middle, walk.by_lamp.height2));
    const Floats points = select(single, 1.0f, cut * 2.0f), weight = select(single, 1.0f, share * 0.5f);
    Vec3s sum = splat(vec3(0));
    for (int i = 0; i < 2 * static_cast<int>(pieces); ++i) {
        const Mask16 here_too = wanted & (Floats(static_cast<float>(i)) < points);
        if (!any(here_too)) break;
        const float piece = static_cast<float>(i / 2) + (i % 2 ? 1 - gauss : gauss);
        const Floats slope = angles.slope(select(single, 0.5f, share * piece)), u = slope * angles.height;
        const Floats distance = sqrt(fma(u, u, walk.by_lamp.height2));
        const Floats z = (u + walk.by_lamp.nearest) / walk.taps.slant + walk.taps.start;
        const Floats place = max(min((z - low) * (1 / thickness), 1.0f), 0.0f);
        const Vec3s point = fma(walk.rays.direction, u + walk.by_lamp.nearest, walk.rays.origin);
        const Floats depth = fma(here.across, place, here.before) * walk.taps.slant - walk.depth_before;
        const Floats length = angles.length(weight, slope);
        const Floats dimmed =
            max(depth, 0.0f) * walk.froxels.view_depth + closed_depth_to_lamp(walk, point, distance) * dims;
        Floats passed = here.share * exp(to_lamp(to_middle) - to_lamp(distance) - depth_at_lamp(fog, distance));
        if (exact) passed = nearer(walk, passed, exact_share(walk, point, close & here_too));
        const Floats change = here.extinction * length * (walk.froxels.view_depth + u / max(distance, 1e-20f) * dims);
        const Floats amount = strength_at(walk.light, walk.cone, walk.by_lamp, u, distance) *
                              near_share(walk.near, distance) * length * passed * exp(-dimmed) * mean_over(change);
        Vec3s towards = scattering(walk.froxels.scene->snapshot.media, point, -u / max(distance, 1e-20f),
                                   [&](size_t m) HWY_ATTR { return extinction_at(walk, here, m, slice, point); });
        if (walk.light.filter) towards = walk.filtered(towards, point, distance);
        sum = fma(towards, zero_unless(here_too, amount), sum);
    }
    return sum;
}

// The same, split at the light's kinks and for narrow phase lobes.
Vec3s light_between_kinks(const BeamWalk& walk, const Interval<Floats>& part, int slice, const BeamSlice& here,
                          const Mask16& wanted) {
    return between_kinks(walk, part, wanted, [&](const Interval<Floats>& one, const Mask16& some) HWY_ATTR {
        return between_cuts(walk, one, some, [&](const Interval<Floats>& piece, const Mask16& left) HWY_ATTR {
            return light_within(walk, EquiAngular16(piece, walk.by_lamp.away), slice, here, left);
        });
    });
}

// Optical depths from the rays' starts to the slice faces [face · 16 + ray], computed on demand with one density sample
// at the middle of each slice.
struct RayDepths {
    std::vector<float> depths;
};
Floats own_depth_to(const BeamWalk& walk, int face, RayDepths& known) {
    const FroxelGrid& grid = walk.froxels.grid;
    const auto length_to = [&](size_t k) HWY_ATTR { return max(Floats(grid.faces[k]) - walk.taps.start, 0.0f); };
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

// Optical depth up to a slice face, for a slant of 1.
HWY_INLINE Floats depth_to(const BeamWalk& walk, int face, RayDepths& known) {
    const Floats mean =
        between_tiles(walk.taps, [&](size_t tile) { return walk.froxels.sums.at(walk.froxels.grid, tile, face)[3]; });
    if (!any(walk.close > 0.0f)) return mean;
    const Floats own = (own_depth_to(walk, face, known) + walk.depth_before) / walk.taps.slant;
    return nearer(walk, mean, own);
}

// How close rays pass a lamp inside its beam, 0..1: close to it, so much light comes from there that fog is sampled
// along the rays themselves.
Floats proximity(const BeamWalk& walk, const Interval<Floats>& chord, const Mask16& met) {
    const Floats u = max(max(chord.low, -chord.high), 0.0f);
    return zero_unless(met, near_share(walk.around, sqrt(fma(u, u, walk.by_lamp.height2))));
}

// Interpolates a slice between the froxels around the rays, given the depths at its faces.
BeamSlice slice_around(const BeamWalk& walk, int slice, const Floats& before, const Floats& behind) {
    const FroxelBuffer& froxels = walk.froxels;
    const FroxelGrid& grid = froxels.grid;
    const size_t k = static_cast<size_t>(slice);
    BeamSlice here;
    here.before = before;
    here.across = max(behind - here.before, 0.0f);
    here.extinction = here.across * (1 / grid.thickness(k));
    here.share = between_tiles(walk.taps, [&](size_t tile) { return froxels.beams.share(tile, walk.beam, slice); });
    return here;
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
    find_beam_lit(scene.pixel_views[light], walk.light.position, batch, scene.pixel_margin, low, high, lit);
    return &lit;
}

// Light of a beam on the lit segments of a part of the rays inside a slice.
Vec3s lit_part(const BeamWalk& walk, const LitIntervals* lit, const Interval<Floats>& part, int slice,
               const BeamSlice& here, const Mask16& wanted) {
    if (!lit) return light_between_kinks(walk, part, slice, here, wanted);
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
        sum = fma(light_between_kinks(walk, one, slice, here, some), zero_unless(some, load(row.share)), sum);
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
    const auto length_to = [&](int face) HWY_ATTR {
        return (Floats(froxels.grid.faces[static_cast<size_t>(face)]) - taps.start) * taps.slant - nearest;
    };
    Floats before = 0.0f;
    for (int k = reach.all.first, last = -1; k < reach.all.end; ++k) {
        const float slice = static_cast<float>(k);
        Interval<Floats> part{max(chord.low, length_to(k)), min(chord.high, length_to(k + 1))};
        const Mask16 here = met & (part.high > part.low) & (reach.first <= slice) & (reach.end > slice);
        if (!any(here)) continue;
        part.low = zero_unless(here, part.low), part.high = zero_unless(here, part.high);
        if (last != k) before = depth_to(walk, k, depths);
        const Floats behind = depth_to(walk, last = k + 1, depths);
        const BeamSlice around = slice_around(walk, k, before, behind);
        before = behind;
        const Mask16 reached = here & (around.share * around.across > 0.0f);
        if (any(reached)) sum = sum + lit_part(walk, lit, part, k, around, reached);
    }
    return sum * splat(light.intensity * light.volume_scale);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
