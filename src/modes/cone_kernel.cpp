#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/cone_kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/cone.h"

#include "base/simd.h"
#include "modes/batch_simd.h"
#include "modes/cone_simd.h"
#include "modes/gauss_legendre.h"
#include "trace/light_depth_simd.h"
#include "volume/noise.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
using Lanes = std::array<float, 16>;
constexpr float no_range = 1e6f; // of the style: the fog's light goes on for ever

// Memory that a thread keeps from packet to packet. Plain floats: containers know nothing of vector registers.
struct Scratch {
    std::vector<Lanes> from, to; // where the rays enter and leave each medium
    std::vector<Lanes> sums;     // per medium: its share of the light
    std::vector<Lanes> breaks;   // where the integrand has a kink
    Lanes shares;                // of optical depth, for statistics
};

// The rays among the fog of one light.
struct Packet {
    const Cone& cone;
    const AnchoredFog& fog;
    Vec3s origin, direction; // from the fog's anchor
    Vec3s rest;              // of the origin, what floats lose
    Floats t_max, before;    // length, and the way from the eye to the origin
    Scratch& scratch;
    Stretch16 stretch; // from first to last fog

    HWY_INLINE size_t media() const { return fog.media.size(); }
    HWY_INLINE Vec3s at(const Floats& t) const { return fused(direction, t, origin); }
};

Packet make_packet(const Cone& cone, const AnchoredFog& fog, const RayBatch& batch, Scratch& scratch) {
    alignas(64) float v[11][16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        const dvec3 exact = dvec3(ray.origin) - fog.anchor;
        const vec3 from(exact), rest(exact - dvec3(from));
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = from[axis], v[3 + axis][lane] = ray.direction[axis];
        for (int axis = 0; axis < 3; ++axis) v[8 + axis][lane] = rest[axis];
        v[6][lane] = lane < batch.rays.size() ? ray.t_max : 0;
        v[7][lane] = glm::dot(ray.origin - cone.eye, ray.direction);
    }
    return {cone,
            fog,
            {load(v[0]), load(v[1]), load(v[2])},
            {load(v[3]), load(v[4]), load(v[5])},
            {load(v[8]), load(v[9]), load(v[10])},
            load(v[6]),
            max(load(v[7]), 0.0f),
            scratch,
            {0.0f, 0.0f}};
}

void find_fog(Packet& packet) {
    Scratch& scratch = packet.scratch;
    packet.stretch = {infinity, 0.0f};
    for (size_t m = 0; m < packet.media(); ++m) {
        const Ranges inside = inside_box(packet.fog.media[m], {packet.origin, packet.direction, packet.t_max});
        const Floats to = max(inside.high, inside.low);
        const Mask16 any_fog = to > inside.low;
        store(inside.low, scratch.from[m].data()), store(to, scratch.to[m].data());
        packet.stretch.low = select(any_fog, min(packet.stretch.low, inside.low), packet.stretch.low);
        packet.stretch.high = select(any_fog, max(packet.stretch.high, to), packet.stretch.high);
    }
}

// Optical depth from the rays' origin to t.
HWY_INLINE Floats view_depth(const Packet& packet, const Floats& t) {
    Floats sum = 0.0f;
    for (size_t m = 0; m < packet.media(); ++m) {
        const Medium& medium = packet.fog.media[m];
        const Floats from = load(packet.scratch.from[m].data());
        const Floats to = min(t, load(packet.scratch.to[m].data()));
        Floats depth = max(to - from, 0.0f) * medium.optics.extinction;
        if (medium.kind == DensityKind::height) {
            const Floats y0 = fused(packet.direction.y, from, packet.origin.y);
            const Floats y1 = fused(packet.direction.y, to, packet.origin.y);
            depth = zero_unless(depth > 0.0f, depth * mean_height_density(medium, y0, y1));
        }
        sum = sum + depth;
    }
    return sum;
}

// Extinction of a medium at t, inside a piece that no border of it divides.
HWY_INLINE Floats extinction(const Packet& packet, size_t m, const Floats& t) {
    const Medium& medium = packet.fog.media[m];
    const Mask16 inside = (t >= load(packet.scratch.from[m].data())) & (t <= load(packet.scratch.to[m].data()));
    Floats value = medium.optics.extinction;
    if (medium.kind == DensityKind::height) {
        const Floats height = max(fused(packet.direction.y, t, packet.origin.y) - medium.height_base, 0.0f);
        value = value * exp(height * (-1 / medium.height_falloff));
    }
    return packet.media() == 1 ? value : zero_unless(inside, value);
}

HWY_INLINE Floats light_depth(const Packet& packet, const ConeLight& light, const Vec3s& point,
                              const Floats& distance) {
    const bool sun = light.light.kind == LightKind::sun;
    const Floats length = sun ? Floats(sun_distance) : max(distance - light.light.radius, 0.0f);
    const float scale = packet.cone.style.light_depth;
    if (packet.fog.direct) return length * (packet.fog.extinction() * scale);
    const Vec3s towards = sun ? splat(-light.light.direction) : point * (-1.0f / max(distance, 1e-12f));
    Floats sum = 0.0f;
    for (const Medium& medium : packet.fog.media) sum = sum + analytic_depth16(medium, {point, towards, length});
    return sum * scale;
}

// Share of the fog's light that style.range leaves.
HWY_INLINE Floats fade(const Packet& packet, const Floats& t) {
    const float range = packet.cone.style.range;
    if (range >= no_range) return 1.0f;
    return max(min((range - (t + packet.before)) * (1 / (0.2f * range)), 1.0f), 0.0f);
}

// Adds `amount` of light from a place to the sums of the media there. Without a light: of emission and ambient light.
HWY_INLINE void add_node(const Packet& packet, const Floats& t, const Floats& amount, const Floats& cosine,
                         bool has_light) {
    for (size_t m = 0; m < packet.media(); ++m) {
        const Phase phase = packet.fog.media[m].optics.phase;
        Floats value = amount * extinction(packet, m, t);
        if (has_light) value = value * phase_value(phase, cosine);
        float* sum = packet.scratch.sums[m].data();
        store(load(sum) + value, sum);
    }
}

void add_break(const Packet& packet, const Floats& t) {
    Lanes& lanes = packet.scratch.breaks.emplace_back();
    store(t, lanes.data());
}

// Ends of media, kinks of height fog and of the ways to the light, and the fade of the style; `start` = t of the
// coordinate's zero.
void add_fog_breaks(const Packet& packet, const Floats& start) {
    for (size_t m = 0; packet.media() > 1 && m < packet.media(); ++m) {
        add_break(packet, load(packet.scratch.from[m].data()) - start);
        add_break(packet, load(packet.scratch.to[m].data()) - start);
    }
    for (const vec4& plane : packet.fog.kinks) {
        const Floats slope = dot(packet.direction, splat(vec3(plane)));
        const Mask16 level = abs(slope) < 1e-20f;
        const Floats t = -(dot(packet.origin, splat(vec3(plane))) + plane.w) / select(level, 1.0f, slope);
        add_break(packet, select(level, infinity, t - start));
    }
    if (packet.cone.style.range < no_range) add_break(packet, 0.8f * packet.cone.style.range - packet.before - start);
}

// Brings the breaks into ascending order in every lane and into the stretch, whose ends join them.
void sort_breaks(const Packet& packet, const Stretch16& stretch) {
    std::vector<Lanes>& breaks = packet.scratch.breaks;
    add_break(packet, stretch.low), add_break(packet, stretch.high);
    const size_t count = breaks.size();
    for (size_t i = 0; i < count; ++i)
        store(max(min(load(breaks[i].data()), stretch.high), stretch.low), breaks[i].data());
    for (size_t end = count; end > 1; --end)
        for (size_t i = 0; i + 1 < end; ++i) {
            const Floats a = load(breaks[i].data()), b = load(breaks[i + 1].data());
            store(min(a, b), breaks[i].data()), store(max(a, b), breaks[i + 1].data());
        }
}

// How many nodes a piece needs: the more, the wider its angle and the more its optical depth and density change.
int node_count(const Packet& packet, float share, const Floats& change, const Floats& length) {
    Floats amount = change;
    float narrowest = 1;
    for (const Medium& medium : packet.fog.media) {
        if (medium.kind == DensityKind::height)
            amount = amount + min(abs(packet.direction.y) * length * (1 / medium.height_falloff), 30.0f);
        const float g = medium.optics.phase.kind == PhaseKind::isotropic ? 0 : std::abs(medium.optics.phase.g);
        narrowest = std::min(narrowest, 1 - std::min(g, largest_g));
    }
    const float nodes = static_cast<float>(packet.cone.settings.nodes), lobe = std::max(0.4f / narrowest, 1.0f);
    const float change_at_most = std::min(highest(amount), 60.0f);
    const float wanted = 7 + (nodes - 2) * (2 * share * lobe + change_at_most * 0.16f);
    return std::clamp(static_cast<int>(wanted), 2, most_gauss_nodes);
}

// Strength of a spot at sixteen angles from its axis.
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

// Noise that rises through the light, 1 on average.
Floats dust(const Cone& cone, const Vec3s& world) {
    const FractalNoise noise{3, cone.settings.noise_size, 2, 0.5f, 77, 0, false};
    Lanes x, y, z, values;
    store(world.x, x.data()), store(world.y - cone.noise_rise, y.data()), store(world.z, z.data());
    fractal_noise(noise, 0, x, y, z, values);
    const Floats swing = max(min(load(values.data()) * 4.0f, 1.0f), -1.0f);
    return fused(swing, cone.settings.noise, 1.0f);
}

// What a local light sends to s, less the inverse square: window and edge, and r² where the attenuation is another.
HWY_INLINE Floats strength(const Packet& packet, const ConeLight& light, const SeenRays& seen, const Floats& s,
                           const Floats& distance, const Floats& inverse) {
    Floats amount = 1.0f;
    if (!std::isinf(light.light.range) && packet.cone.settings.attenuation != ConeAttenuation::linear) {
        const Floats share = distance * (1 / light.light.range), square = share * share;
        amount = max(1.0f - square * square, 0.0f);
    }
    if (packet.cone.settings.attenuation == ConeAttenuation::linear)
        amount = max(1.0f - distance * (1 / light.linear_range), 0.0f);
    if (light.light.kind == LightKind::spot) {
        const Floats aside = fused(s, seen.axis_out, -(seen.distance * seen.axis_along)) * inverse;
        const Floats cosine = fused(s, seen.axis_along, seen.distance * seen.axis_out) * inverse;
        amount = amount * edge(packet, light.edges, fused(aside, aside, seen.axis_across * seen.axis_across), cosine);
    }
    return amount;
}

// The stretch of the rays that a local light reaches, from the nearest point.
Stretch16 reached(const Packet& packet, const ConeLight& light, const SeenRays& seen) {
    Stretch16 stretch{packet.stretch.low - seen.nearest, packet.stretch.high - seen.nearest};
    const auto cut = [&](const Stretch16& by) HWY_ATTR {
        stretch = {max(stretch.low, by.low), min(stretch.high, by.high)};
    };
    float range = light.light.range;
    if (packet.cone.settings.attenuation == ConeAttenuation::linear) range = light.linear_range;
    if (!std::isinf(range)) {
        const Floats half = sqrt(max(range * range - seen.squared, 0.0f));
        cut({-half, half});
    }
    if (packet.cone.style.range < no_range) cut({-infinity, packet.cone.style.range - packet.before - seen.nearest});
    if (light.light.kind != LightKind::spot) return stretch;
    cut(inside_wedge(seen, light.edges.cosine, light.edges.sine));
    if (light.near_plane > 0) {
        const Floats along = seen.axis_along, start = light.near_plane - seen.distance * seen.axis_out;
        const Mask16 level = abs(along) < 1e-20f;
        const Floats s = start / select(level, 1.0f, along);
        const Floats free = select(start > 0.0f, infinity, -infinity); // level rays: all or nothing
        cut({select(level, free, select(along > 0.0f, s, -infinity)), select(along < 0.0f, s, infinity)});
    }
    return stretch;
}

// Far from the light, compared with how near it the ray passes, metres are packed into little angle: what falls or
// grows by e per metre is an edge there. Such stretches are cut where that has happened a little, once, and four times.
void add_decay_breaks(const Packet& packet, const SeenRays& seen, const Stretch16& stretch) {
    Floats rate = packet.fog.extinction();
    for (const Medium& medium : packet.fog.media)
        if (medium.kind == DensityKind::height) rate = rate + abs(packet.direction.y) * (1 / medium.height_falloff);
    const Floats scale = 1.0f / max(rate, 1e-20f), behind = max(stretch.low, 0.0f), before = min(stretch.high, 0.0f);
    for (const float share : {1.0f / 16, 0.25f, 1.0f, 4.0f}) {
        const Floats at = behind + share * scale, mirrored = before - share * scale;
        const Mask16 packed = (stretch.high > stretch.low) & (share * scale > seen.distance);
        if (any(packed & (at < stretch.high))) add_break(packet, at);
        // Before the light the two ways together stay as long in fog that is around all.
        if (!packet.fog.direct && any(packed & (mirrored > stretch.low))) add_break(packet, mirrored);
    }
}

void add_light_breaks(const Packet& packet, const ConeLight& light, const SeenRays& seen, const Stretch16& stretch) {
    add_break(packet, 0.0f);
    if (any(seen.distance < light.reach)) {
        const Floats half = sqrt(max(light.reach * light.reach - seen.squared, 0.0f));
        add_break(packet, half), add_break(packet, -half);
    }
    if (light.light.kind == LightKind::spot && light.edges.even_sine > 0) {
        const Stretch16 even = inside_wedge(seen, light.edges.even_cosine, light.edges.even_sine);
        add_break(packet, even.low), add_break(packet, even.high);
    }
    add_decay_breaks(packet, seen, stretch);
}

// Light of a local light at the nodes of one piece.
void add_piece(const Packet& packet, const ConeLight& light, const SeenRays& seen, const Stretch16& piece, int count) {
    const AnglePiece angles(piece, seen);
    const Floats middle = 0.5f * (piece.low + piece.high);
    const Floats length = piece.high - piece.low;
    const Mask16 capped = fused(middle, middle, seen.squared) < light.reach * light.reach;
    const bool has_cap = any(capped),
               inverse_square = packet.cone.settings.attenuation == ConeAttenuation::inverse_square;
    const Floats whole = select(capped, length * (1 / (light.reach * light.reach)), angles.per_distance);
    for (const QuadratureNode& node : gauss_legendre(count)) {
        const float at = static_cast<float>(node.at), weight = static_cast<float>(node.weight);
        Floats s = angles.place(at);
        if (has_cap) s = select(capped, angles.cubic(at), s);
        const Floats square = max(fused(s, s, seen.squared), 1e-30f), inverse = 1.0f / sqrt(square);
        const Floats distance = square * inverse, t = seen.nearest + s;
        const Floats share = has_cap ? select(capped, 3 * at * at * weight, weight) : Floats(weight);
        Floats amount = whole * share * strength(packet, light, seen, s, distance, inverse);
        if (!inverse_square) amount = amount * select(capped, light.reach * light.reach, square);
        const Vec3s point = packet.at(t);
        const Floats depth =
            fused(view_depth(packet, t), packet.cone.style.view_depth, light_depth(packet, light, point, distance));
        amount = amount * exp(-depth) * fade(packet, t);
        if (packet.cone.settings.noise > 0) amount = amount * dust(packet.cone, point + splat(vec3(packet.fog.anchor)));
        add_node(packet, t, amount, -(s * inverse), true);
    }
}

bool add_local(Packet& packet, const ConeLight& light) {
    const SeenRays seen = seen_rays(packet.origin, packet.rest, packet.direction, light.light.direction);
    if (light.light.kind == LightKind::spot) {
        const Stretch16 wedge = inside_wedge(seen, light.edges.cosine, light.edges.sine);
        if (!any((wedge.high > wedge.low) & (wedge.high > -seen.nearest) & (wedge.low < packet.t_max - seen.nearest)))
            return false;
    }
    find_fog(packet);
    Stretch16 stretch = reached(packet, light, seen);
    const Mask16 lit = stretch.high > stretch.low;
    if (!any(lit)) return false;
    stretch = {zero_unless(lit, stretch.low), zero_unless(lit, stretch.high)};
    packet.scratch.breaks.clear();
    add_light_breaks(packet, light, seen, stretch);
    add_fog_breaks(packet, seen.nearest);
    sort_breaks(packet, stretch);

    const auto depth_at = [&](const Floats& s) HWY_ATTR {
        const Floats distance = sqrt(fused(s, s, seen.squared)), t = seen.nearest + s;
        return fused(view_depth(packet, t), packet.cone.style.view_depth,
                     light_depth(packet, light, packet.at(t), distance));
    };
    const std::vector<Lanes>& breaks = packet.scratch.breaks;
    Floats before = 0.0f;
    bool known = false;
    for (size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Stretch16 piece{load(breaks[i].data()), load(breaks[i + 1].data())};
        const Mask16 there = piece.high > piece.low;
        if (!any(there)) continue;
        if (!known) before = depth_at(piece.low);
        const Floats after = depth_at(piece.high), change = abs(after - before);
        const Mask16 bright = there & (min(before, after) < 60.0f);
        before = after, known = true;
        if (!any(bright)) continue;
        const float share = highest(zero_unless(bright, AnglePiece(piece, seen).angle)) * (2 / pi);
        const Floats length = zero_unless(bright, piece.high - piece.low);
        add_piece(packet, light, seen, piece, node_count(packet, share, zero_unless(bright, change), length));
    }
    return true;
}

// Sun (light not null), or emission and ambient light: nodes even in t.
bool add_even(Packet& packet, const ConeLight* light) {
    find_fog(packet);
    Stretch16 stretch = packet.stretch;
    if (packet.cone.style.range < no_range) stretch.high = min(stretch.high, packet.cone.style.range - packet.before);
    const Mask16 lit = stretch.high > stretch.low;
    if (!any(lit)) return false;
    stretch = {zero_unless(lit, stretch.low), zero_unless(lit, stretch.high)};
    packet.scratch.breaks.clear();
    add_fog_breaks(packet, 0.0f);
    sort_breaks(packet, stretch);

    const Floats cosine = light ? -dot(packet.direction, splat(light->light.direction)) : Floats(0.0f);
    const auto depth_at = [&](const Floats& t) HWY_ATTR {
        const Floats depth = view_depth(packet, t) * packet.cone.style.view_depth;
        return light ? depth + light_depth(packet, *light, packet.at(t), 0.0f) : depth;
    };
    const std::vector<Lanes>& breaks = packet.scratch.breaks;
    for (size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Stretch16 piece{load(breaks[i].data()), load(breaks[i + 1].data())};
        const Floats length = piece.high - piece.low;
        const Mask16 there = length > 0.0f;
        if (!any(there)) continue;
        const Floats first = depth_at(piece.low), last = depth_at(piece.high);
        const Mask16 bright = there & (min(first, last) < 60.0f);
        if (!any(bright)) continue;
        const int count = node_count(packet, 0, zero_unless(bright, abs(last - first)), zero_unless(bright, length));
        for (const QuadratureNode& node : gauss_legendre(count)) {
            const Floats t = fused(length, static_cast<float>(node.at), piece.low);
            add_node(packet, t, length * static_cast<float>(node.weight) * exp(-depth_at(t)) * fade(packet, t), cosine,
                     light);
        }
    }
    return true;
}

// The light of the sums; clears them.
Vec3s taken_sums(const Packet& packet, const std::vector<vec3>* colors, vec3 intensity) {
    Vec3s light = splat(vec3(0));
    for (size_t m = 0; m < packet.media(); ++m) {
        const vec3 color = colors ? (*colors)[m] : packet.fog.media[m].optics.albedo;
        light = fused(splat(color * intensity), load(packet.scratch.sums[m].data()), light);
        packet.scratch.sums[m].fill(0);
    }
    return light;
}

// Emission and ambient light: of one medium ∫ σ e^-τ dt = 1 - e^-τ, whatever its density.
Vec3s glow_light(Packet& packet, const Floats& depth) {
    const Cone& cone = packet.cone;
    float brightest = 0;
    for (const vec3 glow : cone.glow) brightest = std::max(brightest, max_component(glow));
    if (!(brightest > 0)) return splat(vec3(0));
    if (packet.media() == 1 && cone.style.range >= no_range)
        return splat(cone.glow[0]) * (depth * mean_transmittance(depth * cone.style.view_depth));
    add_even(packet, nullptr);
    return taken_sums(packet, &cone.glow, vec3(1));
}

// Half for each kind of thing that is not as the scene has it: fog drawn even, light without its shadows.
float validity_of(const Cone& cone, const Ray& ray, bool unshadowed) {
    float validity = unshadowed ? 0.5f : 1.0f;
    for (const Box& grid : cone.grids)
        if (!clip(grid, ray.origin, ray.direction, {0, ray.t_max}).empty()) return validity * 0.5f;
    return validity;
}

void cone_packet_kernel(const Cone& cone, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    const size_t media = cone.fog.media.size();
    scratch.from.resize(media), scratch.to.resize(media), scratch.sums.assign(media, Lanes{});
    Packet eye = make_packet(cone, cone.fog, batch, scratch);
    find_fog(eye);
    const Floats depth = view_depth(eye, eye.t_max);
    Vec3s radiance = glow_light(eye, depth);
    Floats unshadowed = 0.0f;
    for (size_t l = 0; media > 0 && l < cone.lights.size(); ++l) {
        const ConeLight& light = cone.lights[l];
        Packet packet = make_packet(cone, light.fog, batch, scratch);
        if (!(light.light.kind == LightKind::sun ? add_even(packet, &light) : add_local(packet, light))) continue;
        const Vec3s added = taken_sums(packet, nullptr, light.light.intensity * light.light.volume_scale);
        radiance = radiance + added;
        if (cone.casts && light.light.shadows) unshadowed = unshadowed + added.x + added.y + added.z;
        add_per_light(added, l, cone.lights.size(), batch);
    }

    alignas(64) float rgbt[5][16];
    store(radiance.x, rgbt[0]), store(radiance.y, rgbt[1]), store(radiance.z, rgbt[2]);
    store(exp(-depth), rgbt[3]), store(unshadowed, rgbt[4]);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        results[lane] = {};
        results[lane].radiance = vec3(rgbt[0][lane], rgbt[1][lane], rgbt[2][lane]);
        results[lane].transmittance = rgbt[3][lane];
        results[lane].validity = validity_of(cone, batch.rays[lane], rgbt[4][lane] > 0);
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(cone_packet_kernel);
void cone_packet(const Cone& cone, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(cone_packet_kernel)(cone, batch, results);
}
}
#endif
