// Intersection of rays with a beam card, and the card's texture and masks there (see base/simd/simd.h for how such
// files are compiled).
#if defined(TYNDALL_MODES_BILLBOARD_CARD_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_BILLBOARD_CARD_SIMD_H
#undef TYNDALL_MODES_BILLBOARD_CARD_SIMD_H
#else
#define TYNDALL_MODES_BILLBOARD_CARD_SIMD_H
#endif

#include "base/simd/simd.h"
#include "modes/billboard/billboard.h"
#include "modes/billboard/settings.h"
#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
struct Packet {
    Vec3s origin, direction;
    Floats t_max, before; // length, and distance from the eye to the origin
};

// Intersections of rays with a card. Along the beam: 0..1 (share) and meters; across it: -1..1; `half`: half width
// there.
struct CardHit {
    Mask16 met;
    Floats t, share, along, across, half;
    Vec3s point;
};

HWY_INLINE Floats smoothstep(float low, float high, const Floats& x) {
    const Floats s = max(min((x - low) * (1 / std::max(high - low, 1e-6f)), 1.0f), 0.0f);
    return s * s * (3.0f - 2.0f * s);
}

// Random numbers 0..1 of lattice points.
HWY_INLINE Floats random16(const Ints& x, const Ints& y, int32_t seed) {
    Ints h = x * 374761393 + y * 668265263 + static_cast<int32_t>(static_cast<uint32_t>(seed) * 69069u);
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
    const Floats low = lerp(random16(i, j, seed), random16(i + 1, j, seed), su);
    const Floats high = lerp(random16(i, j + 1, seed), random16(i + 1, j + 1, seed), su);
    return lerp(low, high, sv);
}

// Intersects rays with a card's plane; `met` marks hits inside the card.
HWY_INLINE CardHit intersect(const Packet& packet, const CardQuad& quad) {
    CardHit hit;
    const Floats slope = dot(packet.direction, splat(quad.normal));
    const Mask16 level = abs(slope) < 1e-6f;
    hit.t = dot(splat(quad.start) - packet.origin, splat(quad.normal)) / select(level, 1.0f, slope);
    hit.point = fma(packet.direction, hit.t, packet.origin);
    const Vec3s off = hit.point - splat(quad.start);
    hit.along = dot(off, splat(quad.along)), hit.share = hit.along * (1 / quad.length);
    hit.half = max(fma(hit.share, quad.half_to - quad.half_from, quad.half_from), 1e-6f * quad.length);
    hit.across = dot(off, splat(quad.side)) / hit.half;
    hit.met = (!level) & (hit.t > 0.0f) & (hit.t < packet.t_max) & (hit.share > 0.0f) & (hit.share < 1.0f) &
              (abs(hit.across) < 1.0f);
    return hit;
}

// Unit length of the textures: a fifth of the beam.
inline float card_unit(const CardQuad& quad) { return 0.2f * quad.length; }

// Random streaks along the beam, coarse and fine, that vary slowly along it: 0..1.
HWY_INLINE Floats streaks(const Billboards& billboards, const CardQuad& quad, const CardHit& hit) {
    const BillboardSettings& s = billboards.settings;
    const int32_t seed = static_cast<int32_t>(quad.seed * 1000);
    const Floats moved = (hit.along - s.scroll * billboards.seconds) * (0.7f / card_unit(quad));
    // Narrow cards have fewer stripes: none thinner than on a card 0.4 units wide.
    const float widest = std::max(quad.half_from, quad.half_to) / card_unit(quad);
    const float stripes = s.stripes * std::clamp(widest * (1 / 0.2f), 0.15f, 1.0f);
    const Floats x = fma(hit.across, 0.5f * stripes, quad.seed);
    const Floats coarse = value_noise(x * 0.37f, moved * 0.5f, seed), fine = value_noise(x, moved, seed + 1);
    const Floats both = min(coarse * 0.6f + fine * 0.4f, 1.0f);
    const Floats light = smoothstep(0.2f, 0.8f, both);
    return fma(light - 1.0f, s.streaks, 1.0f);
}

// Dust: round dots in some cells of a grid that drifts along and across the beam, never smaller than a pixel.
HWY_INLINE Floats specks(const Billboards& billboards, const CardQuad& quad, const CardHit& hit, const Packet& packet) {
    const float cell = 0.11f * card_unit(quad), radius = 0.04f * cell;
    constexpr float populated = 0.35f; // fraction of cells
    const float time = billboards.seconds;
    const int32_t seed = static_cast<int32_t>(quad.seed * 1000) + 7;
    const Floats x = (hit.across * hit.half + 0.2f * cell * std::sin(0.7f * time + quad.seed)) * (1 / cell);
    const Floats y = (hit.along - 2 * billboards.settings.scroll * time) * (1 / cell);
    const Floats fx = floor(x), fy = floor(y);
    const Ints i = truncate(fx), j = truncate(fy);
    const Floats dx = (x - fx) - lerp(0.3f, 0.7f, random16(i, j, seed));
    const Floats dy = (y - fy) - lerp(0.3f, 0.7f, random16(i, j, seed + 1));
    const Floats away = billboards.camera.ortho_height > 0 ? Floats(1.0f) : hit.t + packet.before;
    const Floats pixel = away * (0.9f * billboards.pixel);
    const Floats size = min(max(pixel, radius) * (1 / cell), 0.3f);
    const Floats dim = min(radius * radius / max(pixel * pixel, 1e-12f), 1.0f); // for dots enlarged to a pixel
    const Floats off = fma(dx, dx, dy * dy) / (size * size);
    const Floats chance = random16(i, j, seed + 2);
    const Floats bright = zero_unless(chance < populated, chance * (1 / populated));
    return bright * dim * max(1.0f - off, 0.0f);
}

// Factor on a card's brightness: soft borders, fade in front of surfaces (soft particles), and near, far and edge-on
// fades.
HWY_INLINE Floats mask(const Billboards& billboards, const CardQuad& quad, const CardHit& hit, const Packet& packet) {
    const BillboardSettings& s = billboards.settings;
    const Floats away = hit.t + packet.before;
    Floats share = 1.0f - smoothstep(1 - s.soft, 1, abs(hit.across));
    share = share * smoothstep(0, 0.06f, hit.share) * (1.0f - smoothstep(0.8f, 1, hit.share));
    if (s.soft_depth > 0) share = share * smoothstep(0, s.soft_depth, packet.t_max - hit.t);
    if (s.near_fade > 0) share = share * smoothstep(0.25f * s.near_fade, s.near_fade, away);
    share = share * (1.0f - smoothstep(0.5f * s.far_fade, s.far_fade, away));
    const Floats facing = abs(dot(packet.direction, splat(quad.normal)));
    // Projected width times this factor sums to sin² + cos² = 1 over two crossed cards, from any side.
    share = share * (quad.crossed ? facing : smoothstep(0, 0.75f, facing));
    if (fades(billboards.style))
        share = share * max(min((billboards.style.range - away) * (1 / (0.2f * billboards.style.range)), 1.0f), 0.0f);
    return share;
}

// Length of a ray inside the beam: the chord of its elliptical cross-section, longer at grazing angles.
HWY_INLINE Floats chord(const CardQuad& quad, const CardHit& hit, const Packet& packet) {
    const Floats cosine = dot(packet.direction, splat(quad.axis));
    const Floats sine = sqrt(max(1.0f - cosine * cosine, 1e-4f));
    const Floats a = fma(hit.share, quad.width_to.x - quad.width_from.x, quad.width_from.x);
    const Floats b = fma(hit.share, quad.width_to.y - quad.width_from.y, quad.width_from.y);
    const Floats x = dot(packet.direction, splat(quad.across[0])) / max(a, 1e-6f);
    const Floats y = dot(packet.direction, splat(quad.across[1])) / max(b, 1e-6f);
    const Floats middle = 2.0f / max(sqrt(fma(x, x, y * y)), 1e-6f);
    return min(middle, quad.length + 4.0f * hit.half / sine);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
