// 16 rays in homogeneous fog: its extent, its optical depth, and kinks of the integrand (see base/simd/simd.h for how
// such files are compiled).
#if defined(TYNDALL_MODES_CONE_PACKET_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_CONE_PACKET_SIMD_H
#undef TYNDALL_MODES_CONE_PACKET_SIMD_H
#else
#define TYNDALL_MODES_CONE_PACKET_SIMD_H
#endif

#include "base/gauss_legendre.h"
#include "base/simd/reduce_simd.h"
#include "base/simd/simd.h"
#include "modes/cone/cone.h"
#include "modes/cone/geometry_simd.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
using Lanes = std::array<float, 16>;
constexpr float no_range = StyleSettings{}.range; // style.range without a limit

// Memory that a thread reuses from packet to packet: plain floats, as containers cannot hold vector registers.
struct Scratch {
    std::vector<Lanes> from, to; // where the rays enter and leave each medium
    std::vector<Lanes> sums;     // per medium: the light it scatters or emits
    std::vector<Lanes> breaks;   // where the integrand has a kink
};

// The rays relative to one light's fog.
struct Packet {
    const Cone& cone;
    const AnchoredFog& fog;
    Vec3s origin, direction; // relative to the fog's anchor
    Vec3s rest;              // what rounding the origin to float loses
    Floats t_max, before;    // length, and distance from the eye to the origin
    Scratch& scratch;
    Interval<Floats> stretch; // from first to last fog
    int channel = 0;          // color channel, for a light with a colored gobo

    HWY_INLINE size_t media() const { return fog.media.size(); }
    HWY_INLINE Vec3s at(const Floats& t) const { return fma(direction, t, origin); }
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
        const Interval<Floats> inside =
            inside_box(packet.fog.media[m], {packet.origin, packet.direction, packet.t_max});
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
        Floats depth = max(to - from, 0.0f) * gray_extinction(medium.optics);
        if (medium.density.kind == DensityKind::height) {
            const Floats y0 = fma(packet.direction.y, from, packet.origin.y);
            const Floats y1 = fma(packet.direction.y, to, packet.origin.y);
            depth = zero_unless(depth > 0.0f, depth * mean_height_density(medium, y0, y1));
        }
        sum = sum + depth;
    }
    return sum;
}

// Extinction of a medium at t, in a segment that does not cross the medium's bounds.
HWY_INLINE Floats extinction(const Packet& packet, size_t m, const Floats& t) {
    const Medium& medium = packet.fog.media[m];
    const Mask16 inside = (t >= load(packet.scratch.from[m].data())) & (t <= load(packet.scratch.to[m].data()));
    Floats value = gray_extinction(medium.optics);
    if (medium.density.kind == DensityKind::height) {
        const Floats height = max(fma(packet.direction.y, t, packet.origin.y) - medium.density.height_base, 0.0f);
        value = value * exp(height * (-1 / medium.density.height_falloff));
    }
    return packet.media() == 1 ? value : zero_unless(inside, value);
}

HWY_INLINE Floats light_depth(const Packet& packet, const ConeLight& light, const Vec3s& point,
                              const Floats& distance) {
    const bool sun = is_distant(light.light);
    const Floats length = sun ? Floats(sun_distance) : max(distance - light.light.radius, 0.0f);
    const float scale = packet.cone.style.light_depth;
    if (packet.fog.direct) return length * (packet.fog.extinction() * scale);
    const Vec3s towards = sun ? splat(-light.light.direction) : point * (-1.0f / max(distance, 1e-12f));
    Floats sum = 0.0f;
    for (const Medium& medium : packet.fog.media) sum = sum + analytic_depth16(medium, {point, towards, length});
    return sum * scale;
}

// Fraction of the fog's light that style.range leaves.
HWY_INLINE Floats fade(const Packet& packet, const Floats& t) {
    const float range = packet.cone.style.range;
    if (range >= no_range) return 1.0f;
    return max(min((range - (t + packet.before)) * (1 / (0.2f * range)), 1.0f), 0.0f);
}

// Adds `amount` of light at t to the sums of the media there; without a light, for emission and ambient light.
HWY_INLINE void add_node(const Packet& packet, const Floats& t, const Floats& amount, const Floats& cosine,
                         bool has_light) {
    for (size_t m = 0; m < packet.media(); ++m) {
        const Phase& phase = packet.fog.media[m].optics.phase;
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

// Adds breaks at bounds of media, at kinks of height fog and of paths to the light, and where the style's fade starts;
// `start`: t at the origin of the breaks' coordinate.
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

// Clamps the breaks to the interval, adds its ends, and sorts them in each lane.
void sort_breaks(const Packet& packet, const Interval<Floats>& stretch) {
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

// Number of nodes for a segment: grows with its angle and with the change of optical depth and density.
int node_count(const Packet& packet, float share, const Floats& change, const Floats& length) {
    Floats amount = change;
    float narrowest = 1;
    for (const Medium& medium : packet.fog.media) {
        if (medium.density.kind == DensityKind::height)
            amount = amount + min(abs(packet.direction.y) * length * (1 / medium.density.height_falloff), 30.0f);
        const Phase& phase = medium.optics.phase; // with several lobes: rays have breaks for the narrow ones
        narrowest = std::min(narrowest, phase.shape ? wide_lobe : 1 - std::abs(mean_cosine(phase)));
    }
    const float nodes = static_cast<float>(packet.cone.settings.nodes), lobe = std::max(0.4f / narrowest, 1.0f);
    const float change_at_most = std::min(most(amount), 60.0f);
    const float wanted = 7 + (nodes - 2) * (2 * share * lobe + change_at_most * 0.16f);
    return std::clamp(static_cast<int>(wanted), 2, max_gauss_nodes);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
