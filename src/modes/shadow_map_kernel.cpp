#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/shadow_map_kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/shadow_map_kernel.h"

#include "base/simd.h"
#include "modes/angles_simd.h"
#include "modes/style_simd.h"
#include "trace/light_depth_simd.h"
#include "trace/shadow_map_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Memory that a thread keeps from packet to packet: plain floats, of 16 rays side by side.
struct Scratch {
    std::vector<float> border;                     // of the steps: t
    std::vector<float> depth;                      // optical depth from the eye to each border
    std::vector<std::array<float, 16>> extinction; // of each medium at the current points
};

struct Packet {
    const ShadowMapMarch& march;
    const RayBatch& batch;
    Scratch& scratch;
    Vec3s origin, direction;
    Floats jitter;
    int steps;

    HWY_INLINE Floats border(int k) const { return load(scratch.border.data() + 16 * k); }
    HWY_INLINE Floats extinction(size_t medium) const { return load(scratch.extinction[medium].data()); }
};

// Points of one step of all rays.
struct Points {
    Floats t;
    Vec3s position;
    Mask16 active; // lanes with fog here
};

struct Totals {
    Vec3s radiance;
    Floats taken; // steps with fog in them
};

Packet make_packet(const ShadowMapMarch& march, const RayBatch& batch, Scratch& scratch) {
    alignas(64) float v[6][16] = {}, jitter[16];
    const int steps = march.settings.steps;
    scratch.border.assign(16 * static_cast<size_t>(steps + 1), 0);
    scratch.depth.resize(scratch.border.size());
    scratch.extinction.resize(march.snapshot.media.size());
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = ray.origin[axis], v[3 + axis][lane] = ray.direction[axis];
        jitter[lane] = lane < batch.jitter.size() ? batch.jitter[lane] : 0.5f;
        if (lane < batch.rays.size()) place_steps(march, ray, steps, scratch.border.data() + lane, 16);
    }
    return {march,        batch, scratch, {load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])},
            load(jitter), steps};
}

// Extinction of all media at the points; remembers each in the scratch.
Floats extinction_at(const Packet& packet, const Points& points) {
    Floats total = 0.0f;
    for (size_t m = 0; m < packet.march.snapshot.media.size(); ++m) {
        const Medium& medium = packet.march.snapshot.media[m];
        const Floats density = density16(medium, points.position);
        const Floats extinction = zero_unless(points.active, density * medium.optics.extinction);
        store(extinction, packet.scratch.extinction[m].data());
        total = total + extinction;
    }
    return total;
}

// Emission and ambient light, per metre.
Vec3s glow_at(const Packet& packet) {
    Vec3s glow = splat(vec3(0));
    for (size_t m = 0; m < packet.march.snapshot.media.size(); ++m) {
        const Optics& optics = packet.march.snapshot.media[m].optics;
        const vec3 per_extinction = optics.albedo * packet.march.snapshot.ambient + optics.emission / optics.extinction;
        glow = fused(splat(per_extinction), packet.extinction(m), glow);
    }
    return glow;
}

// What arrives from a light with no surface in the way, as arrival() of scene/light.h.
struct Arriving {
    Vec3s to_light; // unit
    Floats amount;  // multiplies the light's intensity
};

Arriving arriving(const Light& light, const ConeFalloff& cone, const Vec3s& position) {
    if (light.kind == LightKind::sun) return {splat(-light.direction), 1.0f};
    const Vec3s offset = splat(light.position) - position;
    const float reach = std::max(light.radius, smallest_radius);
    const Floats squared = dot(offset, offset), distance = max(sqrt(squared), 1e-12f);
    Arriving result{offset * (1.0f / distance), 1.0f / max(squared, reach * reach)};
    if (!std::isinf(light.range)) {
        const Floats share = distance * (1 / light.range), fourth = (share * share) * (share * share);
        result.amount = result.amount * max(min(1.0f - fourth, 1.0f), 0.0f);
    }
    if (light.kind == LightKind::spot) {
        const Floats cosine = -dot(result.to_light, splat(light.direction));
        const Floats edge = max(min(fused(cosine, cone.scale, cone.offset), 1.0f), 0.0f);
        result.amount = result.amount * edge * edge;
    }
    return result;
}

// Light scattered towards the eye from one light, per metre: Σ over media of σs p, times what arrives.
Vec3s scattered_from(const Packet& packet, size_t index, const Points& points) {
    const ShadowMapMarch& march = packet.march;
    const Light& light = march.snapshot.lights[index];
    const Arriving light_at = arriving(light, march.cones[index], points.position);
    Mask16 wanted = points.active & (light_at.amount > 0.0f);
    if (!any(wanted)) return splat(vec3(0));
    const Floats share = lit_share16(march.maps[index], points.position);
    wanted = wanted & (share > 0.0f);
    if (!any(wanted)) return splat(vec3(0));

    const Floats cosine = dot(light_at.to_light, packet.direction);
    Vec3s scattering = splat(vec3(0));
    for (size_t m = 0; m < march.snapshot.media.size(); ++m) {
        const Optics& optics = march.snapshot.media[m].optics;
        const Floats weight = packet.extinction(m) * phase_value(optics.phase, cosine);
        scattering = fused(splat(optics.albedo), weight, scattering);
    }
    const Floats dimmed = exp(-light_depth16(march.depths[index], points.position, wanted));
    const Floats amount = zero_unless(wanted, light_at.amount * share * dimmed);
    return scattering * amount * splat(light.intensity * light.volume_scale);
}

void add_light(const Packet& packet, size_t index, const Vec3s& light, Totals& totals) {
    totals.radiance = totals.radiance + light;
    const RayBatch& batch = packet.batch;
    if (batch.per_light.empty()) return;
    alignas(64) float rgb[3][16];
    store(light.x, rgb[0]), store(light.y, rgb[1]), store(light.z, rgb[2]);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane)
        batch.per_light[lane * packet.march.snapshot.lights.size() + index] +=
            vec3(rgb[0][lane], rgb[1][lane], rgb[2][lane]);
}

// What a source of 1 per metre in a step of fog adds to the eye, per metre of the step: transmittance up to it, times
// the mean inside, times what the style leaves of light this far away.
Floats seen_share(const Packet& packet, const Floats& depth_before, const Floats& depth_inside, const Vec3s& point) {
    const StyleSettings& style = packet.march.style;
    const Floats share = exp(depth_before * -style.view_depth) * mean_transmittance(depth_inside * style.view_depth);
    return share * style_fade(style, packet.march.camera, point);
}

// The steps of the rays themselves: transmittance, glow and suns. Returns the optical depths of the whole rays.
Floats march_rays(const Packet& packet, Totals& totals) {
    Floats depth = 0.0f;
    store(depth, packet.scratch.depth.data());
    for (int k = 0; k < packet.steps; ++k) {
        const Floats low = packet.border(k), length = packet.border(k + 1) - low;
        Points points;
        points.t = fused(packet.jitter, length, low);
        points.position = fused(packet.direction, points.t, packet.origin);
        points.active = length > 0.0f;
        const Floats extinction = extinction_at(packet, points), inside = extinction * length;
        points.active = points.active & (extinction > 0.0f);
        if (any(points.active)) {
            totals.taken = totals.taken + select(points.active, 1.0f, 0.0f);
            const Floats weight = seen_share(packet, depth, inside, points.position) * length;
            totals.radiance = totals.radiance + glow_at(packet) * weight;
            for (size_t i = 0; i < packet.march.snapshot.lights.size(); ++i)
                if (packet.march.snapshot.lights[i].kind == LightKind::sun)
                    add_light(packet, i, scattered_from(packet, i, points) * weight, totals);
            depth = depth + inside;
        }
        store(depth, packet.scratch.depth.data() + 16 * (k + 1));
    }
    return depth;
}

// Optical depth from the eye to increasing t: linear between the borders of the rays' steps.
struct DepthAlong {
    const Packet& packet;
    Floats step = 0.0f; // the last one asked for, of each ray

    Floats at(const Floats& t) {
        const float *border = packet.scratch.border.data(), *depth = packet.scratch.depth.data();
        Ints lane;
        alignas(64) int32_t lanes[16];
        for (int i = 0; i < 16; ++i) lanes[i] = i;
        lane = load(lanes);
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
        return fused(gather(depth + 16, here) - depth_before, max(min(share, 1.0f), 0.0f), depth_before);
    }
};

// What each ray sees of a local light: its stretch, and where the ray passes it.
struct Passing {
    Floats low, high;     // empty where high <= low
    Floats nearest, away; // t next to the light, and its distance there
};

Passing pass_light(const Packet& packet, const Light& light) {
    alignas(64) float v[4][16] = {};
    const float* border = packet.scratch.border.data();
    for (size_t lane = 0; lane < packet.batch.rays.size(); ++lane) {
        const Ray& ray = packet.batch.rays[lane];
        const Interval stretch{border[lane], border[16 * static_cast<size_t>(packet.steps) + lane]};
        const Interval lit = lit_interval(light, ray, stretch);
        if (lit.empty()) continue;
        const vec3 offset = light.position - ray.origin;
        const float nearest = glm::dot(offset, ray.direction);
        v[0][lane] = lit.low, v[1][lane] = lit.high, v[2][lane] = nearest;
        v[3][lane] = glm::length(offset - nearest * ray.direction);
    }
    return {load(v[0]), load(v[1]), load(v[2]), load(v[3])};
}

// Borders of the steps on a passage, counted from the point next to the light: x = scale·tan θ with even θ, or even x.
struct Spaced {
    Floats low, high, scale, first, angle;
    bool even;

    Spaced(const Passing& passing, Spacing spacing, int steps) {
        low = passing.low - passing.nearest, high = passing.high - passing.nearest;
        even = spacing == Spacing::distance;
        // Next to the light steps need not get shorter than what is far from it is long.
        scale = max(max(passing.away, max(abs(low), abs(high)) * 0.15f), 1e-12f);
        first = even ? low : atan(low / scale);
        angle = (even ? high - low : atan(high / scale) - first) * (1 / static_cast<float>(steps));
    }
    Floats at(int k, int steps) const {
        if (k == 0 || k == steps) return k ? high : low;
        const Floats place = fused(angle, static_cast<float>(k), first);
        return max(min(even ? place : scale * tan(place), high), low);
    }
};

// The steps of a local light, on the part of each ray that it reaches.
void march_light(const Packet& packet, size_t index, Totals& totals) {
    const Light& light = packet.march.snapshot.lights[index];
    const Passing passing = pass_light(packet, light);
    const Mask16 reached = passing.high > passing.low;
    if (!any(reached)) return;
    const Spaced spaced(passing, packet.march.settings.spacing, packet.steps);
    const Floats scale = max(passing.away, std::max(light.radius, smallest_radius));
    DepthAlong along{packet};
    Vec3s sum = splat(vec3(0));
    Floats low = spaced.low;
    for (int k = 0; k < packet.steps; ++k) {
        const Floats high = spaced.at(k + 1, packet.steps), length = high - low;
        // Inside the step the light falls off as 1/r²: a point even in the angle around it, tan by its addition
        // theorem, and the weight dt = scale (1 + tan²) dθ there.
        const Floats a = low / scale, turn = angle_between(a, high / scale);
        const Floats further = tan(packet.jitter * turn);
        const Floats x = max(min((a + further) / max(1.0f - a * further, 1e-20f) * scale, high), low);
        Points points;
        points.t = passing.nearest + x;
        points.position = fused(packet.direction, points.t, packet.origin);
        points.active = reached & (length > 0.0f);
        const Floats extinction = extinction_at(packet, points);
        points.active = points.active & (extinction > 0.0f);
        if (any(points.active)) {
            totals.taken = totals.taken + select(points.active, 1.0f, 0.0f);
            const Floats seen =
                seen_share(packet, along.at(passing.nearest + low), extinction * length, points.position);
            const Floats slope = x / scale, weight = seen * turn * scale * fused(slope, slope, 1.0f);
            sum = sum + scattered_from(packet, index, points) * weight;
        }
        low = high;
    }
    add_light(packet, index, sum, totals);
}

// How far the steps of a ray can be trusted: the share of a step that the fog's finest detail takes up.
float trust(const ShadowMapMarch& march, float first, float last) {
    const float step = (last - first) / static_cast<float>(march.settings.steps);
    return step > march.detail ? march.detail / step : 1.0f;
}

void march_shadow_maps_kernel(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    const Packet packet = make_packet(march, batch, scratch);
    Totals totals{splat(vec3(0)), 0.0f};
    const Floats depth = march_rays(packet, totals);
    for (size_t i = 0; i < march.snapshot.lights.size(); ++i)
        if (march.snapshot.lights[i].kind != LightKind::sun) march_light(packet, i, totals);

    alignas(64) float rgbt[4][16], taken[16], first[16], last[16];
    store(totals.radiance.x, rgbt[0]), store(totals.radiance.y, rgbt[1]), store(totals.radiance.z, rgbt[2]);
    store(exp(-depth), rgbt[3]), store(totals.taken, taken);
    store(packet.border(0), first), store(packet.border(packet.steps), last);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        Scatter& result = results[lane];
        result.radiance = vec3(rgbt[0][lane], rgbt[1][lane], rgbt[2][lane]);
        result.transmittance = rgbt[3][lane];
        result.validity = trust(march, first[lane], last[lane]);
        result.steps = static_cast<int>(taken[lane]);
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(march_shadow_maps_kernel);
void march_shadow_maps(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(march_shadow_maps_kernel)(march, batch, results);
}
}
#endif
