// Cuts triangles by the plane through ray and light; vectorized over a fan's half spaces and a leaf's triangles.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadows/intervals/cut.cpp"
#include <hwy/foreach_target.h>

#include "trace/shadows/intervals/shadow_slice.h"

#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Halves = hn::Rebind<float, Doubles>;
constexpr size_t double_lanes = hn::MaxLanes(Doubles());

// Whether every half space contains some corner of the box.
HWY_INLINE bool meets(const ShadowFan& fan, const ShadowSlices::Node& node) {
    const Doubles d;
    for (size_t i = 0; i < 8; i += double_lanes) {
        const auto highest = [&](const double* normal, double low, double high) HWY_ATTR {
            const auto n = hn::Load(d, normal + i);
            return hn::Max(hn::Mul(n, hn::Set(d, low)), hn::Mul(n, hn::Set(d, high)));
        };
        const auto sum =
            hn::Add(hn::Add(highest(fan.x, node.low.x, node.high.x), highest(fan.y, node.low.y, node.high.y)),
                    highest(fan.z, node.low.z, node.high.z));
        if (!hn::AllFalse(d, hn::Lt(sum, hn::Load(d, fan.least + i)))) return false;
    }
    return true;
}

// Visits the leaves that the fan overlaps.
template<class Visit> HWY_INLINE void visit_leaves(const ShadowSlices& slices, const ShadowFan& fan, Visit visit) {
    const auto end = static_cast<uint32_t>(slices.nodes.size());
    for (uint32_t at = 0; at < end;) {
        const ShadowSlices::Node& node = slices.nodes[at];
        const bool met = meets(fan, node);
        if (met && node.count > 0) visit(node);
        at = met || node.count > 0 ? at + 1 : node.first;
    }
}

// Heights of the triangle corners of a leaf above the plane.
struct Heights {
    alignas(64) double corners[3][8];
    uint32_t cut = 0; // bits of the triangles with corners on both sides
};
HWY_INLINE void set_heights(const ShadowSlices::Corners& corners, const ShadowSlice& slice, uint32_t first,
                            Heights& heights) {
    const Doubles d;
    uint32_t all = 0xff, some = 0;
    for (size_t corner = 0; corner < 3; ++corner) {
        uint32_t above = 0;
        for (size_t i = 0; i < 8; i += double_lanes) {
            auto sum = hn::Zero(d);
            for (int axis = 0; axis < 3; ++axis) {
                const float* values = corners.values[3 * corner + static_cast<size_t>(axis)].data() + first + i;
                const auto value = hn::PromoteTo(d, hn::LoadU(Halves(), values));
                const auto offset = hn::Sub(value, hn::Set(d, slice.origin[axis]));
                sum = hn::MulAdd(hn::Set(d, slice.normal[axis]), offset, sum);
            }
            hn::Store(sum, d, heights.corners[corner] + i);
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Ge(sum, hn::Zero(d)), bits);
            above |= static_cast<uint32_t>(bits[0]) << i;
        }
        all &= above, some |= above;
    }
    heights.cut = some & ~all;
}

// The segment in which a triangle intersects the plane. A corner in the plane counts as above it, and points on edges
// are computed from the upper end: neighbors agree on them bit for bit, so no light leaks between them.
void append_segment(const ShadowSlices::Corners& corners, const ShadowSlice& slice, uint32_t triangle,
                    const double height[3], std::vector<ShadowSlice::Segment>& segments) {
    const bool above[3] = {height[0] >= 0, height[1] >= 0, height[2] >= 0};
    const int lone = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
    ShadowSlice::Point points[3];
    for (size_t i = 0; i < 3; ++i) {
        const dvec3 corner = dvec3(corners.of(triangle, i)) - slice.origin;
        points[i] = {glm::dot(slice.x, corner), glm::dot(slice.y, corner)};
    }
    const auto crossing = [&](int i, int j) {
        if (!above[i]) std::swap(i, j);
        return between(points[i], points[j], height[i] / (height[i] - height[j]));
    };
    segments.push_back({crossing(lone, (lone + 1) % 3), crossing(lone, (lone + 2) % 3)});
}

void append_segments_kernel(const ShadowSlices& slices, const ShadowSlice& slice,
                            std::vector<ShadowSlice::Segment>& segments) {
    visit_leaves(slices, make_fan(slice), [&](const ShadowSlices::Node& leaf) HWY_ATTR {
        Heights heights;
        set_heights(*slices.corners, slice, leaf.first, heights);
        const uint32_t here = heights.cut & ((1u << leaf.count) - 1);
        for (uint32_t left = here; left; left &= left - 1) {
            const auto i = static_cast<uint32_t>(std::countr_zero(left));
            const double height[] = {heights.corners[0][i], heights.corners[1][i], heights.corners[2][i]};
            append_segment(*slices.corners, slice, leaf.first + i, height, segments);
        }
    });
}

// The triangles of a leaf that the fan overlaps, as bits.
HWY_INLINE uint32_t met_triangles(const ShadowSlices::Corners& corners, const ShadowFan& fan, uint32_t first) {
    const Doubles d;
    uint32_t met = 0;
    for (size_t i = 0; i < 8; i += double_lanes) {
        hn::Vec<Doubles> values[9];
        for (size_t k = 0; k < 9; ++k)
            values[k] = hn::PromoteTo(d, hn::LoadU(Halves(), corners.values[k].data() + first + i));
        auto inside = hn::Eq(hn::Zero(d), hn::Zero(d));
        for (int side = 0; side < 8; ++side) {
            const auto x = hn::Set(d, fan.x[side]), y = hn::Set(d, fan.y[side]), z = hn::Set(d, fan.z[side]);
            const auto height = [&](size_t corner) HWY_ATTR {
                const auto* v = values + 3 * corner;
                return hn::MulAdd(z, v[2], hn::MulAdd(y, v[1], hn::Mul(x, v[0])));
            };
            const auto highest = hn::Max(hn::Max(height(0), height(1)), height(2));
            inside = hn::And(inside, hn::Ge(highest, hn::Set(d, fan.least[side])));
        }
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, inside, bits);
        met |= static_cast<uint32_t>(bits[0]) << i;
    }
    return met;
}

void append_leaves_kernel(const ShadowSlices& slices, const ShadowFan& fan, std::vector<ShadowSlices::Node>& leaves) {
    visit_leaves(slices, fan, [&](const ShadowSlices::Node& leaf) HWY_ATTR {
        uint32_t left = met_triangles(*slices.corners, fan, leaf.first) & ((1u << leaf.count) - 1);
        while (left) {
            const int start = std::countr_zero(left), run = std::countr_one(left >> start);
            leaves.push_back(
                {leaf.low, leaf.high, leaf.first + static_cast<uint32_t>(start), static_cast<uint32_t>(run)});
            left &= ~(((1u << run) - 1) << start);
        }
    });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(append_segments_kernel);
HWY_EXPORT(append_leaves_kernel);
void append_segments(const ShadowSlices& slices, const ShadowSlice& slice,
                     std::vector<ShadowSlice::Segment>& segments) {
    HWY_DYNAMIC_DISPATCH(append_segments_kernel)(slices, slice, segments);
}
void append_leaves(const ShadowSlices& slices, const ShadowFan& fan, std::vector<ShadowSlices::Node>& leaves) {
    HWY_DYNAMIC_DISPATCH(append_leaves_kernel)(slices, fan, leaves);
}
}
#endif
