// Local lights of the march with shadow maps, each with its own steps on the segment of a ray that it reaches (see
// base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_SHADOW_MAP_LOCAL_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_SHADOW_MAP_LOCAL_SIMD_H
#undef TYNDALL_MODES_SHADOW_MAP_LOCAL_SIMD_H
#else
#define TYNDALL_MODES_SHADOW_MAP_LOCAL_SIMD_H
#endif

#include "integrate/equi_angular_simd.h"
#include "modes/shadow_map/packet_simd.h"
#include "modes/shadow_map/settings.h"
#include "scene/lights/light_reach.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Optical depth from the eye to t, called with increasing t: linear between the boundaries of the rays' steps.
struct DepthAlong {
    const Packet& packet;
    Ints lane;
    Floats step = 0.0f; // of each ray, at the last call

    explicit DepthAlong(const Packet& on) : packet(on) {
        alignas(64) int32_t lanes[16];
        for (int i = 0; i < 16; ++i) lanes[i] = i;
        lane = load(lanes);
    }
    Floats at(const Floats& t) {
        const float *border = packet.scratch.border.data(), *depth = packet.scratch.depth.data();
        const float last = static_cast<float>(packet.steps - 1);
        Ints here = truncate(step) * 16 + lane;
        Floats next = gather(border + 16, here);
        for (;;) {
            const Mask16 beyond = (t > next) & (step < last);
            if (!any(beyond)) break;
            step = step + select(beyond, 1.0f, 0.0f);
            here = truncate(step) * 16 + lane;
            next = gather(border + 16, here);
        }
        const Floats before = gather(border, here), depth_before = gather(depth, here);
        const Floats share = (t - before) / max(next - before, 1e-12f);
        return fma(gather(depth + 16, here) - depth_before, max(min(share, 1.0f), 0.0f), depth_before);
    }
};

// The segment of each ray that a local light reaches, and the ray's closest approach to it.
struct Passing {
    Floats low, high;     // empty where high <= low
    Floats nearest, away; // t of the closest approach, and its distance from the light
};

Passing pass_light(const Packet& packet, const Light& light) {
    alignas(64) float v[4][16] = {};
    const float* border = packet.scratch.border.data();
    for (size_t lane = 0; lane < packet.batch.rays.size(); ++lane) {
        const Ray& ray = packet.batch.rays[lane];
        const Interval<float> stretch{border[lane], border[16 * static_cast<size_t>(packet.steps) + lane]};
        const Interval<float> lit = light_reach(light, ray, stretch);
        if (lit.empty()) continue;
        const vec3 offset = light.position - ray.origin;
        const float nearest = glm::dot(offset, ray.direction);
        v[0][lane] = lit.low, v[1][lane] = lit.high, v[2][lane] = nearest;
        v[3][lane] = glm::length(offset - nearest * ray.direction);
    }
    return {load(v[0]), load(v[1]), load(v[2]), load(v[3])};
}

Floats asinh(const Floats& value) {
    alignas(64) float v[16];
    store(value, v);
    for (float& one : v) one = std::asinh(one);
    return load(v);
}

// Boundaries of a local light's steps, measured from the closest approach: x = scale·tan θ with uniform θ, or uniform
// x. In fog with a narrow phase lobe, x = scale·sinh y with uniform y: towards both ends, each step halves the angle to
// the axis.
struct Spaced {
    Floats low, high, scale, first, angle;
    bool even, narrow;

    Spaced(const Passing& passing, Spacing spacing, bool narrow_lobe, int steps) {
        low = passing.low - passing.nearest, high = passing.high - passing.nearest;
        even = spacing == Spacing::distance, narrow = narrow_lobe && !even;
        if (narrow) {
            scale = max(max(passing.away, max(abs(low), abs(high)) * 1e-4f), 1e-12f);
            first = asinh(low / scale), angle = (asinh(high / scale) - first) * (1 / static_cast<float>(steps));
            return;
        }
        // Limits how short steps near the light get, relative to the segment's far end.
        scale = max(max(passing.away, max(abs(low), abs(high)) * 0.03f), 1e-12f);
        first = even ? low : atan(low / scale);
        angle = (even ? high - low : atan(high / scale) - first) * (1 / static_cast<float>(steps));
    }
    Floats at(int k, int steps) const {
        if (k == 0 || k == steps) return k ? high : low;
        const Floats place = fma(angle, static_cast<float>(k), first);
        if (narrow) return max(min(scale * 0.5f * (exp(place) - exp(-place)), high), low);
        return max(min(even ? place : scale * tan(place), high), low);
    }
};

// Fraction of a local light that surfaces let through to one step.
HWY_INLINE Floats lit_share_of(const Packet& packet, const RaysInMap& rays, const EquiAngular16& turning,
                               const Floats& nearest) {
    const int lookups = rays.map.empty() ? 1 : map_lookups;
    const float part = 1 / static_cast<float>(lookups);
    Floats share = 0.0f;
    for (int i = 0; i < lookups; ++i)
        share = share + rays.lit_share(nearest +
                                       turning.slope((packet.jitter + static_cast<float>(i)) * part) * turning.height);
    return share * part;
}

// Light colored by a gobo and scattered by all media.
HWY_INLINE void add_tinted(const Packet& packet, size_t light, const Vec3s& tint, const Sixteen* extinctions,
                           const Floats& weight, const Floats& cosine) {
    for (size_t m = 0; m < packet.media(); ++m) {
        const Optics& optics = packet.march.snapshot.media[m].optics;
        const Floats scattered = load(extinctions[m].data()) * weight * phase_value(optics.phase, cosine);
        Sixteen* sums = packet.scratch.tinted.data() + 3 * light;
        add(scattered * tint.x * optics.albedo.x, sums[0]);
        add(scattered * tint.y * optics.albedo.y, sums[1]);
        add(scattered * tint.z * optics.albedo.z, sums[2]);
    }
}

// Marches a local light's steps over the segment of each ray that it reaches.
void march_light(const Packet& packet, size_t index, Floats& taken) {
    const ShadowMapMarch& march = packet.march;
    const Light& light = march.snapshot.lights[index];
    const Passing passing = pass_light(packet, light);
    const Mask16 reached = passing.high > passing.low;
    if (!any(reached)) return;
    const RaysInMap rays(packet, index);
    const Spaced spaced(passing, march.settings.spacing, march.narrow_lobe, packet.steps);
    const Floats scale = max(passing.away, capped_radius(light));
    DepthAlong along(packet);
    Sixteen* extinctions = packet.scratch.extinction.data() + packet.media() * static_cast<size_t>(packet.steps);
    Floats low = spaced.low;
    for (int k = 0; k < packet.steps; ++k) {
        const Floats high = spaced.at(k + 1, packet.steps), length = high - low;
        const EquiAngular16 turning({low, high}, scale);
        const Floats slope = turning.slope(packet.jitter);
        const Vec3s position = fma(packet.direction, passing.nearest + slope * scale, packet.origin);
        const LightSamples light_at = arrival16(light, march.cones[index], position);
        Mask16 active = reached & (length > 0.0f) & (light_at.amount > 0.0f);
        Floats share = 0.0f;
        if (any(active)) share = lit_share_of(packet, rays, turning, passing.nearest);
        active = active & (share > 0.0f);
        if (any(active)) {
            const Floats extinction = extinction_at(packet, position, extinctions), inside = extinction * length;
            const Floats depth = along.at(passing.nearest + low);
            const Floats seen = view_weight(packet, exp(-depth), depth, inside, mean_transmittance(inside), position);
            const Floats transmittance = exp(-light_depth16(march.depths[index], position, active));
            const Floats weight =
                zero_unless(active, turning.length(seen, slope) * light_at.amount * share * transmittance);
            const Floats cosine = dot(light_at.to_light, packet.direction);
            if (light.filter && has_colors(*light.filter))
                add_tinted(packet, index, tint_at(light, position), extinctions, weight, cosine);
            else
                for (size_t m = 0; m < packet.media(); ++m)
                    add(load(extinctions[m].data()) * weight *
                            phase_value(march.snapshot.media[m].optics.phase, cosine),
                        packet.scratch.scattered[index * packet.media() + m]);
            taken = taken + select(active, 1.0f, 0.0f);
        }
        low = high;
    }
}
}
}
HWY_AFTER_NAMESPACE();
#endif
