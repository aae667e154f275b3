// Culling of beam cards that no ray of a packet can hit (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_BILLBOARD_REACH_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_BILLBOARD_REACH_SIMD_H
#undef TYNDALL_MODES_BILLBOARD_REACH_SIMD_H
#else
#define TYNDALL_MODES_BILLBOARD_REACH_SIMD_H
#endif

#include "base/simd/reduce_simd.h"
#include "base/simd/simd.h"
#include "modes/billboard/card_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Bounds of the packet's rays in the coordinates of CardGroup, and the planar depth of the farthest end.
struct RayBounds {
    vec3 center, half;
    float farthest;
};

HWY_INLINE RayBounds ray_bounds(const Packet& packet, const Camera& camera) {
    const Vec3s place = packet.origin - splat(camera.position);
    const bool flat = camera.ortho_height > 0;
    const Vec3s& across = flat ? place : packet.direction;
    const Floats forward = dot(packet.direction, splat(camera.forward));
    const Floats axes[3] = {dot(across, splat(camera.right)), dot(across, splat(camera.up)), flat ? 1.0f : forward};
    RayBounds spread;
    for (int axis = 0; axis < 3; ++axis) {
        const float low = least(axes[axis]), high = most(axes[axis]);
        spread.center[axis] = 0.5f * (low + high);
        // Padded for rounding errors.
        spread.half[axis] = 0.5f * (high - low) + 1e-6f * std::max(std::abs(low), std::abs(high));
    }
    spread.farthest = most(fma(forward, packet.t_max, dot(place, splat(camera.forward))));
    return spread;
}

// Quads of a group that some ray of the packet may hit, as a bit mask.
HWY_INLINE uint32_t within_reach(const CardGroup& group, const RayBounds& spread) {
    Mask16 seen = load(group.nearest) <= spread.farthest;
    for (const auto& edge : group.edges) {
        const Vec3s planes{load(edge[0]), load(edge[1]), load(edge[2])};
        const Vec3s widths{abs(planes.x), abs(planes.y), abs(planes.z)};
        seen = seen & (dot(planes, splat(spread.center)) + dot(widths, splat(spread.half)) >= 0.0f);
    }
    uint32_t bits = 0;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        uint8_t part[8] = {};
        hn::StoreMaskBits(FloatTag(), seen.part[i], part);
        bits |= static_cast<uint32_t>(part[0] | part[1] << 8) << (i * lane_step);
    }
    return bits;
}
}
}
HWY_AFTER_NAMESPACE();
#endif
