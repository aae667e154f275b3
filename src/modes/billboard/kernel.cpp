#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/billboard/kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/billboard/billboard.h"

#include "base/simd/simd.h"
#include "integrate/batch_simd.h"
#include "integrate/scattering_simd.h"
#include "modes/billboard/card_simd.h"
#include "modes/billboard/reach_simd.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

#include <array>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
Packet make_packet(const Billboards& billboards, const RayBatch& batch) {
    const Rays16 rays = rays_of(batch);
    alignas(64) float before[16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        before[lane] = glm::dot(ray.origin - billboards.camera.position, ray.direction);
    }
    return {rays.origin, rays.direction, rays.t_max, max(load(before), 0.0f)};
}

// Radiance, per unit of the light's intensity, of a uniformly lit beam in homogeneous fog: J (1 - e^-σc) for a chord c.
Vec3s beam_light(const Billboards& billboards, const CardQuad& quad, const CardHit& hit, const Packet& packet) {
    const Light& light = billboards.snapshot.lights[quad.light];
    const bool sun = is_distant(light);
    const Segments16 to_light = light_segments(light, hit.point), to_eye{packet.origin, packet.direction, hit.t};
    Floats extinction = 0.0f, depth = 0.0f;
    const std::vector<Medium>& media = billboards.snapshot.media;
    const Vec3s scattered = scattering(media, dot(to_light.direction, packet.direction), [&](size_t m) HWY_ATTR {
        const Floats here = density16(media[m], hit.point) * gray_extinction(media[m].optics);
        extinction = extinction + here;
        return here;
    });
    for (const Medium& medium : media) {
        depth = depth + analytic_depth16(medium, to_light) * billboards.style.light_depth;
        if (billboards.settings.fog) depth = depth + analytic_depth16(medium, to_eye) * billboards.style.view_depth;
    }
    Floats arriving = 1.0f;
    if (!sun) {
        // Within 0.15 units of the light, cards are as bright as at 0.15 units.
        const float reach = std::max(light.radius, 0.15f * card_unit(quad));
        const Vec3s towards = splat(light.position) - hit.point;
        const Floats square = dot(towards, towards);
        arriving = 1.0f / max(square, reach * reach);
        if (!std::isinf(light.range)) {
            const Floats share = square * (1 / (light.range * light.range));
            arriving = arriving * max(1.0f - share * share, 0.0f);
        }
    }
    const Floats length = chord(quad, hit, packet);
    return scattered * (arriving * exp(-depth) * length * mean_transmittance(extinction * length));
}

// Haze of a sun in the open, per unit of its intensity: unshadowed single scattering in homogeneous fog, in three
// segments of the ray, the nearest the shortest.
Vec3s veil_light(const Billboards& billboards, const Light& light, const Packet& packet) {
    const StyleSettings& style = billboards.style;
    Floats low = infinity, high = 0.0f;
    for (const Medium& medium : billboards.snapshot.media) {
        const Interval<Floats> in = inside_box(medium, {packet.origin, packet.direction, packet.t_max});
        const Mask16 there = in.high > in.low;
        low = select(there, min(low, in.low), low), high = select(there, max(high, in.high), high);
    }
    const Mask16 foggy = high > low;
    if (!any(foggy)) return splat(vec3(0));
    low = zero_unless(foggy, low), high = zero_unless(foggy, high);
    const Floats cosine = -dot(packet.direction, splat(light.direction));
    Vec3s sum = splat(vec3(0));
    Floats depth = 0.0f, from = low;
    for (const float share : {1.0f / 9, 4.0f / 9, 1.0f}) {
        const Floats to = fma(high - low, share, low), middle = 0.5f * (from + to);
        const Segments16 piece{fma(packet.direction, from, packet.origin), packet.direction, to - from};
        const Segments16 to_sun = light_segments(light, fma(packet.direction, middle, packet.origin));
        Floats change = 0.0f, light_depth = 0.0f;
        const std::vector<Medium>& media = billboards.snapshot.media;
        const Vec3s scattered = scattering(media, cosine, [&](size_t m) HWY_ATTR {
            const Floats part = analytic_depth16(media[m], piece);
            change = change + part, light_depth = light_depth + analytic_depth16(media[m], to_sun);
            return part;
        });
        const float dimmed = billboards.settings.fog ? style.view_depth : 0;
        Floats arriving =
            exp(-(depth * dimmed + light_depth * style.light_depth)) * mean_transmittance(change * dimmed);
        if (fades(style))
            arriving =
                arriving * max(min((style.range - middle - packet.before) * (1 / (0.2f * style.range)), 1.0f), 0.0f);
        sum = sum + scattered * zero_unless(foggy, arriving);
        depth = depth + change, from = to;
    }
    return sum;
}

using Sixteen = std::array<float, 16>;

// A thread's sums for one light, reused from packet to packet: plain floats, for 16 rays each.
struct LightSum {
    Sixteen cards[3]{}, brightest{};
};

HWY_INLINE Vec3s loaded(const Sixteen (&from)[3]) {
    return {load(from[0].data()), load(from[1].data()), load(from[2].data())};
}

// Adds a card's radiance along the rays to its light's sum; returns the mask factor of each ray.
HWY_INLINE Floats draw(const Billboards& billboards, const CardQuad& quad, const Packet& packet, LightSum& sum) {
    const CardHit hit = intersect(packet, quad);
    if (!any(hit.met)) return 0.0f;
    const Floats share = zero_unless(hit.met, mask(billboards, quad, hit, packet)) * quad.share;
    if (!any(share > 0.0f)) return 0.0f;
    Floats texture = streaks(billboards, quad, hit);
    if (billboards.settings.specks > 0)
        texture = fma(specks(billboards, quad, hit, packet), 6 * billboards.settings.specks, texture);
    const Vec3s light = beam_light(billboards, quad, hit, packet) * splat(quad.tint);
    const Floats brightest = zero_unless(hit.met, max(max(light.x, light.y), light.z));
    const Vec3s total = loaded(sum.cards) + light * zero_unless(hit.met, share * texture);
    store(total.x, sum.cards[0].data()), store(total.y, sum.cards[1].data()), store(total.z, sum.cards[2].data());
    store(max(load(sum.brightest.data()), brightest), sum.brightest.data());
    return share;
}

// Total radiance of one light, per unit of its intensity. Overlapping cards are clamped to twice the brightest beam.
HWY_INLINE Vec3s whole_light(const Billboards& billboards, size_t index, const LightSum& sum, const Packet& packet) {
    const Vec3s cards = loaded(sum.cards);
    const Floats bound = load(sum.brightest.data()) * (2 * std::max(billboards.settings.brightness, 1.0f));
    const Floats brightness = max(max(cards.x, cards.y), cards.z);
    const Vec3s bounded = cards * select(brightness > bound, bound / max(brightness, 1e-30f), 1.0f);
    const float veil = billboards.veils[index];
    if (!(veil > 0)) return bounded;
    return bounded + veil_light(billboards, billboards.snapshot.lights[index], packet) * veil;
}

void billboard_packet_kernel(const Billboards& billboards, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local std::vector<LightSum> sums;
    const Snapshot& snapshot = billboards.snapshot;
    const size_t lights = snapshot.lights.size();
    sums.assign(lights, {});
    const Packet packet = make_packet(billboards, batch);
    const RayBounds spread = ray_bounds(packet, billboards.camera);
    Floats drawn = 0.0f;
    for (size_t group = 0; group < billboards.groups.size(); ++group)
        for (uint32_t bits = within_reach(billboards.groups[group], spread); bits; bits &= bits - 1) {
            const CardQuad& quad = billboards.quads[16 * group + static_cast<size_t>(std::countr_zero(bits))];
            drawn = max(drawn, draw(billboards, quad, packet, sums[static_cast<size_t>(quad.light)]));
        }

    Vec3s radiance = splat(vec3(0));
    for (size_t l = 0; l < lights; ++l) {
        const Light& light = snapshot.lights[l];
        const Vec3s part = whole_light(billboards, l, sums[l], packet) * splat(light.intensity * light.volume_scale);
        radiance = radiance + part;
        add_part(part, l, batch);
    }
    Floats depth = 0.0f;
    if (billboards.settings.fog)
        for (const Medium& medium : snapshot.media)
            depth = depth + analytic_depth16(medium, {packet.origin, packet.direction, packet.t_max});
    store_results({radiance, exp(-depth), select(drawn > 0.0f, 0.0f, 0.5f), 0.0f}, results.first(batch.rays.size()));
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(billboard_packet_kernel);
void billboard_packet(const Billboards& billboards, const RayBatch& batch, std::span<Scatter> results) {
    HWY_DYNAMIC_DISPATCH(billboard_packet_kernel)(billboards, batch, results);
}
}
#endif
