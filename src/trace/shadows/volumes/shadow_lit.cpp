// Lit intervals of sixteen rays, from their crossings.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadows/volumes/shadow_lit.cpp"
#include <hwy/foreach_target.h>

#include "base/simd/simd.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Sorts each ray's crossings, with their changes: insertion sort on all rays at once, as neighboring rays cross the
// same faces in nearly the same order.
void sort_crossings(std::vector<ShadowCrossing>& crossings) {
    for (size_t k = 1; k < crossings.size(); ++k) {
        Floats t = load(crossings[k].t), change = load(crossings[k].change);
        size_t at = k;
        for (; at > 0; --at) {
            const ShadowCrossing& before = crossings[at - 1];
            const Floats t_before = load(before.t), change_before = load(before.change);
            const Mask16 nearer = t < t_before;
            if (!any(nearer)) break;
            store(max(t, t_before), crossings[at].t);
            store(select(nearer, change_before, change), crossings[at].change);
            t = min(t, t_before), change = select(nearer, change, change_before);
        }
        store(t, crossings[at].t), store(change, crossings[at].change);
    }
}

HWY_INLINE uint32_t bits_of(const Mask16& mask) {
    uint32_t bits = 0;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        uint8_t part[8] = {};
        hn::StoreMaskBits(FloatTag(), mask.part[i], part);
        bits |= (lane_step == 16 ? part[0] | uint32_t(part[1]) << 8 : uint32_t(part[0])) << (i * lane_step);
    }
    return bits;
}

void append_stretches(const Floats& low, const Floats& high, const Mask16& where,
                      std::vector<Interval<double>> (&lit)[16]) {
    uint32_t left = bits_of(where);
    if (!left) return;
    alignas(64) float from[16], to[16];
    store(low, from), store(high, to);
    for (; left; left &= left - 1) {
        const int ray = std::countr_zero(left);
        lit[ray].push_back({from[ray], to[ray]});
    }
}

void append_lit_kernel(const int (&dark)[16], std::vector<ShadowCrossing>& crossings,
                       const Interval<double> (&ranges)[16], std::vector<Interval<double>> (&lit)[16]) {
    sort_crossings(crossings);
    alignas(64) float low[16], high[16], counts[16];
    for (int i = 0; i < 16; ++i) {
        low[i] = static_cast<float>(ranges[i].low), high[i] = static_cast<float>(ranges[i].high);
        counts[i] = static_cast<float>(dark[i]);
    }
    const Floats end = load(high);
    Floats from = load(low), count = load(counts);
    constexpr float rounding = 4e-7f; // relative: leaves gaps between adjacent faces, which do not count
    for (const ShadowCrossing& crossing : crossings) {
        const Floats t = min(load(crossing.t), end);
        append_stretches(from, t, (count <= 0.0f) & (t - from > abs(t) * rounding), lit);
        count = count + load(crossing.change), from = max(from, t);
        if (!any(from < end)) return;
    }
    append_stretches(from, end, (count <= 0.0f) & (end - from > abs(end) * rounding), lit);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(append_lit_kernel);

void append_lit(const int (&dark)[16], std::vector<ShadowCrossing>& crossings, const Interval<double> (&ranges)[16],
                LitSegments& lit) {
    HWY_DYNAMIC_DISPATCH(append_lit_kernel)(dark, crossings, ranges, lit);
}

void append_lit(const ShadowView& view, std::span<const Ray> rays, const Interval<double> (&ranges)[16], int tile,
                LitSegments& lit) {
    static thread_local std::vector<ShadowCrossing> crossings;
    ShadowViewRays placed;
    placed.edges = false, placed.tile = tile;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (ranges[i].empty()) continue;
        const float end = std::nextafter(static_cast<float>(ranges[i].high), infinity);
        place_ray(view, {rays[i].origin, rays[i].direction, end}, static_cast<int>(i), placed);
    }
    crossings.clear();
    find_crossings(view, placed, crossings);
    int dark[16];
    std::fill(dark, dark + 16, view.dark);
    append_lit(dark, crossings, ranges, lit);
}
}
#endif
