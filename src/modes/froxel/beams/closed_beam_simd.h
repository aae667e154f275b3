// Light of a beam in closed-form fog along 16 camera rays, without look-ups in froxels (see base/simd/simd.h for how
// such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_CLOSED_BEAM_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_CLOSED_BEAM_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_CLOSED_BEAM_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_CLOSED_BEAM_SIMD_H
#endif

#include "integrate/scattering_simd.h"
#include "integrate/style_simd.h"
#include "modes/froxel/beams/beam_rays_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Light on a segment without kinks: two Gauss points in each of several equal angles seen from the lamp, in which dt/r²
// is constant. An angle spans at most 0.3 radians, in cones 0.2, and two optical depths, of the paths to the lamp and
// to the eye.
Vec3s closed_light_within(const BeamWalk& walk, const Interval<Floats>& stretch, const Mask16& wanted) {
    constexpr float gauss = 0.2113248654f; // (1 - 1/√3) / 2
    const float most = walk.light.filter ? 2 * filter_pieces : 24;
    const FroxelScene& scene = *walk.froxels.scene;
    const size_t index = walk.froxels.beams.lights[walk.beam];
    const EquiAngular16 angles(stretch, walk.by_lamp.away);
    const Floats across = closed_depth_before(walk, stretch.high) - closed_depth_before(walk, stretch.low);
    // A spot's soft edge may be narrow, and so may a phase lobe.
    const bool sharp = has_cone(walk.light) || walk.froxels.beams.lobe.count > 0;
    float wide = sharp ? 0.2f : 0.3f;
    const float least = sharp ? 2 : 1;
    if (walk.light.filter) wide = std::min(wide, cone_angle(walk.light) / filter_pieces);
    const Floats pieces = min(floor(max(angles.angle * (1 / wide), across)) + least, most);
    const Mask16 single = (angles.angle < (sharp ? 0.0f : 0.05f)) & (across < 0.1f);
    const Floats points = select(single, 1.0f, pieces * 2.0f), weight = 1.0f / points;
    Vec3s sum = splat(vec3(0));
    for (int i = 0; i < 2 * static_cast<int>(most); ++i) {
        const Mask16 here = wanted & (Floats(static_cast<float>(i)) < points);
        if (!any(here)) break;
        const float piece = static_cast<float>(i / 2) + (i % 2 ? 1 - gauss : gauss);
        const Floats slope = angles.slope(select(single, 0.5f, piece / pieces)), u = slope * angles.height;
        const Floats distance = sqrt(fma(u, u, walk.by_lamp.height2));
        const Vec3s point = fma(walk.rays.direction, u + walk.by_lamp.nearest, walk.rays.origin);
        const Floats depths =
            closed_depth_before(walk, u) * walk.froxels.view_depth + light_depth16(scene.depths[index], point, here);
        const Floats amount = strength_at(walk.light, walk.cone, walk.by_lamp, u, distance) *
                              angles.length(weight, slope) * exp(-depths) *
                              style_fade(scene.style, walk.froxels.grid.camera, point);
        Vec3s towards = scattering(scene.snapshot.media, point, -u / max(distance, 1e-20f), [&](size_t m) HWY_ATTR {
            const Medium& medium = scene.snapshot.media[m];
            return density16(medium, point) * gray_extinction(medium.optics);
        });
        if (walk.light.filter) towards = walk.filtered(towards, point, distance);
        sum = fma(towards, zero_unless(here, amount), sum);
    }
    return sum;
}

// The same, split where rays enter and leave the boxes of the media from `medium` on.
Vec3s closed_light_in_media(const BeamWalk& walk, const Interval<Floats>& stretch, const Mask16& wanted,
                            size_t medium = 0) {
    const std::vector<Medium>& media = walk.froxels.scene->snapshot.media;
    if (medium == media.size()) return closed_light_within(walk, stretch, wanted);
    const Floats &nearest = walk.by_lamp.nearest, from = max(stretch.low + nearest, 0.0f);
    const Segments16 paths{walk.rays.origin, walk.rays.direction, stretch.high + nearest};
    Interval<Floats> box = inside_box(media[medium], paths);
    box = {max(box.low, from) - nearest, box.high - nearest};
    return cut_by(box, stretch, wanted, [&](const Interval<Floats>& part, const Mask16& some) HWY_ATTR {
        return closed_light_in_media(walk, part, some, medium + 1);
    });
}

// Light of a beam on the lit segments of a chord; on all of it if `lit` is null.
Vec3s closed_beam_light(const BeamWalk& walk, const LitIntervals* lit, const Interval<Floats>& chord,
                        const Mask16& met) {
    const auto add = [&](const Interval<Floats>& stretch, const Mask16& some) HWY_ATTR {
        return between_kinks(walk, stretch, some, [&](const Interval<Floats>& part, const Mask16& left) HWY_ATTR {
            return between_cuts(walk, part, left, [&](const Interval<Floats>& piece, const Mask16& here) HWY_ATTR {
                return closed_light_in_media(walk, piece, here);
            });
        });
    };
    if (!lit) return add(chord, met);
    Vec3s sum = splat(vec3(0));
    for (const LitIntervals::Row& row : lit->rows) {
        const Interval<Floats> one{max(chord.low, load(row.low) - walk.by_lamp.nearest),
                                   min(chord.high, load(row.high) - walk.by_lamp.nearest)};
        const Mask16 some = met & (one.high > one.low);
        if (any(some))
            sum = fma(add({zero_unless(some, one.low), zero_unless(some, one.high)}, some),
                      zero_unless(some, load(row.share)), sum);
    }
    return sum;
}
}
}
HWY_AFTER_NAMESPACE();
#endif
