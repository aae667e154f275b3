// The light of a beam on sixteen camera rays: its strength from the rays themselves, what dims it from froxels (see
// base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAM_LOOKUP_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAM_LOOKUP_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAM_LOOKUP_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAM_LOOKUP_SIMD_H
#endif

#include "integrate/equi_angular_simd.h"
#include "integrate/scattering_simd.h"
#include "modes/froxel/near_simd.h"
#include "modes/froxel/place_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Rays as a lamp sees them. Lengths u along them count from where they pass it.
struct RaysByLamp {
    Floats nearest;   // metres from the start of the ray to there
    Floats height2;   // squared distance there
    Floats along, by; // the spot's axis along the ray, and along the way from the lamp to the point next to it
    Floats away;      // height, no less than where 1/r² is capped
};

HWY_INLINE RaysByLamp seen_from(const Light& light, const Vec3s& origin, const Vec3s& direction) {
    RaysByLamp rays;
    const Vec3s to_lamp = splat(light.position) - origin;
    rays.nearest = dot(to_lamp, direction);
    // Rounding leaves it askew, which a narrow beam would show.
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

// The stretch within a radius of the lamp.
HWY_INLINE Interval<Floats> inside_ball(float radius, const RaysByLamp& rays) {
    const Floats half = sqrt(max(Floats(radius * radius) - rays.height2, 0.0f));
    return {-half, half};
}

// The stretch inside a spot's cone, or one around its axis. Seen from the lamp at the angle θ from the point next to
// it, the ray is off the axis by the cosine by·cos θ + along·sin θ = C cos(θ - φ): the cone cuts out the angles around
// φ with C cos(θ - φ) at least the cosine of its edge.
HWY_INLINE Interval<Floats> inside_cone(float half_angle, const RaysByLamp& rays) {
    constexpr float right = 0.5f * pi, far = 1e30f;
    const float edge = std::max(std::cos(half_angle), 1e-6f);
    const Floats c2 = fused(rays.along, rays.along, rays.by * rays.by);
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

// What reaches a length along the rays, as arriving() of trace/light_simd.h.
HWY_INLINE Floats strength_at(const Light& light, const ConeFalloff& cone, const RaysByLamp& rays, const Floats& u,
                              const Floats& distance) {
    const float reach = capped_radius(light);
    const Floats cosine = min(fused(u, rays.along, rays.by * sqrt(rays.height2)) / max(distance, 1e-20f), 1.0f);
    const Floats edge = max(min(fused(cosine, cone.scale, cone.offset), 1.0f), 0.0f);
    Floats amount = (has_cone(light) ? edge * edge : Floats(1.0f)) / max(distance * distance, reach * reach);
    if (!std::isinf(light.range)) {
        const Floats share = distance * (1 / light.range), fourth = (share * share) * (share * share);
        amount = amount * max(min(1.0f - fourth, 1.0f), 0.0f);
    }
    return amount;
}

// Camera rays as beams need them.
struct BeamRays {
    Vec3s origin, direction;
    Floats first, last; // metres along the rays between which they lie in froxels
    Ints own;           // tiles they lie in
};

HWY_INLINE BeamRays beam_rays(const FroxelPicture& picture, const RayBatch& batch, const Places& places) {
    alignas(64) float origin[3][16], direction[3][16];
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = batch.rays[std::min(i, batch.rays.size() - 1)];
        for (int c = 0; c < 3; ++c) origin[c][i] = ray.origin[c], direction[c][i] = ray.direction[c];
    }
    const FroxelGrid& grid = picture.grid;
    BeamRays rays;
    rays.origin = {load(origin[0]), load(origin[1]), load(origin[2])};
    rays.direction = {load(direction[0]), load(direction[1]), load(direction[2])};
    rays.first = max(Floats(grid.faces.front()) - places.start, 0.0f) * places.slant;
    rays.last = (min(places.end, grid.faces.back()) - places.start) * places.slant;
    rays.own = places.own;
    return rays;
}

// Slices that a beam may reach on the rays, and on any of them.
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

// A value of the tiles around the rays, with their weights.
template<class Value> HWY_INLINE Floats between_tiles(const Places& places, const Value& value_of) {
    Floats sum = 0.0f;
    for (int t = 0; t < places.count; ++t) {
        const Floats weight = load(places.weights[t]);
        if (places.together) {
            sum = fused(weight, value_of(static_cast<size_t>(places.tiles[t][0])), sum);
            continue;
        }
        alignas(64) float values[16];
        for (size_t i = 0; i < 16; ++i) values[i] = value_of(static_cast<size_t>(places.tiles[t][i]));
        sum = fused(weight, load(values), sum);
    }
    return sum;
}

// A slice of the froxels around the rays.
struct BeamSlice {
    Floats before, across; // optical depth per metre of slant up to it, and in it
    Floats extinction;     // per metre
    Floats share;          // of the beam's light that arrives
};

// Rays that pass a lamp within a few froxels: so much of the light comes from there that the fog's density has to be
// asked for where it is.
HWY_INLINE Mask16 close_rays(const FroxelGrid& grid, const Light& light, const RaysByLamp& rays,
                             const EquiAngular16& angles) {
    constexpr float near = 4; // froxels
    const float z = std::max(glm::dot(light.position - grid.camera.position, grid.camera.forward), grid.faces.front());
    const float width = static_cast<float>(grid.tile) * (glm::length(grid.origin_x) + z * glm::length(grid.step_x));
    const Floats u = max(max(angles.from, -angles.to), 0.0f) * angles.height;
    return fused(u, u, rays.height2) < near * near * width * width;
}

// A beam on the rays, under way through the slices.
struct BeamWalk {
    const FroxelPicture& picture;
    const Places& places;
    const BeamRays& rays;
    size_t beam;
    const Light& light;
    const ConeFalloff& cone;
    NearLight near;
    RaysByLamp by_lamp;
    Floats depth_before;   // optical, of what lies before the rays' starts
    Floats whole;          // angle of all of the beam on each ray
    Interval<Floats> full; // within a spot's soft edge
};

// Extinction by medium at lengths along the rays.
HWY_INLINE Floats extinction_at(const BeamWalk& walk, const BeamSlice& here, const Mask16& close, size_t medium,
                                int slice, const Floats& u) {
    const FroxelBeams& beams = walk.picture.beams;
    const Medium& of = walk.picture.scene->snapshot.media[medium];
    Floats extinction = here.extinction;
    if (beams.media > 0)
        extinction = extinction * between_tiles(walk.places, [&](size_t tile) {
                         return beams.media_shares[beams.media_place(walk.picture.grid, tile, medium, slice)];
                     });
    if (of.density.kind != DensityKind::bricks || !any(close)) return extinction;
    const Vec3s point = fused(walk.rays.direction, u + walk.by_lamp.nearest, walk.rays.origin);
    return select(close, density16(of, point) * grey_extinction(of.optics), extinction);
}

// Mean of e^-x over a stretch by that in its middle: sinh(d/2) / (d/2) for the depth d of the stretch.
HWY_INLINE Floats mean_over(const Floats& depth) {
    const Floats square = depth * depth;
    return fused(square, fused(square, 1.0f / 1920, 1.0f / 24), 1.0f);
}

// Light of a beam on a stretch of the rays within a slice, by two Gauss points in each of some equal angles seen from
// the lamp: there 1/r² is constant. A beam of few slices is cut finer; a small angle has one point in its middle.
Vec3s light_within(const BeamWalk& walk, const EquiAngular16& angles, int slice, const BeamSlice& here,
                   const Mask16& wanted) {
    constexpr float gauss = 0.2113248654f, pieces = 6; // (1 - 1/√3) / 2
    const FroxelGrid& grid = walk.picture.grid;
    const float low = grid.faces[static_cast<size_t>(slice)],
                thickness = grid.faces[static_cast<size_t>(slice) + 1] - low;
    const Mask16 close = wanted & close_rays(grid, walk.light, walk.by_lamp, angles);
    const Mask16 single = (angles.angle < walk.whole * (0.25f / pieces)) & (angles.angle < 0.2f);
    const Floats cut = min(floor(angles.angle / walk.whole * pieces), pieces - 1) + 1.0f, share = 1.0f / cut;
    // Fog dims the light on its way to the points as it does to the middle of the slice, but for what lies between.
    const float dims = dimming(walk.picture.scene->depths[walk.picture.beams.lights[walk.beam]]);
    const FroxelBeams::LampFog& fog = walk.picture.beams.fog[walk.beam];
    const auto to_lamp = [&](const Floats& distance)
                             HWY_ATTR { return here.extinction * distance * dims - depth_at_lamp(fog, distance); };
    const Floats middle =
        (Floats(low + 0.5f * thickness) - walk.places.start) * walk.places.slant - walk.by_lamp.nearest;
    const Floats to_middle = sqrt(fused(middle, middle, walk.by_lamp.height2));
    const Floats points = select(single, 1.0f, cut * 2.0f), weight = select(single, 1.0f, share * 0.5f);
    Vec3s sum = splat(vec3(0));
    for (int i = 0; i < 2 * static_cast<int>(pieces); ++i) {
        const Mask16 here_too = wanted & (Floats(static_cast<float>(i)) < points);
        if (!any(here_too)) break;
        const float piece = static_cast<float>(i / 2) + (i % 2 ? 1 - gauss : gauss);
        const Floats slope = angles.slope(select(single, 0.5f, share * piece)), u = slope * angles.height;
        const Floats distance = sqrt(fused(u, u, walk.by_lamp.height2));
        const Floats z = (u + walk.by_lamp.nearest) / walk.places.slant + walk.places.start;
        const Floats place = max(min((z - low) * (1 / thickness), 1.0f), 0.0f);
        const Floats depth = fused(here.across, place, here.before) * walk.places.slant - walk.depth_before;
        const Floats length = angles.length(weight, slope);
        const Floats dimmed = max(depth, 0.0f) * walk.picture.view_depth + depth_at_lamp(fog, distance) +
                              (to_lamp(distance) - to_lamp(to_middle));
        const Floats change = here.extinction * length * (walk.picture.view_depth + u / max(distance, 1e-20f) * dims);
        const Floats amount = strength_at(walk.light, walk.cone, walk.by_lamp, u, distance) *
                              near_share(walk.near, distance) * length * exp(-dimmed) * mean_over(change);
        const Vec3s towards =
            scattering(walk.picture.scene->snapshot.media, -u / max(distance, 1e-20f),
                       [&](size_t m) HWY_ATTR { return extinction_at(walk, here, close, m, slice, u); });
        sum = fused(towards, zero_unless(here_too, amount), sum);
    }
    return sum * zero_unless(wanted, here.share);
}

// Adds up what `add` gives for the parts of a stretch before, within and behind another.
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

// The same, cut where light has kinks: where the rays enter and leave the full light of a spot, and the core inside of
// which 1/r² is capped.
Vec3s light_between_kinks(const BeamWalk& walk, const Interval<Floats>& part, int slice, const BeamSlice& here,
                          const Mask16& wanted) {
    const Interval<Floats> core = inside_ball(capped_radius(walk.light), walk.by_lamp);
    return cut_by(walk.full, part, wanted, [&](const Interval<Floats>& outer, const Mask16& some) HWY_ATTR {
        return cut_by(core, outer, some, [&](const Interval<Floats>& one, const Mask16& left) HWY_ATTR {
            return light_within(walk, EquiAngular16(one, walk.by_lamp.away), slice, here, left);
        });
    });
}

// Optical depth per metre of slant up to a face of the slices.
HWY_INLINE Floats depth_to(const BeamWalk& walk, int face) {
    return between_tiles(walk.places,
                         [&](size_t tile) { return walk.picture.sums.at(walk.picture.grid, tile, face)[3]; });
}

// The froxels of a slice around the rays, from the depths to its faces.
BeamSlice slice_around(const BeamWalk& walk, int slice, const Floats& before, const Floats& behind) {
    const FroxelPicture& picture = walk.picture;
    const FroxelGrid& grid = picture.grid;
    const size_t k = static_cast<size_t>(slice);
    BeamSlice here;
    here.before = before;
    here.across = max(behind - here.before, 0.0f);
    here.extinction = here.across * (1 / (grid.faces[k + 1] - grid.faces[k]));
    here.share = between_tiles(walk.places, [&](size_t tile) { return picture.beams.share(tile, walk.beam, slice); });
    return here;
}

// Light of a beam on the rays.
Vec3s beam_light(const FroxelPicture& picture, size_t beam, const BeamRays& rays, const Places& places,
                 const Floats& depth_before) {
    Vec3s sum = splat(vec3(0));
    const RaysReach reach = reach_of(picture.beams, beam, rays.own);
    if (reach.all.end == 0) return sum;
    const size_t index = picture.beams.lights[beam];
    const Light& light = picture.scene->snapshot.lights[index];
    BeamWalk walk{picture,
                  places,
                  rays,
                  beam,
                  light,
                  picture.scene->cones[index],
                  picture.scene->near(index),
                  seen_from(light, rays.origin, rays.direction),
                  depth_before,
                  0.0f,
                  {0.0f, 0.0f}};
    const Floats nearest = walk.by_lamp.nearest;
    const float radius = std::min(light.range, walk.near.radius);
    Interval<Floats> chord = inside_ball(std::min(radius, 1e15f), walk.by_lamp);
    if (has_cone(light)) {
        if (light.inner_cone < light.outer_cone) walk.full = inside_cone(light.inner_cone, walk.by_lamp);
        const Interval<Floats> cone = inside_cone(light.outer_cone, walk.by_lamp);
        chord = {max(chord.low, cone.low), min(chord.high, cone.high)};
    }
    chord.low = max(chord.low, rays.first - nearest), chord.high = min(chord.high, rays.last - nearest);
    const Mask16 met = places.seen & (chord.high > chord.low);
    if (!any(met)) return sum;
    chord.low = zero_unless(met, chord.low), chord.high = zero_unless(met, chord.high);
    walk.whole = max(EquiAngular16(chord, walk.by_lamp.away).angle, 1e-20f);

    const auto length_to = [&](int face) HWY_ATTR {
        return (Floats(picture.grid.faces[static_cast<size_t>(face)]) - places.start) * places.slant - nearest;
    };
    Floats before = 0.0f;
    for (int k = reach.all.first, last = -1; k < reach.all.end; ++k) {
        const float slice = static_cast<float>(k);
        Interval<Floats> part{max(chord.low, length_to(k)), min(chord.high, length_to(k + 1))};
        const Mask16 here = met & (part.high > part.low) & (reach.first <= slice) & (reach.end > slice);
        if (!any(here)) continue;
        part.low = zero_unless(here, part.low), part.high = zero_unless(here, part.high);
        if (last != k) before = depth_to(walk, k);
        const Floats behind = depth_to(walk, last = k + 1);
        const BeamSlice around = slice_around(walk, k, before, behind);
        before = behind;
        const Mask16 lit = here & (around.share * around.across > 0.0f);
        if (any(lit)) sum = sum + light_between_kinks(walk, part, k, around, lit);
    }
    return sum * splat(light.intensity * light.volume_scale);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
