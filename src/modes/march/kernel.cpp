#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/march/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/march/kernel.h"

#include "base/simd/simd.h"
#include "integrate/batch_simd.h"
#include "integrate/scattering_simd.h"
#include "integrate/shadow_rays_simd.h"
#include "integrate/style_simd.h"
#include "trace/shadows/maps/shadow_map_simd.h"
#include "volume/medium_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Memory that a thread reuses from packet to packet: plain floats, as containers cannot hold vector registers.
struct Scratch {
    std::array<std::vector<Step>, 16> steps;
    std::vector<std::array<float, 16>> extinction; // of each medium at the current points
};

struct Packet {
    Vec3s origin, direction;
    Scratch& scratch;
    size_t longest = 0; // maximum number of steps of any lane

    HWY_INLINE Floats extinction(size_t medium) const { return load(scratch.extinction[medium].data()); }
};

struct Totals {
    Vec3s radiance;
    Floats depth; // optical depth so far: a sum rounds less than a product of transmittances
    Floats transmittance;
};

// Sample points of one step.
struct Points {
    Vec3s position;
    Floats length; // of the step, 0 in lanes that are done
    Mask16 active; // lanes with fog here
};

void place_steps(const SingleScattering& frame, const RayBatch& batch, Packet& packet) {
    packet.longest = 0;
    for (size_t lane = 0; lane < 16; ++lane) {
        std::vector<Step>& steps = packet.scratch.steps[lane];
        steps.clear();
        if (lane >= batch.rays.size()) continue;
        append_march_steps(*frame.rule, frame.snapshot, batch.rays[lane], steps);
        packet.longest = std::max(packet.longest, steps.size());
    }
}

// The k-th step of every lane: its sample point and length.
Points step_points(const Packet& packet, size_t k, const float* jitter) {
    alignas(64) float at[16], length[16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const bool there = k < packet.scratch.steps[lane].size();
        const Step step = there ? packet.scratch.steps[lane][k] : Step{0, 0};
        length[lane] = step.high - step.low;
        at[lane] = step.low + jitter[lane] * length[lane];
    }
    Points points;
    points.position = fma(packet.direction, load(at), packet.origin);
    points.length = load(length);
    points.active = points.length > 0.0f;
    return points;
}

// Fraction of the light that surfaces let through.
Floats visible_share(const SingleScattering& frame, const Light& light, const Points& points,
                     const LightSamples& light_at, const Mask16& wanted, const RayBatch& batch, size_t step,
                     size_t light_index) {
    const LightShadows& shadows = frame.shadows[light_index];
    if (shadows.by == ShadowMethod::maps) return lit_fraction16(*shadows.map, points.position);
    if (shadows.by == ShadowMethod::none) return 1.0f;
    const auto key = [&](size_t lane) {
        return hash(batch.ids[lane], static_cast<uint32_t>(step), static_cast<uint32_t>(light_index));
    };
    return traced_visibility(*shadow_casters(light, frame.snapshot), light, points.position, light_at, wanted,
                             frame.light_points, key);
}

// Light scattered towards the eye from one light, per meter: Σ over media of σs p, times the arriving light.
Vec3s scattered_from(const SingleScattering& frame, size_t light_index, const Points& points, const Packet& packet,
                     const RayBatch& batch, size_t step) {
    const Light& light = frame.snapshot.lights[light_index];
    const LightSamples light_at = arrival16(light, frame.cones[light_index], points.position);
    Mask16 wanted = points.active & (light_at.amount > 0.0f);
    if (!any(wanted)) return splat(vec3(0));
    const Floats share = visible_share(frame, light, points, light_at, wanted, batch, step, light_index);
    wanted = wanted & (share > 0.0f);
    if (!any(wanted)) return splat(vec3(0));

    const Vec3s towards = scattering(frame.snapshot.media, points.position, dot(light_at.to_light, packet.direction),
                                     [&](size_t m) HWY_ATTR { return packet.extinction(m); });
    return scattered_light(light, frame.depths[light_index], points.position,
                           zero_unless(wanted, light_at.amount * share), towards);
}

// Total extinction at the points; stores that of each medium in the packet's scratch.
Floats extinction_at(const SingleScattering& frame, const Points& points, const Packet& packet) {
    Floats total = 0.0f;
    for (size_t m = 0; m < frame.snapshot.media.size(); ++m) {
        const Medium& medium = frame.snapshot.media[m];
        const Floats density = density16(medium, points.position);
        const Floats extinction = zero_unless(points.active, density * gray_extinction(medium.optics));
        store(extinction, packet.scratch.extinction[m].data());
        total = total + extinction;
    }
    return total;
}

void march_packet_kernel(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    scratch.extinction.resize(frame.snapshot.media.size());
    const Rays16 rays = rays_of(batch);
    Packet packet{rays.origin, rays.direction, scratch};
    const float min_transmittance = frame.rule->settings.min_transmittance;
    const size_t light_count = frame.snapshot.lights.size();
    place_steps(frame, batch, packet);

    alignas(64) float jitter[16];
    store(rays.jitter, jitter);
    const bool styled = frame.style.view_depth != 1 || frame.style.range < StyleSettings{}.range;
    Totals totals{splat(vec3(0)), 0.0f, 1.0f};
    Floats taken = 0.0f;
    for (size_t k = 0; k < packet.longest; ++k) {
        Points points = step_points(packet, k, jitter);
        points.active = points.active & (totals.transmittance > min_transmittance);
        if (!any(points.active)) {
            if (!any(totals.transmittance > min_transmittance)) break;
            continue;
        }
        const Floats extinction = extinction_at(frame, points, packet);
        points.active = points.active & (extinction > 0.0f);
        taken = taken + select(points.active, 1.0f, 0.0f);
        if (!any(points.active)) continue;

        // Radiance at the eye from a source of 1 per meter in this step.
        const Floats depth = extinction * points.length;
        Floats weight = totals.transmittance * points.length * mean_transmittance(depth);
        if (styled) {
            const Floats seen = exp(-totals.depth * frame.style.view_depth);
            weight = seen * points.length * mean_transmittance(depth * frame.style.view_depth) *
                     style_fade(frame.style, frame.camera, points.position);
        }
        const auto extinction_of = [&](size_t m) HWY_ATTR { return packet.extinction(m); };
        const FluenceGrid* fluence = frame.fluence.get();
        totals.radiance =
            totals.radiance +
            other_source(frame.snapshot, fluence, points.position, packet.direction, extinction_of) * weight;
        for (size_t i = 0; !batch.parts.empty() && i < other_lights; ++i) {
            const OtherLight other{i};
            add_part(other_source(other, frame.snapshot, fluence, points.position, packet.direction, extinction_of) *
                         weight,
                     batch.index_of(other), batch);
        }
        for (size_t light = 0; light < light_count; ++light) {
            const Vec3s added = scattered_from(frame, light, points, packet, batch, k) * weight;
            totals.radiance = totals.radiance + added;
            add_part(added, light, batch);
        }
        totals.depth = totals.depth + depth;
        totals.transmittance = exp(-totals.depth);
    }

    store_results({totals.radiance, totals.transmittance, 1.0f, taken}, results.first(batch.rays.size()));
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(march_packet_kernel);
void march_packet(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(march_packet_kernel)(frame, batch, results);
}
}
#endif
