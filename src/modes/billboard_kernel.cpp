#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/billboard_kernel.cpp"
#include <hwy/foreach_target.h>

#include "modes/billboard.h"

#include "base/simd.h"
#include "modes/style.h"
#include "trace/light_depth_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
struct Packet {
    Vec3s origin, direction;
    Floats t_max, before; // length, and the way from the eye to the origin
};

// Where rays meet a card: along the beam 0..1 and in metres, across it -1..1.
struct OnCard {
    Mask16 met;
    Floats t, share, along, across, half;
    Vec3s point;
};

HWY_INLINE Floats smooth(float low, float high, const Floats& x) {
    const Floats s = max(min((x - low) * (1 / std::max(high - low, 1e-6f)), 1.0f), 0.0f);
    return s * s * (3.0f - 2.0f * s);
}

// Random numbers 0..1 of lattice points.
HWY_INLINE Floats random16(const Ints& x, const Ints& y, int32_t seed) {
    Ints h = x * 374761393 + y * 668265263 + seed * 69069;
    h = (h ^ shift_right<13>(h)) * 1274126177;
    h = h ^ shift_right<16>(h);
    return to_floats(h & 0xffff) * (1.0f / 65535);
}

// Value noise 0..1 in two dimensions.
HWY_INLINE Floats value_noise(const Floats& x, const Floats& y, int32_t seed) {
    const Floats fx = floor(x), fy = floor(y);
    const Ints i = truncate(fx), j = truncate(fy);
    const Floats u = x - fx, v = y - fy;
    const Floats su = u * u * (3.0f - 2.0f * u), sv = v * v * (3.0f - 2.0f * v);
    const Floats low = mixed(random16(i, j, seed), random16(i + 1, j, seed), su);
    const Floats high = mixed(random16(i, j + 1, seed), random16(i + 1, j + 1, seed), su);
    return mixed(low, high, sv);
}

Packet make_packet(const Billboards& billboards, const RayBatch& batch) {
    alignas(64) float v[8][16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = ray.origin[axis], v[3 + axis][lane] = ray.direction[axis];
        v[6][lane] = lane < batch.rays.size() ? ray.t_max : 0;
        v[7][lane] = glm::dot(ray.origin - billboards.eye, ray.direction);
    }
    return {
        {load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])}, load(v[6]), max(load(v[7]), 0.0f)};
}

OnCard meet(const Packet& packet, const CardQuad& quad) {
    OnCard on;
    const Floats slope = dot(packet.direction, splat(quad.normal));
    const Mask16 level = abs(slope) < 1e-6f;
    on.t = dot(splat(quad.start) - packet.origin, splat(quad.normal)) / select(level, 1.0f, slope);
    on.point = fused(packet.direction, on.t, packet.origin);
    const Vec3s off = on.point - splat(quad.start);
    on.along = dot(off, splat(quad.along)), on.share = on.along * (1 / quad.length);
    on.half = max(fused(on.share, quad.half_to - quad.half_from, quad.half_from), 1e-5f);
    on.across = dot(off, splat(quad.side)) / on.half;
    on.met = (!level) & (on.t > 0.0f) & (on.t < packet.t_max) & (on.share > 0.0f) & (on.share < 1.0f) &
             (abs(on.across) < 1.0f);
    return on;
}

// Random stripes along the beam, coarse and fine, that change slowly on their way: 0..1.
HWY_INLINE Floats streaks(const Billboards& billboards, const CardQuad& quad, const OnCard& on) {
    const BillboardSettings& s = billboards.settings;
    const int32_t seed = static_cast<int32_t>(quad.seed * 1000);
    const Floats moved = (on.along - s.scroll * billboards.seconds) * 0.7f;
    // Narrow cards have fewer stripes: none thinner than on a card 40 cm wide.
    const float stripes = s.stripes * std::clamp(std::max(quad.half_from, quad.half_to) * (1 / 0.2f), 0.15f, 1.0f);
    const Floats x = fused(on.across, 0.5f * stripes, quad.seed);
    const Floats coarse = value_noise(x * 0.37f, moved * 0.5f, seed), fine = value_noise(x, moved, seed + 1);
    const Floats both = min(coarse * 0.6f + fine * 0.4f, 1.0f);
    const Floats light = smooth(0.2f, 0.8f, both);
    return fused(light - 1.0f, s.streaks, 1.0f);
}

// Dust: round dots in some cells of a grid that drifts along and across the beam, never smaller than a pixel.
HWY_INLINE Floats specks(const Billboards& billboards, const CardQuad& quad, const OnCard& on, const Packet& packet) {
    constexpr float cell = 0.11f, radius = 0.004f, populated = 0.35f; // metres, metres, share of cells
    const float time = billboards.seconds;
    const int32_t seed = static_cast<int32_t>(quad.seed * 1000) + 7;
    const Floats x = (on.across * on.half + 0.02f * std::sin(0.7f * time + quad.seed)) * (1 / cell);
    const Floats y = (on.along - 2 * billboards.settings.scroll * time) * (1 / cell);
    const Floats fx = floor(x), fy = floor(y);
    const Ints i = truncate(fx), j = truncate(fy);
    const Floats dx = (x - fx) - mixed(0.3f, 0.7f, random16(i, j, seed));
    const Floats dy = (y - fy) - mixed(0.3f, 0.7f, random16(i, j, seed + 1));
    const Floats pixel = (on.t + packet.before) * (0.9f * billboards.pixel);
    const Floats size = min(max(pixel, radius) * (1 / cell), 0.3f);
    const Floats dim = min(radius * radius / max(pixel * pixel, 1e-12f), 1.0f); // of dots held at a pixel's size
    const Floats off = fused(dx, dx, dy * dy) / (size * size);
    const Floats chance = random16(i, j, seed + 2);
    const Floats bright = zero_unless(chance < populated, chance * (1 / populated));
    return bright * dim * max(1.0f - off, 0.0f);
}

// Share of the card's brightness that its soft borders, surfaces close behind and fades leave.
HWY_INLINE Floats mask(const Billboards& billboards, const CardQuad& quad, const OnCard& on, const Packet& packet) {
    const BillboardSettings& s = billboards.settings;
    const Floats away = on.t + packet.before;
    Floats share = 1.0f - smooth(1 - s.soft, 1, abs(on.across));
    share = share * smooth(0, 0.06f, on.share) * (1.0f - smooth(0.8f, 1, on.share));
    if (s.soft_depth > 0) share = share * smooth(0, s.soft_depth, packet.t_max - on.t);
    if (s.near_fade > 0) share = share * smooth(0.25f * s.near_fade, s.near_fade, away);
    share = share * (1.0f - smooth(0.5f * s.far_fade, s.far_fade, away));
    const Floats facing = abs(dot(packet.direction, splat(quad.normal)));
    // Of two crossed cards sin² + cos² is seen, whatever side they are seen from.
    share = share * (quad.crossed ? facing : smooth(0, 0.75f, facing));
    if (billboards.style.range < 1e6f)
        share = share * max(min((billboards.style.range - away) * (1 / (0.2f * billboards.style.range)), 1.0f), 0.0f);
    return share;
}

// How far a ray runs inside the beam: the chord of its elliptic cross-section, longer on a slant.
HWY_INLINE Floats chord(const CardQuad& quad, const OnCard& on, const Packet& packet) {
    const Floats cosine = dot(packet.direction, splat(quad.axis));
    const Floats sine = sqrt(max(1.0f - cosine * cosine, 1e-4f));
    const Floats a = fused(on.share, quad.width_to.x - quad.width_from.x, quad.width_from.x);
    const Floats b = fused(on.share, quad.width_to.y - quad.width_from.y, quad.width_from.y);
    const Floats x = dot(packet.direction, splat(quad.across[0])) / max(a, 1e-6f);
    const Floats y = dot(packet.direction, splat(quad.across[1])) / max(b, 1e-6f);
    const Floats middle = 2.0f / max(sqrt(fused(x, x, y * y)), 1e-6f);
    return min(middle, quad.length + 4.0f * on.half / sine);
}

// Radiance per unit of the light's intensity, by an even beam in even fog: J (1 - e^-σc).
Vec3s beam_light(const Billboards& billboards, const CardQuad& quad, const OnCard& on, const Packet& packet) {
    const Light& light = billboards.snapshot.lights[quad.light];
    const bool sun = light.kind == LightKind::sun;
    const LightPaths to_light = light_paths(light, on.point), to_eye{packet.origin, packet.direction, on.t};
    Floats extinction = 0.0f, depth = 0.0f;
    Vec3s scattered = splat(vec3(0));
    const Floats cosine = dot(to_light.direction, packet.direction);
    for (const Medium& medium : billboards.snapshot.media) {
        const Floats here = density16(medium, on.point) * medium.optics.extinction;
        extinction = extinction + here;
        scattered = fused(splat(medium.optics.albedo), here * phase_value(medium.optics.phase, cosine), scattered);
        depth = depth + analytic_depth16(medium, to_light) * billboards.style.light_depth;
        if (billboards.settings.fog) depth = depth + analytic_depth16(medium, to_eye) * billboards.style.view_depth;
    }
    Floats arriving = 1.0f;
    if (!sun) {
        // Close to the light cards stay as bright as 15 cm away from it.
        const float reach = std::max(light.radius, 0.15f);
        const Vec3s towards = splat(light.position) - on.point;
        const Floats square = dot(towards, towards);
        arriving = 1.0f / max(square, reach * reach);
        if (!std::isinf(light.range)) {
            const Floats share = square * (1 / (light.range * light.range));
            arriving = arriving * max(1.0f - share * share, 0.0f);
        }
    }
    const Floats length = chord(quad, on, packet);
    return scattered * (arriving * exp(-depth) * length * mean_transmittance(extinction * length));
}

// Light of a sun in the open, per unit of its intensity: single scattering of even fog without shadows, in three
// pieces of the way through fog, the nearest the shortest.
Vec3s veil_light(const Billboards& billboards, const Light& light, const Packet& packet) {
    const StyleSettings& style = billboards.style;
    Floats low = infinity, high = 0.0f;
    for (const Medium& medium : billboards.snapshot.media) {
        const Ranges in = inside_box(medium, {packet.origin, packet.direction, packet.t_max});
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
        const Floats to = fused(high - low, share, low), middle = 0.5f * (from + to);
        const LightPaths piece{fused(packet.direction, from, packet.origin), packet.direction, to - from};
        const LightPaths to_sun = light_paths(light, fused(packet.direction, middle, packet.origin));
        Vec3s scattered = splat(vec3(0));
        Floats change = 0.0f, light_depth = 0.0f;
        for (const Medium& medium : billboards.snapshot.media) {
            const Floats part = analytic_depth16(medium, piece);
            scattered = fused(splat(medium.optics.albedo), part * phase_value(medium.optics.phase, cosine), scattered);
            change = change + part, light_depth = light_depth + analytic_depth16(medium, to_sun);
        }
        const float dimmed = billboards.settings.fog ? style.view_depth : 0;
        Floats arriving =
            exp(-(depth * dimmed + light_depth * style.light_depth)) * mean_transmittance(change * dimmed);
        if (style.range < 1e6f)
            arriving =
                arriving * max(min((style.range - middle - packet.before) * (1 / (0.2f * style.range)), 1.0f), 0.0f);
        sum = sum + scattered * zero_unless(foggy, arriving);
        depth = depth + change, from = to;
    }
    return sum;
}

void billboard_packet_kernel(const Billboards& billboards, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local std::vector<std::array<float, 64>> light_sums; // per light: r, g, b and the brightest card
    const Snapshot& snapshot = billboards.snapshot;
    const size_t lights = snapshot.lights.size();
    light_sums.assign(lights, {});
    const Packet packet = make_packet(billboards, batch);
    Floats drawn = 0.0f;
    for (const CardQuad& quad : billboards.quads) {
        const OnCard on = meet(packet, quad);
        if (!any(on.met)) continue;
        const Floats share = zero_unless(on.met, mask(billboards, quad, on, packet)) * quad.share;
        if (!any(share > 0.0f)) continue;
        Floats texture = streaks(billboards, quad, on);
        if (billboards.settings.specks > 0)
            texture = fused(specks(billboards, quad, on, packet), 6 * billboards.settings.specks, texture);
        const Vec3s light = beam_light(billboards, quad, on, packet) * splat(quad.tint);
        const Vec3s added = light * zero_unless(on.met, share * texture);
        float* sums = light_sums[quad.light].data();
        const Floats brightest = max(load(sums + 48), zero_unless(on.met, max(max(light.x, light.y), light.z)));
        store(load(sums) + added.x, sums), store(load(sums + 16) + added.y, sums + 16);
        store(load(sums + 32) + added.z, sums + 32), store(brightest, sums + 48);
        drawn = max(drawn, share);
    }

    static thread_local std::vector<std::array<float, 48>> veils; // per light: r, g, b
    veils.assign(lights, {});
    for (size_t l = 0; l < lights; ++l) {
        if (!(billboards.veils[l] > 0)) continue;
        const Vec3s veil = veil_light(billboards, snapshot.lights[l], packet) * splat(vec3(billboards.veils[l]));
        store(veil.x, veils[l].data()), store(veil.y, veils[l].data() + 16), store(veil.z, veils[l].data() + 32);
    }

    Floats depth = 0.0f;
    for (const Medium& medium : snapshot.media)
        depth = depth + analytic_depth16(medium, {packet.origin, packet.direction, packet.t_max});
    alignas(64) float transmittance[16], is_drawn[16];
    store(exp(-depth), transmittance), store(drawn, is_drawn);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        Scatter& result = results[lane];
        result = {};
        result.transmittance = billboards.settings.fog ? transmittance[lane] : 1.0f;
        result.validity = is_drawn[lane] > 0 ? 0.0f : 0.5f;
        for (size_t l = 0; l < lights; ++l) {
            const auto& sums = light_sums[l];
            vec3 light(sums[lane], sums[16 + lane], sums[32 + lane]);
            // However many cards lie over each other, a light is at most twice as bright as its brightest beam.
            const float bound = 2 * sums[48 + lane] * std::max(billboards.settings.brightness, 1.0f);
            const float most = max_component(light);
            if (most > bound && most > 0) light *= bound / most;
            light += vec3(veils[l][lane], veils[l][16 + lane], veils[l][32 + lane]);
            light *= snapshot.lights[l].intensity * snapshot.lights[l].volume_scale;
            result.radiance += light;
            if (!batch.per_light.empty()) batch.per_light[lane * lights + l] += light;
        }
    }
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
