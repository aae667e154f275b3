// Spots and point lights along 16 rays, integrated in the angle seen from the light (see base/simd/simd.h for how such
// files are compiled).
#if defined(TYNDALL_MODES_CONE_LOCAL_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_CONE_LOCAL_SIMD_H
#undef TYNDALL_MODES_CONE_LOCAL_SIMD_H
#else
#define TYNDALL_MODES_CONE_LOCAL_SIMD_H
#endif

#include "modes/cone/packet_simd.h"
#include "modes/cone/settings.h"
#include "trace/lights/light_filter_simd.h"
#include "volume/noise/noise.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Spot falloff at 16 angles from its axis.
HWY_INLINE Floats edge(const Packet& packet, const ConeEdges& edges, const Floats& sine2, const Floats& cosine) {
    if (packet.cone.settings.edge == ConeEdge::soft) {
        const Floats angle = angle_of(sqrt(sine2), max(cosine, 0.0f));
        const Floats x = max(min((edges.angle - angle) * edges.soft_scale, 1.0f), 0.0f);
        return x * x * (3.0f - 2.0f * x);
    }
    const Floats versine = sine2 / (1.0f + cosine);
    const Floats x = max(min((edges.versine - versine) * edges.scale, 1.0f), 0.0f);
    return x * x;
}

// Noise factor that drifts upward, 1 on average.
Floats dust(const Cone& cone, const Vec3s& world) {
    const FractalNoise noise{3, cone.settings.noise_size, 2, 0.5f, 77, 0, false};
    Lanes x, y, z, values;
    store(world.x, x.data()), store(world.y - cone.noise_rise, y.data()), store(world.z, z.data());
    fractal_noise(noise, 0, x, y, z, values);
    const Floats swing = max(min(load(values.data()) * 4.0f, 1.0f), -1.0f);
    return fma(swing, cone.settings.noise, 1.0f);
}

// Intensity factor of a local light at s, without the inverse square: range window or linear attenuation, and spot
// falloff.
HWY_INLINE Floats strength(const Packet& packet, const ConeLight& light, const SeenRays& seen, const Floats& s,
                           const Floats& distance, const Floats& inverse) {
    Floats amount = 1.0f;
    if (!std::isinf(light.light.range) && packet.cone.settings.attenuation != ConeAttenuation::linear) {
        const Floats share = distance * (1 / light.light.range), square = share * share;
        amount = max(1.0f - square * square, 0.0f);
    }
    if (packet.cone.settings.attenuation == ConeAttenuation::linear)
        amount = max(1.0f - distance * (1 / light.linear_range), 0.0f);
    if (has_cone(light.light)) {
        const Floats aside = fma(s, seen.axis_out, -(seen.distance * seen.axis_along)) * inverse;
        const Floats cosine = fma(s, seen.axis_along, seen.distance * seen.axis_out) * inverse;
        amount = amount * edge(packet, light.edges, fma(aside, aside, seen.axis_across * seen.axis_across), cosine);
    }
    return amount;
}

// Interval of the rays that a local light reaches, relative to the closest point.
Interval<Floats> reached(const Packet& packet, const ConeLight& light, const SeenRays& seen) {
    Interval<Floats> stretch{packet.stretch.low - seen.nearest, packet.stretch.high - seen.nearest};
    const auto cut = [&](const Interval<Floats>& by) HWY_ATTR {
        stretch = {max(stretch.low, by.low), min(stretch.high, by.high)};
    };
    float range = light.light.range;
    if (packet.cone.settings.attenuation == ConeAttenuation::linear) range = light.linear_range;
    if (!std::isinf(range)) {
        const Floats half = sqrt(max(range * range - seen.squared, 0.0f));
        cut({-half, half});
    }
    if (packet.cone.style.range < no_range) cut({-infinity, packet.cone.style.range - packet.before - seen.nearest});
    if (!has_cone(light.light)) return stretch;
    cut(inside_wedge(seen, light.edges.cosine, light.edges.sine));
    if (light.near_plane > 0) {
        const Floats along = seen.axis_along, start = light.near_plane - seen.distance * seen.axis_out;
        const Mask16 level = abs(along) < 1e-20f;
        const Floats s = start / select(level, 1.0f, along);
        const Floats free = select(start > 0.0f, infinity, -infinity); // rays parallel to the plane: all or nothing
        cut({select(level, free, select(along > 0.0f, s, -infinity)), select(along < 0.0f, s, infinity)});
    }
    return stretch;
}

// Where a ray is much farther from the light than its closest point, a small angle spans many meters, and exponential
// decay looks like an edge in θ. Such segments are split after 1/16, 1/4, 1 and 4 decay lengths.
void add_decay_breaks(const Packet& packet, const SeenRays& seen, const Interval<Floats>& stretch) {
    Floats rate = packet.fog.extinction();
    for (const Medium& medium : packet.fog.media)
        if (medium.density.kind == DensityKind::height)
            rate = rate + abs(packet.direction.y) * (1 / medium.density.height_falloff);
    const Floats scale = 1.0f / max(rate, 1e-20f), behind = max(stretch.low, 0.0f), before = min(stretch.high, 0.0f);
    for (const float share : {1.0f / 16, 0.25f, 1.0f, 4.0f}) {
        const Floats at = behind + share * scale, mirrored = before - share * scale;
        const Mask16 packed = (stretch.high > stretch.low) & (share * scale > seen.distance);
        if (any(packed & (at < stretch.high))) add_break(packet, at);
        // Before the closest point, view and light paths together have a nearly constant length in `direct` fog: no
        // decay.
        if (!packet.fog.direct && any(packed & (mirrored > stretch.low))) add_break(packet, mirrored);
    }
}

// Splits rays at equal angles seen from a filtered light, whose intensity varies throughout.
void add_filter_breaks(const Packet& packet, const SeenRays& seen, const Interval<Floats>& stretch) {
    const Floats away = max(seen.distance, 1e-12f);
    const Floats from = atan(stretch.low / away), to = atan(stretch.high / away);
    for (int i = 1; i < filter_pieces_of_ray; ++i)
        add_break(packet, away * tan(fma(to - from, static_cast<float>(i) / filter_pieces_of_ray, from)));
}

void add_light_breaks(const Packet& packet, const ConeLight& light, const SeenRays& seen,
                      const Interval<Floats>& stretch) {
    add_break(packet, 0.0f);
    if (any(seen.distance < light.reach)) {
        const Floats half = sqrt(max(light.reach * light.reach - seen.squared, 0.0f));
        add_break(packet, half), add_break(packet, -half);
    }
    if (has_cone(light.light) && light.edges.even_sine > 0) {
        const Interval<Floats> even = inside_wedge(seen, light.edges.even_cosine, light.edges.even_sine);
        add_break(packet, even.low), add_break(packet, even.high);
    }
    if (light.light.filter) add_filter_breaks(packet, seen, stretch);
    for (int i = 0; i < packet.cone.lobe.count; ++i) add_break(packet, seen.distance * packet.cone.lobe.slopes[i]);
    add_decay_breaks(packet, seen, stretch);
}

// Transmission of a light's filter in the current channel. Not inlined, to keep the loop of unfiltered lights small.
HWY_NOINLINE Floats filter_factor(const Packet& packet, const ConeLight& light, const Vec3s& point,
                                  const Floats& distance) {
    return filter_channel(*light.light.filter, point * (1.0f / distance), packet.channel, light.filter_level);
}

// Adds a local light's contribution at the nodes of one segment.
void add_piece(const Packet& packet, const ConeLight& light, const SeenRays& seen, const Interval<Floats>& piece,
               int count) {
    const AnglePiece angles(piece, seen);
    const Floats middle = 0.5f * (piece.low + piece.high);
    const Floats length = piece.high - piece.low;
    const Mask16 capped = fma(middle, middle, seen.squared) < light.reach * light.reach;
    const bool has_cap = any(capped),
               inverse_square = packet.cone.settings.attenuation == ConeAttenuation::inverse_square;
    const Floats whole = select(capped, length * (1 / (light.reach * light.reach)), angles.per_distance);
    for (const QuadratureNode& node : gauss_legendre(count)) {
        const float at = static_cast<float>(node.at), weight = static_cast<float>(node.weight);
        Floats s = angles.place(at);
        if (has_cap) s = select(capped, angles.cubic(at), s);
        const Floats square = max(fma(s, s, seen.squared), 1e-30f), inverse = 1.0f / sqrt(square);
        const Floats distance = square * inverse, t = seen.nearest + s;
        const Floats share = has_cap ? select(capped, 3 * at * at * weight, weight) : Floats(weight);
        Floats amount = whole * share * strength(packet, light, seen, s, distance, inverse);
        if (!inverse_square) amount = amount * select(capped, light.reach * light.reach, square);
        const Vec3s point = packet.at(t);
        const Floats depth =
            fma(view_depth(packet, t), packet.cone.style.view_depth, light_depth(packet, light, point, distance));
        amount = amount * exp(-depth) * fade(packet, t);
        if (light.light.filter) amount = amount * filter_factor(packet, light, point, distance);
        if (packet.cone.settings.noise > 0) amount = amount * dust(packet.cone, point + splat(vec3(packet.fog.anchor)));
        add_node(packet, t, amount, -(s * inverse), true);
    }
}

bool add_local(Packet& packet, const ConeLight& light) {
    const SeenRays seen = seen_rays(packet.origin, packet.rest, packet.direction, light.light.direction);
    if (has_cone(light.light)) {
        const Interval<Floats> wedge = inside_wedge(seen, light.edges.cosine, light.edges.sine);
        if (!any((wedge.high > wedge.low) & (wedge.high > -seen.nearest) & (wedge.low < packet.t_max - seen.nearest)))
            return false;
    }
    find_fog(packet);
    Interval<Floats> stretch = reached(packet, light, seen);
    const Mask16 lit = stretch.high > stretch.low;
    if (!any(lit)) return false;
    stretch = {zero_unless(lit, stretch.low), zero_unless(lit, stretch.high)};
    packet.scratch.breaks.clear();
    add_light_breaks(packet, light, seen, stretch);
    add_fog_breaks(packet, seen.nearest);
    sort_breaks(packet, stretch);

    const auto depth_at = [&](const Floats& s) HWY_ATTR {
        const Floats distance = sqrt(fma(s, s, seen.squared)), t = seen.nearest + s;
        return fma(view_depth(packet, t), packet.cone.style.view_depth,
                   light_depth(packet, light, packet.at(t), distance));
    };
    const std::vector<Lanes>& breaks = packet.scratch.breaks;
    Floats before = 0.0f;
    bool known = false;
    for (size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Interval<Floats> piece{load(breaks[i].data()), load(breaks[i + 1].data())};
        const Mask16 there = piece.high > piece.low;
        if (!any(there)) continue;
        if (!known) before = depth_at(piece.low);
        const Floats after = depth_at(piece.high), change = abs(after - before);
        const Mask16 bright = there & (min(before, after) < 60.0f);
        before = after, known = true;
        if (!any(bright)) continue;
        const float share = most(zero_unless(bright, AnglePiece(piece, seen).angle)) * (2 / pi);
        const Floats length = zero_unless(bright, piece.high - piece.low);
        const int count = node_count(packet, share, zero_unless(bright, change), length);
        add_piece(packet, light, seen, piece, light.light.filter ? std::max(count, 8) : count);
    }
    return true;
}
}
}
HWY_AFTER_NAMESPACE();
#endif
