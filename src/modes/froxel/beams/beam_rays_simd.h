// 16 camera rays relative to a lamp, and the intervals that its light reaches (see base/simd/simd.h for how such files
// are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_BEAM_RAYS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_BEAM_RAYS_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_BEAM_RAYS_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_BEAM_RAYS_SIMD_H
#endif

#include "integrate/equi_angular_simd.h"
#include "modes/froxel/beams/beam_shadows.h"
#include "modes/froxel/beams/near_simd.h"
#include "modes/froxel/lookup/place_simd.h"
#include "trace/lights/light_filter_simd.h"
#include "trace/transmittance/light_depth_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Rays relative to a lamp. Lengths u along them are measured from their closest point to the lamp.
struct RaysByLamp {
    Floats nearest;   // meters from the start of the ray to the closest point
    Floats height2;   // squared distance of that point from the lamp
    Floats along, by; // components of the spot's axis along the ray, and from the lamp to the closest point
    Floats away;      // distance of that point, no less than where 1/r² is capped
};

HWY_INLINE RaysByLamp seen_from(const Light& light, const Vec3s& origin, const Vec3s& direction) {
    RaysByLamp rays;
    const Vec3s to_lamp = splat(light.position) - origin;
    rays.nearest = dot(to_lamp, direction);
    // Makes it perpendicular to the ray despite rounding, which would show in a narrow beam.
    const Vec3s askew = direction * rays.nearest - to_lamp;
    const Floats off = dot(askew, direction);
    const Vec3s nearest = askew - direction * off;
    rays.nearest = rays.nearest - off;
    rays.height2 = dot(nearest, nearest);
    rays.along = dot(direction, splat(light.direction));
    rays.by = dot(nearest, splat(light.direction)) / max(sqrt(rays.height2), 1e-20f);
    rays.away = max(sqrt(rays.height2), capped_radius(light));
    return rays;
}

// The interval within a radius of the lamp.
HWY_INLINE Interval<Floats> inside_ball(float radius, const RaysByLamp& rays) {
    const Floats half = sqrt(max(Floats(radius * radius) - rays.height2, 0.0f));
    return {-half, half};
}

// The interval inside a spot's cone, or another cone around its axis. At an angle θ from the closest point, seen from
// the lamp, the ray's cosine to the axis is by·cos θ + along·sin θ = C cos(θ - φ): it is inside the cone at the angles
// around φ where that is at least the cosine of the cone's edge.
HWY_INLINE Interval<Floats> inside_cone(float half_angle, const RaysByLamp& rays) {
    constexpr float right = 0.5f * pi, far = 1e30f;
    const float edge = std::max(std::cos(half_angle), 1e-6f);
    const Floats c2 = fma(rays.along, rays.along, rays.by * rays.by);
    const Mask16 met = c2 > edge * edge;
    const Floats half = atan(sqrt(max(c2 - edge * edge, 0.0f)) * (1 / edge));
    const Floats slope = rays.along / select(abs(rays.by) < 1e-20f, 1e-20f, rays.by);
    const Floats turned = select(rays.along < 0.0f, -pi, pi);
    const Floats middle = atan(slope) + zero_unless(rays.by < 0.0f, turned);
    const Floats from = middle - half, to = middle + half, height = sqrt(rays.height2);
    const auto length = [&](const Floats& angle) HWY_ATTR {
        const Floats inside = height * tan(max(min(angle, right), -right));
        return select(angle >= right, far, select(angle <= -right, -far, inside));
    };
    const Mask16 ahead = met & (from < right) & (to > -right);
    return {select(ahead, length(from), far), select(ahead, length(to), -far)};
}

// Factor on the light's intensity at u, without shadows, as arrival16() of trace/lights/light_simd.h.
HWY_INLINE Floats strength_at(const Light& light, const ConeFalloff& cone, const RaysByLamp& rays, const Floats& u,
                              const Floats& distance) {
    const float reach = capped_radius(light);
    const Floats cosine = min(fma(u, rays.along, rays.by * sqrt(rays.height2)) / max(distance, 1e-20f), 1.0f);
    const Floats edge = max(min(fma(cosine, cone.scale, cone.offset), 1.0f), 0.0f);
    Floats amount = (has_cone(light) ? edge * edge : Floats(1.0f)) / max(distance * distance, reach * reach);
    if (!std::isinf(light.range)) {
        const Floats share = distance * (1 / light.range), fourth = (share * share) * (share * share);
        amount = amount * max(min(1.0f - fourth, 1.0f), 0.0f);
    }
    return amount;
}

// Data of camera rays that beams need.
struct BeamRays {
    Vec3s origin, direction;
    Floats first, last; // interval of the rays inside the froxels, meters
    Ints own;           // tiles that contain them
};

HWY_INLINE BeamRays beam_rays(const FroxelBuffer& froxels, const RayBatch& batch, const FroxelTaps& taps) {
    alignas(64) float origin[3][16], direction[3][16];
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = batch.rays[std::min(i, batch.rays.size() - 1)];
        for (int c = 0; c < 3; ++c) origin[c][i] = ray.origin[c], direction[c][i] = ray.direction[c];
    }
    const FroxelGrid& grid = froxels.grid;
    BeamRays rays;
    rays.origin = {load(origin[0]), load(origin[1]), load(origin[2])};
    rays.direction = {load(direction[0]), load(direction[1]), load(direction[2])};
    rays.first = max(Floats(grid.faces.front()) - taps.start, 0.0f) * taps.slant;
    rays.last = (min(taps.end, grid.faces.back()) - taps.start) * taps.slant;
    rays.own = taps.own;
    return rays;
}

// Integration of one beam along the rays.
struct BeamWalk {
    const FroxelBuffer& froxels;
    const FroxelTaps& taps;
    const BeamRays& rays;
    size_t beam;
    const Light& light;
    const ConeFalloff& cone;
    NearLight near, around; // the part integrated per ray, and the region where rays sample fog themselves
    RaysByLamp by_lamp;
    Floats depth_before;   // optical depth in front of the rays' starts
    Floats whole;          // total angle of the beam on each ray
    Floats close;          // 1 for rays that pass the lamp within a few froxels, falling to 0 farther away
    Interval<Floats> full; // full intensity, inside a spot's soft edge
    bool own = false;      // whether the rays take nothing of the fog from froxels: close is 1 for all that count
    int filter_level = 0;  // mip level that matches the spacing of the points

    // Scattered light times the light's profile and gobo at points of the rays.
    HWY_INLINE Vec3s filtered(const Vec3s& scattered, const Vec3s& point, const Floats& distance) const {
        const LightFilter& filter = *light.filter;
        const Vec3s from_light = (point - splat(light.position)) * (1.0f / max(distance, 1e-20f));
        if (!has_colors(filter)) return scattered * filter_channel(filter, from_light, 0, filter_level);
        return scattered * filter_tint(filter, from_light, filter_level) *
               filter_strength(filter, from_light, filter_level);
    }
};

// Sums add(part, mask) over the parts of an interval before, within and behind another.
template<class Add>
HWY_INLINE Vec3s cut_by(const Interval<Floats>& within, const Interval<Floats>& part, const Mask16& wanted,
                        const Add& add) {
    constexpr float far = 1e30f;
    const Mask16 cut = wanted & (within.high > within.low) & (part.low < within.high) & (part.high > within.low);
    const Floats enter = select(cut, within.low, far), leave = select(cut, within.high, far);
    const Interval<Floats> parts[] = {{part.low, min(part.high, enter)},
                                      {max(part.low, enter), min(part.high, leave)},
                                      {max(part.low, leave), part.high}};
    Vec3s sum = splat(vec3(0));
    for (const Interval<Floats>& one : parts) {
        const Mask16 some = wanted & (one.high > one.low);
        if (any(some)) sum = sum + add({zero_unless(some, one.low), zero_unless(some, one.high)}, some);
    }
    return sum;
}

// Sums add(part, mask) over the parts of an interval between the kinks of the light: where rays enter and leave the
// full intensity of a spot, and the core inside which 1/r² is capped.
template<class Add>
HWY_INLINE Vec3s between_kinks(const BeamWalk& walk, const Interval<Floats>& part, const Mask16& wanted,
                               const Add& add) {
    const Interval<Floats> core = inside_ball(capped_radius(walk.light), walk.by_lamp);
    return cut_by(walk.full, part, wanted, [&](const Interval<Floats>& outer, const Mask16& some) HWY_ATTR {
        return cut_by(core, outer, some, add);
    });
}

// Sums add(part, mask) over the parts of an interval between the cuts for narrow phase lobes.
template<class Add>
HWY_INLINE Vec3s between_cuts(const BeamWalk& walk, const Interval<Floats>& part, const Mask16& wanted,
                              const Add& add) {
    const LobeCuts& cuts = walk.froxels.beams.lobe;
    if (cuts.count == 0) return add(part, wanted);
    Vec3s sum = splat(vec3(0));
    Floats low = part.low;
    for (int i = 0; i <= cuts.count; ++i) {
        const Floats cut = i < cuts.count ? walk.by_lamp.away * cuts.slopes[i] : part.high;
        const Floats high = max(min(cut, part.high), low);
        const Mask16 some = wanted & (high > low);
        if (any(some)) sum = sum + add(Interval<Floats>{zero_unless(some, low), zero_unless(some, high)}, some);
        low = high;
    }
    return sum;
}

// Optical depth of closed-form fog from points to the lamp.
HWY_INLINE Floats closed_depth_to_lamp(const BeamWalk& walk, const Vec3s& point, const Floats& distance) {
    Floats sum = 0.0f;
    const Vec3s towards = splat(walk.light.position) - point;
    const Segments16 paths{point, towards * (1.0f / max(distance, 1e-12f)), max(distance - walk.light.radius, 0.0f)};
    for (const Medium& medium : walk.froxels.scene->depths[walk.froxels.beams.lights[walk.beam]].analytic)
        sum = sum + analytic_depth16(medium, paths);
    return sum;
}

// Optical depth of such fog from the rays' starts to u.
HWY_INLINE Floats closed_depth_before(const BeamWalk& walk, const Floats& u) {
    Floats sum = 0.0f;
    const Segments16 paths{walk.rays.origin, walk.rays.direction, max(u + walk.by_lamp.nearest, 0.0f)};
    for (const Medium& medium : walk.froxels.scene->snapshot.media) sum = sum + analytic_depth16(medium, paths);
    return sum;
}

}
}
HWY_AFTER_NAMESPACE();
#endif
