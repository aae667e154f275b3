#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/march/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/march/kernel.h"

#include "base/simd/simd.h"
#include "integrate/batch_simd.h"
#include "integrate/shadow_rays_simd.h"
#include "integrate/style_simd.h"
#include "trace/fluence/fluence_simd.h"
#include "trace/shadows/maps/shadow_map_simd.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Memory that a thread keeps from packet to packet. Plain floats: containers know nothing of vector registers.
struct Scratch {
    std::array<std::vector<Step>, 16> steps;
    std::vector<std::array<float, 16>> extinction; // of each medium at the current points
};

struct Packet {
    Vec3s origin, direction;
    Scratch& scratch;
    size_t longest = 0; // most steps of any lane

    HWY_INLINE Floats extinction(size_t medium) const { return load(scratch.extinction[medium].data()); }
};

struct Totals {
    Vec3s radiance;
    Floats depth; // optical depth so far: a sum rounds less than a product of transmittances
    Floats transmittance;
};

// Points of one step, and how the light arrives there.
struct Points {
    Vec3s position;
    Floats length; // of the step, 0 in lanes that are done
    Mask16 active; // lanes with fog here
};

void place_steps(const March& march, const RayBatch& batch, Packet& packet) {
    alignas(64) float v[6][16] = {};
    packet.longest = 0;
    for (size_t lane = 0; lane < 16; ++lane) {
        std::vector<Step>& steps = packet.scratch.steps[lane];
        steps.clear();
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = ray.origin[axis], v[3 + axis][lane] = ray.direction[axis];
        if (lane >= batch.rays.size()) continue;
        append_march_steps(march.steps, march.snapshot, ray, steps);
        packet.longest = std::max(packet.longest, steps.size());
    }
    packet.origin = {load(v[0]), load(v[1]), load(v[2])};
    packet.direction = {load(v[3]), load(v[4]), load(v[5])};
}

// The k-th step of every lane: where it looks and how long it is.
Points step_points(const Packet& packet, size_t k, const float* jitter) {
    alignas(64) float at[16], length[16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const bool there = k < packet.scratch.steps[lane].size();
        const Step step = there ? packet.scratch.steps[lane][k] : Step{0, 0};
        length[lane] = step.high - step.low;
        at[lane] = step.low + jitter[lane] * length[lane];
    }
    Points points;
    points.position = fused(packet.direction, load(at), packet.origin);
    points.length = load(length);
    points.active = points.length > 0.0f;
    return points;
}

// Share of the light that surfaces let through.
Floats visible_share(const March& march, const Light& light, const Points& points, const Arriving& light_at,
                     const Mask16& wanted, const RayBatch& batch, size_t step, size_t light_index) {
    if (march.settings.visibility == Visibility::maps) return lit_share16(*march.maps[light_index], points.position);
    if (!casts(light, march.snapshot) || march.settings.visibility == Visibility::off) return 1.0f;
    const auto key = [&](size_t lane) {
        return hash(batch.ids[lane], static_cast<uint32_t>(step), static_cast<uint32_t>(light_index));
    };
    return share_by_rays(*march.snapshot.occluders, light, points.position, light_at, wanted, march.light_points, key);
}

// Light scattered towards the eye from one light, per metre: Σ over media of σs p, times what arrives.
Vec3s scattered_from(const March& march, size_t light_index, const Points& points, const Packet& packet,
                     const RayBatch& batch, size_t step) {
    const Light& light = march.snapshot.lights[light_index];
    const Arriving light_at = arriving(light, march.cones[light_index], points.position);
    Mask16 wanted = points.active & (light_at.amount > 0.0f);
    if (!any(wanted)) return splat(vec3(0));
    const Floats share = visible_share(march, light, points, light_at, wanted, batch, step, light_index);
    wanted = wanted & (share > 0.0f);
    if (!any(wanted)) return splat(vec3(0));

    const Floats cosine = dot(light_at.to_light, packet.direction);
    Vec3s scattering = splat(vec3(0));
    for (size_t m = 0; m < march.snapshot.media.size(); ++m) {
        const Optics& optics = march.snapshot.media[m].optics;
        const Floats weight = packet.extinction(m) * phase_value(optics.phase, cosine);
        scattering = fused(splat(optics.albedo), weight, scattering);
    }
    const Floats dimmed = exp(-light_depth16(march.depths[light_index], points.position, wanted));
    const Floats amount = zero_unless(wanted, light_at.amount * share * dimmed);
    return scattering * amount * splat(light.intensity * light.volume_scale);
}

// Extinction of all media at the points; remembers each in the packet's scratch.
Floats extinction_at(const March& march, const Points& points, const Packet& packet) {
    Floats total = 0.0f;
    for (size_t m = 0; m < march.snapshot.media.size(); ++m) {
        const Medium& medium = march.snapshot.media[m];
        const Floats density = density16(medium, points.position);
        const Floats extinction = zero_unless(points.active, density * grey_extinction(medium.optics));
        store(extinction, packet.scratch.extinction[m].data());
        total = total + extinction;
    }
    return total;
}

// Emission, ambient light and light that has been scattered before, per metre: none needs a light's direction.
Vec3s glow_at(const March& march, const Points& points, const Packet& packet) {
    Vec3s glow = splat(vec3(0));
    for (size_t m = 0; m < march.snapshot.media.size(); ++m) {
        const vec3 each = glow_per_extinction(march.snapshot.media[m].optics, march.snapshot.ambient);
        glow = fused(splat(each), packet.extinction(m), glow);
    }
    if (!march.fluence) return glow;
    return glow + scattered_fluence(*march.fluence, march.snapshot.media, points.position, packet.direction,
                                    [&](size_t m) HWY_ATTR { return packet.extinction(m); });
}

void march_packet_kernel(const March& march, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    scratch.extinction.resize(march.snapshot.media.size());
    Packet packet{splat(vec3(0)), splat(vec3(0)), scratch};
    const size_t light_count = march.snapshot.lights.size();
    place_steps(march, batch, packet);

    alignas(64) float jitter[16];
    for (size_t lane = 0; lane < 16; ++lane) jitter[lane] = lane < batch.jitter.size() ? batch.jitter[lane] : 0.5f;

    const bool styled = march.style.view_depth != 1 || march.style.range < StyleSettings{}.range;
    Totals totals{splat(vec3(0)), 0.0f, 1.0f};
    alignas(64) float steps_taken[16] = {};
    Floats taken = 0.0f;
    for (size_t k = 0; k < packet.longest; ++k) {
        Points points = step_points(packet, k, jitter);
        points.active = points.active & (totals.transmittance > march.settings.min_transmittance);
        if (!any(points.active)) {
            if (!any(totals.transmittance > march.settings.min_transmittance)) break;
            continue;
        }
        const Floats extinction = extinction_at(march, points, packet);
        points.active = points.active & (extinction > 0.0f);
        taken = taken + select(points.active, 1.0f, 0.0f);
        if (!any(points.active)) continue;

        // What a source of 1 per metre in this step adds to the eye.
        const Floats depth = extinction * points.length;
        Floats weight = totals.transmittance * points.length * mean_transmittance(depth);
        if (styled) {
            const Floats seen = exp(-totals.depth * march.style.view_depth);
            weight = seen * points.length * mean_transmittance(depth * march.style.view_depth) *
                     style_fade(march.style, march.camera, points.position);
        }
        totals.radiance = totals.radiance + glow_at(march, points, packet) * weight;
        for (size_t light = 0; light < light_count; ++light) {
            const Vec3s added = scattered_from(march, light, points, packet, batch, k) * weight;
            totals.radiance = totals.radiance + added;
            add_per_light(added, light, light_count, batch);
        }
        totals.depth = totals.depth + depth;
        totals.transmittance = exp(-totals.depth);
    }

    alignas(64) float rgbt[4][16];
    store(totals.radiance.x, rgbt[0]), store(totals.radiance.y, rgbt[1]), store(totals.radiance.z, rgbt[2]);
    store(totals.transmittance, rgbt[3]), store(taken, steps_taken);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        Scatter& result = results[lane];
        result.radiance = vec3(rgbt[0][lane], rgbt[1][lane], rgbt[2][lane]);
        result.transmittance = rgbt[3][lane];
        result.validity = 1;
        result.steps = static_cast<int>(steps_taken[lane]);
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(march_packet_kernel);
void march_packet(const March& march, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(march_packet_kernel)(march, batch, results);
}
}
#endif
