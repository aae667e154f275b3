// The ray packet of the march with shadow maps, and functions shared by suns and local lights (see base/simd/simd.h for
// how such files are compiled).
#if defined(TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#undef TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#else
#define TYNDALL_MODES_SHADOW_MAP_PACKET_SIMD_H
#endif

#include "base/simd/reduce_simd.h"
#include "base/simd/simd.h"
#include "integrate/batch_simd.h"
#include "integrate/style_simd.h"
#include "modes/shadow_map/kernel.h"
#include "scene/light.h"
#include "trace/lights/light_simd.h"
#include "trace/shadows/maps/shadow_map_simd.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/medium_simd.h"
#include "volume/phase_simd.h"

#include <array>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Memory that a thread reuses from packet to packet: plain floats, for 16 rays each.
using Sixteen = std::array<float, 16>;
struct Scratch {
    std::vector<float> border;       // t of the step boundaries
    std::vector<float> depth;        // optical depth from the eye to each boundary
    std::vector<Lit> lit;            // lit by suns, per step: [light · steps + step]
    std::vector<float> weight;       // per step: its length times the fraction of its light that reaches the eye
    std::vector<Sixteen> extinction; // per step and medium: [step · media + medium]
    std::vector<Sixteen> isotropic;  // ∫ of isotropic light scattered by each medium, before its albedo
    std::vector<Sixteen> scattered;  // the same per light and medium: [light · media + medium]
    std::vector<Sixteen> tinted;     // per light with a colored gobo, all media, albedo included: [light · 3 + c]
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
    HWY_INLINE Vec3s at(const Floats& t) const { return fma(direction, t, origin); }
    size_t media() const { return march.snapshot.media.size(); }
    size_t lights() const { return march.snapshot.lights.size(); }
};

HWY_INLINE void add(const Floats& value, Sixteen& sum) { store(load(sum.data()) + value, sum.data()); }

// Intervals of rays inside a world-space box.
HWY_INLINE Interval<Floats> inside_world_box(const Box& box, const Vec3s& origin, const Vec3s& direction,
                                             Interval<Floats> range) {
    clip_axis(origin.x, direction.x, box.low.x, box.high.x, range);
    clip_axis(origin.y, direction.y, box.low.y, box.high.y, range);
    clip_axis(origin.z, direction.z, box.low.z, box.high.z, range);
    return range;
}

// Sets the boundaries of equal steps for all rays; returns false if some ray's fog extends far beyond the scene.
HWY_INLINE bool place_even_steps(const Packet& packet, const Floats& t_max) {
    Interval<Floats> stretch{infinity, 0.0f};
    for (const Medium& medium : packet.march.snapshot.media) {
        const Interval<Floats> inside =
            inside_world_box(medium.world_bounds, packet.origin, packet.direction, {0.0f, t_max});
        const Mask16 crossed = inside.low < inside.high;
        stretch.low = select(crossed, min(stretch.low, inside.low), stretch.low);
        stretch.high = select(crossed, max(stretch.high, inside.high), stretch.high);
    }
    const Mask16 some = stretch.low < stretch.high;
    stretch = {zero_unless(some, stretch.low), zero_unless(some, stretch.high)};
    const Box& bounds = packet.march.snapshot.bounds;
    if (packet.steps >= min_uneven_steps && !bounds.empty()) {
        const Interval<Floats> scene = inside_world_box(bounds, packet.origin, packet.direction, stretch);
        const Mask16 crossed = scene.low < scene.high;
        if (any(crossed & (stretch.high - stretch.low >= (scene.high - scene.low) * 2.0f))) return false;
    }
    const Floats step = (stretch.high - stretch.low) * (1 / static_cast<float>(packet.steps));
    for (int k = 0; k <= packet.steps; ++k)
        store(fma(step, static_cast<float>(k), stretch.low), packet.scratch.border.data() + 16 * k);
    return true;
}

Packet make_packet(const ShadowMapMarch& march, const RayBatch& batch, Scratch& scratch) {
    const Rays16 rays = rays_of(batch);
    const int steps = march.settings.steps;
    const size_t media = march.snapshot.media.size(), lights = march.snapshot.lights.size();
    scratch.border.resize(16 * static_cast<size_t>(steps + 1));
    scratch.depth.resize(scratch.border.size()), scratch.weight.resize(scratch.border.size());
    scratch.extinction.resize(media * static_cast<size_t>(steps + 1));
    scratch.isotropic.assign(media, {}), scratch.scattered.assign(lights * media, {});
    scratch.tinted.assign(march.colored ? 3 * lights : 0, {});
    const bool styled = march.style.view_depth != 1 || march.style.range < StyleSettings{}.range;
    const Packet packet{march, batch, scratch, rays.origin, rays.direction, rays.jitter, steps, styled};
    if (!place_even_steps(packet, rays.t_max))
        for (size_t lane = 0; lane < 16; ++lane)
            place_steps(march, batch.rays[std::min(lane, batch.rays.size() - 1)], steps, scratch.border.data() + lane,
                        16);
    return packet;
}

// Total extinction at the points; stores that of each medium in `each`.
HWY_INLINE Floats extinction_at(const Packet& packet, const Vec3s& position, Sixteen* each) {
    Floats total = 0.0f;
    for (size_t m = 0; m < packet.media(); ++m) {
        const Medium& medium = packet.march.snapshot.media[m];
        const Floats extinction = density16(medium, position) * gray_extinction(medium.optics);
        store(extinction, each[m].data());
        total = total + extinction;
    }
    return total;
}

// The rays in a light's shadow-map coordinates.
struct RaysInMap {
    const ShadowMap& map;
    Vec3s origin, direction;

    HWY_INLINE RaysInMap(const Packet& packet, size_t light)
        : map(*packet.march.maps[light]), origin(map_coordinates(map, packet.origin)),
          direction(turned_to_map(map, packet.direction)) {}
    HWY_INLINE Vec3s at(const Floats& t) const { return fma(direction, t, origin); }
    HWY_INLINE Floats lit_share(const Floats& t) const { return lit_fraction_at(map, at(t)); }
};

// A box in shadow-map coordinates.
struct Reach {
    vec3 low, high;
};

// Finds which steps of a packet's rays a sun lights, by bisection over ranges of steps.
struct LitSteps {
    const Packet& packet;
    const RaysInMap& rays;
    Lit* lit;   // per step
    vec3 slack; // bound on rounding errors of points between two boundaries

    LitSteps(const Packet& of, const RaysInMap& in, Lit* result) : packet(of), rays(in), lit(result) {
        const Floats farthest = packet.border(packet.steps);
        const auto rounding = [&](const Floats& origin) HWY_ATTR { return 4e-7f * most(abs(origin) + farthest); };
        slack = {rounding(rays.origin.x), rounding(rays.origin.y), rounding(rays.origin.z)};
    }
    Reach reach_at(int border) const {
        const Vec3s point = rays.at(packet.border(border));
        return {vec3(least(point.x), least(point.y), least(point.z)) - slack,
                vec3(most(point.x), most(point.y), most(point.z)) + slack};
    }
    void find(int first, int last, const Reach& a, const Reach& b) const {
        const Lit found = lit_in_box(rays.map, glm::min(a.low, b.low), glm::max(a.high, b.high));
        if (found != Lit::some || last - first <= 1) {
            std::fill(lit + first, lit + last, found);
            return;
        }
        const int middle = (first + last) / 2;
        const Reach between = reach_at(middle);
        find(first, middle, a, between), find(middle, last, between, b);
    }
};

// Finds which steps each sun lights.
void find_lit(const Packet& packet) {
    const auto steps = static_cast<size_t>(packet.steps);
    packet.scratch.lit.resize(packet.lights() * steps);
    for (size_t i = 0; i < packet.lights(); ++i) {
        if (!is_distant(packet.march.snapshot.lights[i])) continue;
        const RaysInMap rays(packet, i);
        const LitSteps search(packet, rays, packet.scratch.lit.data() + i * steps);
        search.find(0, packet.steps, search.reach_at(0), search.reach_at(packet.steps));
    }
}

// Radiance at the eye per meter of a step, for a source of 1 per meter in it: transmittance up to the step times the
// mean transmittance inside; with a style, its own transmittance and fade.
HWY_INLINE Floats view_weight(const Packet& packet, const Floats& transmittance, const Floats& depth,
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
