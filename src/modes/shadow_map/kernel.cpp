#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/shadow_map/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/shadow_map/kernel.h"

#include "modes/shadow_map/local_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Steps along the rays: transmittance, and the weights for emission and ambient light.
struct Totals {
    Floats transmittance, taken;
};
Totals march_rays(const Packet& packet) {
    Totals totals{1.0f, 0.0f};
    Scratch& scratch = packet.scratch;
    Sixteen* extinctions = scratch.extinction.data();
    Floats depth = 0.0f;
    store(depth, scratch.depth.data());
    for (int k = 0; k < packet.steps; ++k, extinctions += packet.media()) {
        const Floats low = packet.border(k), length = packet.border(k + 1) - low;
        const Vec3s position = packet.at(fma(packet.jitter, length, low));
        const Floats extinction = extinction_at(packet, position, extinctions), inside = extinction * length;
        const Mask16 active = inside > 0.0f;
        Floats weight = 0.0f;
        if (any(active)) {
            totals.taken = totals.taken + select(active, 1.0f, 0.0f);
            const Floats mean = mean_transmittance(inside);
            weight =
                zero_unless(active, view_weight(packet, totals.transmittance, depth, inside, mean, position) * length);
            for (size_t m = 0; m < packet.media(); ++m) add(load(extinctions[m].data()) * weight, scratch.isotropic[m]);
            depth = depth + inside;
            totals.transmittance = totals.transmittance * (1.0f - inside * mean); // e^-D = 1 - D·mean(D)
        }
        store(weight, scratch.weight.data() + 16 * k), store(depth, scratch.depth.data() + 16 * (k + 1));
    }
    totals.transmittance = exp(-depth);
    return totals;
}

// Sunlight scattered at the steps of the rays. The phase function is constant along a ray.
void march_sun(const Packet& packet, size_t index) {
    const Scratch& scratch = packet.scratch;
    const RaysInMap rays(packet, index);
    const int lookups = rays.map.empty() ? 1 : map_lookups;
    const float part = 1 / static_cast<float>(lookups);
    Sixteen* scattered = packet.scratch.scattered.data() + index * packet.media();
    const Lit* lit_steps = scratch.lit.data() + index * static_cast<size_t>(packet.steps);
    for (int k = 0; k < packet.steps; ++k) {
        const Lit is_lit = lit_steps[k];
        const Floats weight = load(scratch.weight.data() + 16 * k);
        if (is_lit == Lit::none || !any(weight > 0.0f)) continue;
        const Floats low = packet.border(k), length = packet.border(k + 1) - low;
        Floats share = is_lit == Lit::all ? static_cast<float>(lookups) : 0.0f;
        for (int i = 0; i < lookups && is_lit == Lit::some; ++i)
            share = share + rays.lit_share(fma((packet.jitter + static_cast<float>(i)) * part, length, low));
        share = share * weight;
        const Mask16 lit = share > 0.0f;
        if (!any(lit)) continue;
        const Vec3s position = packet.at(fma(packet.jitter, length, low));
        const Floats arriving = share * part * exp(-light_depth16(packet.march.depths[index], position, lit));
        for (size_t m = 0; m < packet.media(); ++m)
            add(load(scratch.extinction[static_cast<size_t>(k) * packet.media() + m].data()) * arriving, scattered[m]);
    }
    const Floats cosine = dot(splat(-packet.march.snapshot.lights[index].direction), packet.direction);
    for (size_t m = 0; m < packet.media(); ++m)
        store(load(scattered[m].data()) * phase_value(packet.march.snapshot.media[m].optics.phase, cosine),
              scattered[m].data());
}

// Multiplies scattered amounts by albedos and light intensities, and sums them to one ray's radiance.
void color_ray(const Packet& packet, size_t lane, Scatter& result) {
    const Snapshot& snapshot = packet.march.snapshot;
    const RayBatch& batch = packet.batch;
    const bool apart = !batch.parts.empty();
    result.radiance = vec3(0);
    for (size_t m = 0; m < packet.media(); ++m) {
        const Optics& optics = snapshot.media[m].optics;
        const float isotropic = packet.scratch.isotropic[m][lane];
        result.radiance += source_radiance(optics, snapshot.ambient) * isotropic;
        if (!apart) continue;
        batch.part(lane, batch.index_of(OtherLight::ambient)) += optics.albedo * snapshot.ambient * isotropic;
        batch.part(lane, batch.index_of(OtherLight::emission)) += source_radiance(optics, vec3(0)) * isotropic;
    }
    for (size_t i = 0; i < packet.lights(); ++i) {
        vec3 part(0);
        for (size_t m = 0; m < packet.media(); ++m)
            part += snapshot.media[m].optics.albedo * packet.scratch.scattered[i * packet.media() + m][lane];
        if (!packet.scratch.tinted.empty())
            for (int c = 0; c < 3; ++c) part[c] += packet.scratch.tinted[3 * i + static_cast<size_t>(c)][lane];
        part *= snapshot.lights[i].intensity * snapshot.lights[i].volume_scale;
        result.radiance += part;
        if (apart) batch.part(lane, i) += part;
    }
}

// Validity of a ray's steps: size of the fog's finest detail as a fraction of a step, at most 1.
float validity_of(const ShadowMapMarch& march, float first, float last) {
    const float step = (last - first) / static_cast<float>(march.settings.steps);
    return step > march.detail ? march.detail / step : 1.0f;
}

void march_shadow_maps_kernel(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local Scratch scratch;
    const Packet packet = make_packet(march, batch, scratch);
    find_lit(packet);
    Totals totals = march_rays(packet);
    for (size_t i = 0; i < packet.lights(); ++i)
        is_distant(march.snapshot.lights[i]) ? march_sun(packet, i) : march_light(packet, i, totals.taken);

    alignas(64) float transmittance[16], taken[16], first[16], last[16];
    store(totals.transmittance, transmittance), store(totals.taken, taken);
    store(packet.border(0), first), store(packet.border(packet.steps), last);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        color_ray(packet, lane, results[lane]);
        results[lane].transmittance = transmittance[lane];
        results[lane].validity = validity_of(march, first[lane], last[lane]);
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
