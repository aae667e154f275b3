// Slices of sixteen rays at once: cuts every triangle by all their planes, vectorized over the rays.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadows/intervals/packet.cpp"
#include <hwy/foreach_target.h>

#include "trace/shadows/intervals/shadow_slice.h"

#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<Tag>;
constexpr size_t lanes = hn::MaxLanes(Tag());

HWY_INLINE Doubles load(const double* values) { return hn::Load(Tag(), values); }
HWY_INLINE Doubles set(double value) { return hn::Set(Tag(), value); }

// A triangle corner relative to the slices of some rays: height above the plane, and coordinates in it.
struct Corner {
    Doubles height, x, y;
};

HWY_INLINE Doubles product(const double (&axis)[3][16], size_t i, const Doubles (&from)[3]) {
    const auto sum = hn::Mul(load(axis[0] + i), from[0]);
    return hn::MulAdd(load(axis[2] + i), from[2], hn::MulAdd(load(axis[1] + i), from[1], sum));
}

struct Point {
    Doubles x, y;
};
HWY_INLINE Point select(const hn::Mask<Tag>& mask, const Point& yes, const Point& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y)};
}
HWY_INLINE Point between(const Point& a, const Point& b, const Doubles& share) {
    return {hn::MulAdd(share, hn::Sub(b.x, a.x), a.x), hn::MulAdd(share, hn::Sub(b.y, a.y), a.y)};
}

// Where the edge a-b crosses the plane, computed from its upper end: triangles on either side agree bit for bit.
HWY_INLINE Point crossing(const Corner& a, const Corner& b, const hn::Mask<Tag>& a_above) {
    const Doubles up = hn::IfThenElse(a_above, a.height, b.height), down = hn::IfThenElse(a_above, b.height, a.height);
    const Point high = select(a_above, {a.x, a.y}, {b.x, b.y}), low = select(a_above, {b.x, b.y}, {a.x, a.y});
    return between(high, low, hn::Div(up, hn::Sub(up, down)));
}

struct Shadows {
    alignas(64) double low[16], high[16];
    uint32_t rays = 0; // bits
};

// The intervals that the segment a-b shadows on `lanes` rays from the i-th on (see append_shadow()).
HWY_INLINE void cast(const ShadowPacket& p, size_t i, Point a, Point b, hn::Mask<Tag> there, Shadows& shadows) {
    const Tag d;
    const Doubles zero = hn::Zero(d), top = load(p.top + i), light_x = load(p.light_x + i),
                  light_y = load(p.light_y + i), near = load(p.near + i);
    const auto swapped = hn::Gt(a.y, b.y);
    const Point low = select(swapped, b, a), high = select(swapped, a, b);
    there = hn::And(there, hn::And(hn::Gt(high.y, zero), hn::Lt(low.y, top)));
    if (hn::AllFalse(d, there)) return;
    const Doubles rise = hn::Sub(high.y, low.y);
    const auto under = hn::Lt(low.y, zero), over = hn::Gt(high.y, top);
    a = select(under, {between(low, high, hn::Div(hn::Neg(low.y), rise)).x, zero}, low);
    b = select(over, {between(low, high, hn::Div(hn::Sub(top, low.y), rise)).x, top}, high);
    const auto on_ray = [&](const Point& q) HWY_ATTR {
        return hn::Div(hn::NegMulAdd(q.y, light_x, hn::Mul(q.x, light_y)), hn::NegMulAdd(near, q.y, light_y));
    };
    const Doubles s = on_ray(a), t = on_ray(b);
    const Doubles from = hn::Max(hn::Min(s, t), zero), to = hn::Min(hn::Max(s, t), load(p.end + i));
    there = hn::And(there, hn::Lt(from, to));
    const Doubles meters = load(p.meters + i);
    hn::Store(hn::Mul(from, meters), d, shadows.low + i), hn::Store(hn::Mul(to, meters), d, shadows.high + i);
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, there, bits);
    shadows.rays |= static_cast<uint32_t>(bits[0]) << i;
}

// The shadows of one triangle on the active rays.
HWY_INLINE void cut(const ShadowPacket& p, const vec3 (&corners)[3], Shadows& shadows) {
    const Tag d;
    shadows.rays = 0;
    for (size_t i = 0; i < 16; i += lanes) {
        Doubles from[3][3];
        Corner corner[3];
        hn::Mask<Tag> above[3];
        for (size_t k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis)
                from[k][axis] = hn::Sub(set(corners[k][axis]), load(p.origin[axis] + i));
            corner[k].height = product(p.normal, i, from[k]);
            above[k] = hn::Ge(corner[k].height, hn::Zero(d));
        }
        const auto edge0 = hn::Xor(above[0], above[1]), edge1 = hn::Xor(above[1], above[2]),
                   edge2 = hn::Xor(above[2], above[0]);
        uint8_t active[8] = {static_cast<uint8_t>(p.active >> i)};
        const auto there = hn::And(hn::Or(edge0, edge1), hn::LoadMaskBits(d, active));
        if (hn::AllFalse(d, there)) continue;
        for (size_t k = 0; k < 3; ++k) corner[k].x = product(p.x, i, from[k]), corner[k].y = product(p.y, i, from[k]);
        // Two of the three edges are crossed.
        const Point middle = crossing(corner[1], corner[2], above[1]);
        const Point a = select(edge0, crossing(corner[0], corner[1], above[0]), middle);
        const Point b = select(edge2, crossing(corner[2], corner[0], above[2]), middle);
        cast(p, i, a, b, there, shadows);
    }
}

void append_shadows_kernel(const ShadowSlices& slices, const ShadowSlices::Node& leaf, const ShadowPacket& packet,
                           std::vector<Interval<double>> (&found)[16]) {
    Shadows shadows;
    for (uint32_t triangle = leaf.first; triangle < leaf.first + leaf.count; ++triangle) {
        const vec3 corners[3] = {slices.corners->of(triangle, 0), slices.corners->of(triangle, 1),
                                 slices.corners->of(triangle, 2)};
        cut(packet, corners, shadows);
        for (uint32_t left = shadows.rays; left; left &= left - 1) {
            const int ray = std::countr_zero(left);
            add_shadow({shadows.low[ray], shadows.high[ray]}, found[ray]);
        }
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(append_shadows_kernel);

void append_shadows(const ShadowSlices& slices, const ShadowSlices::Node& leaf, const ShadowPacket& packet,
                    std::vector<Interval<double>> (&shadows)[16]) {
    HWY_DYNAMIC_DISPATCH(append_shadows_kernel)(slices, leaf, packet, shadows);
}
}
#endif
