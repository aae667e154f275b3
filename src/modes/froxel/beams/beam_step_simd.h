// Light of a beam on a step of 16 camera rays: its strength is evaluated along the rays, its attenuation comes from
// froxels or, close to the lamp, from the fog itself (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_BEAM_STEP_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_BEAM_STEP_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_BEAM_STEP_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_BEAM_STEP_SIMD_H
#endif

#include "integrate/scattering_simd.h"
#include "modes/froxel/beams/closed_beam_simd.h"
#include "trace/transmittance/light_grid_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
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

// A step in a slice, or all of it, interpolated between the froxels around the rays.
struct BeamStep {
    int slice;
    float low, thickness;  // planar depth, meters
    Floats before, across; // optical depth for a slant of 1, up to the step and in it
    Floats extinction;     // 1/m
    Floats share;          // fraction of the beam's light that arrives
};

// Blends from the froxels' value, for rays that pass the lamp far away, to the ray's own, for rays close to it.
HWY_INLINE Floats nearer(const BeamWalk& walk, const Floats& of_froxels, const Floats& own) {
    return select(walk.close < 1.0f, of_froxels + (own - of_froxels) * walk.close, own);
}

// Extinction of a medium in the froxels of a slice around the rays.
HWY_INLINE Floats mean_extinction(const BeamWalk& walk, const BeamStep& here, size_t medium) {
    const FroxelBeams& beams = walk.froxels.beams;
    if (beams.media == 0) return here.extinction;
    return between_tiles(walk.taps, [&](size_t tile) {
        return beams.extinctions[beams.media_index(walk.froxels.grid, tile, medium, here.slice)];
    });
}

// Extinction of a medium at points of the rays; grids are sampled only for rays close to the lamp.
HWY_INLINE Floats extinction_at(const BeamWalk& walk, const BeamStep& here, size_t medium, const Vec3s& point) {
    const Medium& of = walk.froxels.scene->snapshot.media[medium];
    const bool grid = of.density.kind == DensityKind::bricks;
    if (grid && !any(walk.close > 0.0f)) return mean_extinction(walk, here, medium);
    const Floats exact = density16(of, point) * gray_extinction(of.optics);
    if (!grid || walk.own) return exact;
    const Floats mean = mean_extinction(walk, here, medium);
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

// Light of a beam on a segment of the rays inside a step: two Gauss points in each of several equal angles seen from
// the lamp, in which dt/r² is constant. Their number is proportional to the segment's part of the beam's whole angle; a
// small angle has a single point at its middle.
Vec3s light_within(const BeamWalk& walk, const EquiAngular16& angles, const BeamStep& here, const Mask16& wanted) {
    constexpr float gauss = 0.2113248654f; // (1 - 1/√3) / 2
    const float pieces = walk.light.filter ? filter_pieces : 6;
    const FroxelGrid& grid = walk.froxels.grid;
    const Mask16 close = wanted & (walk.close > 0.0f);
    const bool exact = walk.froxels.beams.exact_shadows[walk.beam] && any(close), own = exact && walk.own;
    const Mask16 single = (angles.angle < walk.whole * (0.25f / pieces)) & (angles.angle < 0.2f);
    const Floats cut = min(floor(angles.angle / walk.whole * pieces), pieces - 1) + 1.0f, share = 1.0f / cut;
    // Grid fog attenuates light to each point as to the middle of the slice, corrected for the fog in between.
    const float scale = light_depth_scale(walk.froxels.scene->depths[walk.froxels.beams.lights[walk.beam]]);
    const FroxelBeams::LampFog& fog = walk.froxels.beams.fog[walk.beam];
    Floats grids = 0.0f; // extinction of grid fog
    for (size_t m = 0; m < walk.froxels.scene->snapshot.media.size() && !own; ++m)
        if (walk.froxels.scene->snapshot.media[m].density.kind == DensityKind::bricks)
            grids = grids + mean_extinction(walk, here, m);
    const size_t slice = static_cast<size_t>(here.slice);
    const float slice_middle = grid.faces[slice] + 0.5f * grid.thickness(slice);
    const Floats middle = (Floats(slice_middle) - walk.taps.start) * walk.taps.slant - walk.by_lamp.nearest;
    const Floats to_middle = sqrt(fma(middle, middle, walk.by_lamp.height2));
    const Floats share_at_middle = here.share * exp(-depth_at_lamp(fog, to_middle));
    const Floats points = select(single, 1.0f, cut * 2.0f), weight = select(single, 1.0f, share * 0.5f);
    Vec3s sum = splat(vec3(0));
    for (int i = 0; i < 2 * static_cast<int>(pieces); ++i) {
        const Mask16 here_too = wanted & (Floats(static_cast<float>(i)) < points);
        if (!any(here_too)) break;
        const float piece = static_cast<float>(i / 2) + (i % 2 ? 1 - gauss : gauss);
        const Floats slope = angles.slope(select(single, 0.5f, share * piece)), u = slope * angles.height;
        const Floats distance = sqrt(fma(u, u, walk.by_lamp.height2));
        const Floats z = (u + walk.by_lamp.nearest) / walk.taps.slant + walk.taps.start;
        const Floats place = max(min((z - here.low) * (1 / here.thickness), 1.0f), 0.0f);
        const Vec3s point = fma(walk.rays.direction, u + walk.by_lamp.nearest, walk.rays.origin);
        const Floats depth = fma(here.across, place, here.before) * walk.taps.slant - walk.depth_before;
        const Floats length = angles.length(weight, slope);
        const Floats depths =
            max(depth, 0.0f) * walk.froxels.view_depth + closed_depth_to_lamp(walk, point, distance) * scale;
        Floats passed = exact ? exact_share(walk, point, close & here_too) : Floats(0.0f);
        if (!own) {
            const Floats mean = share_at_middle * exp((to_middle - distance) * grids * scale);
            passed = exact ? nearer(walk, mean, passed) : mean;
        }
        const Floats change = here.extinction * length * (walk.froxels.view_depth + u / max(distance, 1e-20f) * scale);
        const Floats amount = strength_at(walk.light, walk.cone, walk.by_lamp, u, distance) *
                              near_share(walk.near, distance) * length * passed * exp(-depths) * mean_over(change);
        Vec3s towards = scattering(walk.froxels.scene->snapshot.media, point, -u / max(distance, 1e-20f),
                                   [&](size_t m) HWY_ATTR { return extinction_at(walk, here, m, point); });
        if (walk.light.filter) towards = walk.filtered(towards, point, distance);
        sum = fma(towards, zero_unless(here_too, amount), sum);
    }
    return sum;
}

// The same, split at the light's kinks and for narrow phase lobes.
Vec3s light_between_kinks(const BeamWalk& walk, const Interval<Floats>& part, const BeamStep& here,
                          const Mask16& wanted) {
    return between_kinks(walk, part, wanted, [&](const Interval<Floats>& one, const Mask16& some) HWY_ATTR {
        return between_cuts(walk, one, some, [&](const Interval<Floats>& piece, const Mask16& left) HWY_ATTR {
            return light_within(walk, EquiAngular16(piece, walk.by_lamp.away), here, left);
        });
    });
}
}
}
HWY_AFTER_NAMESPACE();
#endif
