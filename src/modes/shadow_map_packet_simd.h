// The packet of the march with shadow maps, and what suns and local lights ask of it (see base/simd.h for how such
// files are compiled).
#if defined(TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#undef TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#else
#define TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#endif

#include "base/simd.h"
#include "modes/shadow_map_kernel.h"
#include "modes/style_simd.h"
#include "trace/light_depth_simd.h"
#include "trace/light_simd.h"
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
    std::vector<float> weight;       // of each step: its length, times what the eye sees of it
    std::vector<Sixteen> extinction; // of each medium in each step: [step · media + medium]
    std::vector<Sixteen> glowing;    // ∫ of what each medium scatters of even light, before its albedo
    std::vector<Sixteen> scattered;  // the same of each light, by each medium: [light · media + medium]
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
    HWY_INLINE Vec3s at(const Floats& t) const { return fused(direction, t, origin); }
    size_t media() const { return march.snapshot.media.size(); }
    size_t lights() const { return march.snapshot.lights.size(); }
};

HWY_INLINE void add(const Floats& value, Sixteen& sum) { store(load(sum.data()) + value, sum.data()); }

Packet make_packet(const ShadowMapMarch& march, const RayBatch& batch, Scratch& scratch) {
    alignas(64) float v[6][16] = {}, jitter[16];
    const int steps = march.settings.steps;
    const size_t media = march.snapshot.media.size(), lights = march.snapshot.lights.size();
    scratch.border.assign(16 * static_cast<size_t>(steps + 1), 0);
    scratch.depth.resize(scratch.border.size()), scratch.weight.resize(scratch.border.size());
    scratch.extinction.resize(media * static_cast<size_t>(steps + 1));
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

// Extinction of all media at the points; `each` remembers them one by one.
HWY_INLINE Floats extinction_at(const Packet& packet, const Vec3s& position, Sixteen* each) {
    Floats total = 0.0f;
    for (size_t m = 0; m < packet.media(); ++m) {
        const Medium& medium = packet.march.snapshot.media[m];
        const Floats extinction = density16(medium, position) * medium.optics.extinction;
        store(extinction, each[m].data());
        total = total + extinction;
    }
    return total;
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
}
}
HWY_AFTER_NAMESPACE();
#endif
