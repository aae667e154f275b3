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
using Sixteen = std::array<float, 16>;
struct Scratch {
    std::vector<float> border;       // of the steps: t
    std::vector<float> depth;        // optical depth from the eye to each border
    std::vector<Sixteen> extinction; // of each medium at the current points
    std::vector<Sixteen> glowing;    // ∫ of what each medium scatters of even light, before its albedo
    std::vector<Sixteen> scattered;  // the same of each light, by each medium: [light · media + medium]
    std::vector<Sixteen> phase;      // of suns, the same all along a ray: [light · media + medium]
};

struct Packet {
    const ShadowMapMarch& march;
    const RayBatch& batch;
    Scratch& scratch;
    Vec3s origin, direction;
    Floats jitter;
    int steps;
    bool styled;

    HWY_INLINE Floats border(int k) const { return load(scratch.border.data() + 16 * k); }
    size_t media() const { return march.snapshot.media.size(); }
    size_t lights() const { return march.snapshot.lights.size(); }
};

HWY_INLINE void add(const Floats& value, Sixteen& sum) { store(load(sum.data()) + value, sum.data()); }

Packet make_packet(const ShadowMapMarch& march, const RayBatch& batch, Scratch& scratch) {
    alignas(64) float v[6][16] = {}, jitter[16];
    const int steps = march.settings.steps;
    const size_t media = march.snapshot.media.size(), lights = march.snapshot.lights.size();
    scratch.border.assign(16 * static_cast<size_t>(steps + 1), 0);
    scratch.depth.resize(scratch.border.size());
    scratch.extinction.resize(media), scratch.phase.resize(lights * media);
    scratch.glowing.assign(media, {}), scratch.scattered.assign(lights * media, {});
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = ray.origin[axis], v[3 + axis][lane] = ray.direction[axis];
        jitter[lane] = lane < batch.jitter.size() ? batch.jitter[lane] : 0.5f;
        if (lane < batch.rays.size()) place_steps(march, ray, steps, scratch.border.data() + lane, 16);
    }
    const bool styled = march.style.view_depth != 1 || march.style.range < StyleSettings{}.range;
    return {march,        batch, scratch, {load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])},
            load(jitter), steps, styled};
}

// Extinction of all media at the points; remembers each in the scratch.
HWY_INLINE Floats extinction_at(const Packet& packet, const Vec3s& position) {
    Floats total = 0.0f;
    for (size_t m = 0; m < packet.media(); ++m) {
        const Medium& medium = packet.march.snapshot.media[m];
        const Floats extinction = density16(medium, position) * medium.optics.extinction;
        store(extinction, packet.scratch.extinction[m].data());
        total = total + extinction;
    }
    return total;
}

// What arrives from a local light with no surface in the way, as arrival() of scene/light.h.
struct Arriving {
    Vec3s to_light; // unit
    Floats amount;  // multiplies the light's intensity
};

HWY_INLINE Arriving arriving(const Light& light, const ConeFalloff& cone, const Vec3s& position) {
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

// The rays in the coordinates of a light's map.
struct RaysInMap {
    const ShadowMap& map;
    Vec3s origin, direction;

    HWY_INLINE RaysInMap(const Packet& packet, size_t light)
        : map(packet.march.maps[light]), origin(map_coordinates(map, packet.origin)),
          direction(turned_to_map(map, packet.direction)) {}
    HWY_INLINE Floats lit_share(const Floats& t) const { return lit_share_at(map, fused(direction, t, origin)); }
};

// What a source of 1 per metre in a step of fog adds to the eye, per metre of the step: transmittance up to it times
// the mean inside; with a style, its own transmittance and fading.
HWY_INLINE Floats seen_share(const Packet& packet, const Floats& transmittance, const Floats& depth,
                             const Floats& depth_inside, const Floats& mean_inside, const Vec3s& position) {
    if (!packet.styled) return transmittance * mean_inside;
    const StyleSettings& style = packet.march.style;
    return exp(depth * -style.view_depth) * mean_transmittance(depth_inside * style.view_depth) *
           style_fade(style, packet.march.camera, position);
}

void find_sun_phases(const Packet& packet) {
    for (size_t i = 0; i < packet.lights(); ++i) {
        const Floats cosine = dot(splat(-packet.march.snapshot.lights[i].direction), packet.direction);
        for (size_t m = 0; m < packet.media(); ++m)
            store(phase_value(packet.march.snapshot.media[m].optics.phase, cosine),
                  packet.scratch.phase[i * packet.media() + m].data());
    }
}

// Adds what a sun's light in one step gives; `weight` is the step's length times its seen_share().
HWY_INLINE void add_sun(const Packet& packet, size_t index, const Floats& low, const Floats& length,
                        const Vec3s& position, const Floats& weight) {
    const RaysInMap rays(packet, index);
    const int lookups = rays.map.empty() ? 1 : packet.march.settings.lookups;
    const float part = 1 / static_cast<float>(lookups);
    Floats share = 0.0f;
    for (int i = 0; i < lookups; ++i)
        share = share + rays.lit_share(fused((packet.jitter + static_cast<float>(i)) * part, length, low));
    share = share * weight;
    const Mask16 lit = share > 0.0f;
    if (!any(lit)) return;
    const Floats dimmed = share * part * exp(-light_depth16(packet.march.depths[index], position, lit));
    for (size_t m = 0; m < packet.media(); ++m) {
        const size_t at = index * packet.media() + m;
        const Floats extinction = load(packet.scratch.extinction[m].data());
        add(extinction * load(packet.scratch.phase[at].data()) * dimmed, packet.scratch.scattered[at]);
    }
}

// The steps of the rays themselves: transmittance, glow and suns.
struct Totals {
    Floats transmittance, taken;
};
Totals march_rays(const Packet& packet) {
    Totals totals{1.0f, 0.0f};
    Floats depth = 0.0f;
    store(depth, packet.scratch.depth.data());
    for (int k = 0; k < packet.steps; ++k) {
        const Floats low = packet.border(k), length = packet.border(k + 1) - low;
        const Vec3s position = fused(packet.direction, fused(packet.jitter, length, low), packet.origin);
        const Floats extinction = extinction_at(packet, position), inside = extinction * length;
        const Mask16 active = inside > 0.0f;
        if (any(active)) {
            totals.taken = totals.taken + select(active, 1.0f, 0.0f);
            const Floats mean = mean_transmittance(inside);
            const Floats weight =
                zero_unless(active, seen_share(packet, totals.transmittance, depth, inside, mean, position) * length);
            for (size_t m = 0; m < packet.media(); ++m)
                add(load(packet.scratch.extinction[m].data()) * weight, packet.scratch.glowing[m]);
            for (size_t i = 0; i < packet.lights(); ++i)
                if (packet.march.snapshot.lights[i].kind == LightKind::sun)
                    add_sun(packet, i, low, length, position, weight);
            depth = depth + inside;
            totals.transmittance = totals.transmittance * (1.0f - inside * mean); // e^-D = 1 - D·mean(D)
        }
        store(depth, packet.scratch.depth.data() + 16 * (k + 1));
    }
    totals.transmittance = exp(-depth);
    return totals;
}

// Optical depth from the eye to increasing t: linear between the borders of the rays' steps.
struct DepthAlong {
    const Packet& packet;
    Ints lane;
    Floats step = 0.0f; // the last one asked for, of each ray

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
        scale = max(max(passing.away, max(abs(low), abs(high)) * 0.03f), 1e-12f);
        first = even ? low : atan(low / scale);
        angle = (even ? high - low : atan(high / scale) - first) * (1 / static_cast<float>(steps));
    }
    Floats at(int k, int steps) const {
        if (k == 0 || k == steps) return k ? high : low;
        const Floats place = fused(angle, static_cast<float>(k), first);
        return max(min(even ? place : scale * tan(place), high), low);
    }
};

// Points inside a step, even in the angle around the light: there the light falls off as 1/r², and dt = r²/away dθ.
struct Turning {
    Floats low, high, scale, slope, angle;

    Turning(const Floats& from, const Floats& to, const Floats& distance) : low(from), high(to), scale(distance) {
        slope = low / scale;
        angle = angle_between(slope, high / scale);
    }
    Floats at(const Floats& share) const { // tan(α + β) = (tan α + tan β) / (1 - tan α tan β)
        const Floats further = tan(share * angle);
        return max(min((slope + further) / max(1.0f - slope * further, 1e-20f) * scale, high), low);
    }
};

// Share of a local light in one step that surfaces let through.
HWY_INLINE Floats lit_share_of(const Packet& packet, const RaysInMap& rays, const Turning& turning,
                               const Floats& nearest) {
    const int lookups = rays.map.empty() ? 1 : packet.march.settings.lookups;
    const float part = 1 / static_cast<float>(lookups);
    Floats share = 0.0f;
    for (int i = 0; i < lookups; ++i)
        share = share + rays.lit_share(nearest + turning.at((packet.jitter + static_cast<float>(i)) * part));
    return share * part;
}

// The steps of a local light, on the part of each ray that it reaches.
void march_light(const Packet& packet, size_t index, Totals& totals) {
    const ShadowMapMarch& march = packet.march;
    const Light& light = march.snapshot.lights[index];
    const Passing passing = pass_light(packet, light);
    const Mask16 reached = passing.high > passing.low;
    if (!any(reached)) return;
    const RaysInMap rays(packet, index);
    const Spaced spaced(passing, march.settings.spacing, packet.steps);
    const Floats scale = max(passing.away, std::max(light.radius, smallest_radius));
    DepthAlong along(packet);
    Floats low = spaced.low;
    for (int k = 0; k < packet.steps; ++k) {
        const Floats high = spaced.at(k + 1, packet.steps), length = high - low;
        const Turning turning(low, high, scale);
        const Floats x = turning.at(packet.jitter), slope = x / scale;
        const Vec3s position = fused(packet.direction, passing.nearest + x, packet.origin);
        const Arriving light_at = arriving(light, march.cones[index], position);
        Mask16 active = reached & (length > 0.0f) & (light_at.amount > 0.0f);
        Floats share = 0.0f;
        if (any(active)) share = lit_share_of(packet, rays, turning, passing.nearest);
        active = active & (share > 0.0f);
        if (any(active)) {
            const Floats extinction = extinction_at(packet, position), inside = extinction * length;
            const Floats depth = along.at(passing.nearest + low);
            const Floats seen = seen_share(packet, exp(-depth), depth, inside, mean_transmittance(inside), position);
            const Floats dimmed = exp(-light_depth16(march.depths[index], position, active));
            const Floats weight = zero_unless(active, seen * turning.angle * scale * fused(slope, slope, 1.0f) *
                                                          light_at.amount * share * dimmed);
            const Floats cosine = dot(light_at.to_light, packet.direction);
            for (size_t m = 0; m < packet.media(); ++m)
                add(load(packet.scratch.extinction[m].data()) * weight *
                        phase_value(march.snapshot.media[m].optics.phase, cosine),
                    packet.scratch.scattered[index * packet.media() + m]);
            totals.taken = totals.taken + select(active, 1.0f, 0.0f);
        }
        low = high;
    }
}

// Gives what the media scattered its colour.
void color_ray(const Packet& packet, size_t lane, Scatter& result) {
    const Snapshot& snapshot = packet.march.snapshot;
    result.radiance = vec3(0);
    for (size_t m = 0; m < packet.media(); ++m) {
        const Optics& optics = snapshot.media[m].optics;
        const vec3 glow = optics.albedo * snapshot.ambient + optics.emission / optics.extinction;
        result.radiance += glow * packet.scratch.glowing[m][lane];
    }
    for (size_t i = 0; i < packet.lights(); ++i) {
        vec3 part(0);
        for (size_t m = 0; m < packet.media(); ++m)
            part += snapshot.media[m].optics.albedo * packet.scratch.scattered[i * packet.media() + m][lane];
        part *= snapshot.lights[i].intensity * snapshot.lights[i].volume_scale;
        result.radiance += part;
        if (!packet.batch.per_light.empty()) packet.batch.per_light[lane * packet.lights() + i] += part;
    }
}

// How far the steps of a ray can be trusted: the share of a step that the fog's finest detail takes up.
float trust(const ShadowMapMarch& march, float first, float last) {
    const float step = (last - first) / static_cast<float>(march.settings.steps);
    return step > march.detail ? march.detail / step : 1.0f;
}

void march_shadow_maps_kernel(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    const Packet packet = make_packet(march, batch, scratch);
    find_sun_phases(packet);
    Totals totals = march_rays(packet);
    for (size_t i = 0; i < packet.lights(); ++i)
        if (march.snapshot.lights[i].kind != LightKind::sun) march_light(packet, i, totals);

    alignas(64) float transmittance[16], taken[16], first[16], last[16];
    store(totals.transmittance, transmittance), store(totals.taken, taken);
    store(packet.border(0), first), store(packet.border(packet.steps), last);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        color_ray(packet, lane, results[lane]);
        results[lane].transmittance = transmittance[lane];
        results[lane].validity = trust(march, first[lane], last[lane]);
        results[lane].steps = static_cast<int>(taken[lane]);
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
