// Four froxels side by side: red, green, blue and extinction of each in four lanes (see base/simd/simd.h for how such
// files are compiled).
#if defined(TYNDALL_MODES_FROXEL_HISTORY_QUADS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_HISTORY_QUADS_SIMD_H
#undef TYNDALL_MODES_FROXEL_HISTORY_QUADS_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_HISTORY_QUADS_SIMD_H
#endif

#include "base/simd/simd.h"

#include <algorithm>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Broadcasts each froxel's extinction to its four lanes.
HWY_INLINE Floats extinctions(const Floats& light) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::Broadcast<3>(light.part[i]);
    return r;
}

// 0 in all lanes of a froxel whose values are finite, else NaN.
HWY_INLINE Floats finite_sums(const Floats& light) {
    const Floats zeros = light * 0.0f;
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const auto pairs = hn::Add(zeros.part[i], hn::Shuffle2301(zeros.part[i]));
        r.part[i] = hn::Add(pairs, hn::Shuffle1032(pairs));
    }
    return r;
}

HWY_INLINE Mask16 extinction_lanes() {
    alignas(64) float is[16];
    for (int i = 0; i < 16; ++i) is[i] = i % 4 == 3 ? 1.0f : 0.0f;
    return load(is) > 0.0f;
}

// Lanes of stale froxels: usually all of a tile or none.
HWY_INLINE Mask16 stale_lanes(const uint8_t* stale, size_t count) {
    uint32_t four = 0;
    if (stale && count >= 16) std::memcpy(&four, stale, 4);
    for (size_t i = 0; stale && count < 16 && i < count / 4; ++i) four |= uint32_t{stale[i]} << (8 * i);
    if (four == 0 || four == 0x01010101) return Floats(four ? 1.0f : 0.0f) > 0.0f;
    alignas(64) float is[16];
    for (size_t i = 0; i < 16; ++i) is[i] = static_cast<float>(four >> (i / 4 * 8) & 1);
    return load(is) > 0.0f;
}

// How many of `count` values are in part i of a packet.
HWY_INLINE size_t lanes_of(size_t count, size_t i) {
    return std::min(count - std::min(count, i * lane_step), lane_step);
}
HWY_INLINE Floats load_some(const float* from, size_t count) {
    if (count >= 16) return load(from);
    Floats r = 0.0f;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        if (const size_t here = lanes_of(count, i); here > 0)
            r.part[i] = hn::MaskedLoad(hn::FirstN(FloatTag(), here), FloatTag(), from + i * lane_step);
    return r;
}
HWY_INLINE void store_some(const Floats& values, size_t count, float* to) {
    if (count >= 16) return store(values, to);
    for (size_t i = 0; i < vectors_per_packet; ++i)
        if (const size_t here = lanes_of(count, i); here > 0)
            hn::BlendedStore(values.part[i], hn::FirstN(FloatTag(), here), FloatTag(), to + i * lane_step);
}
}
HWY_AFTER_NAMESPACE();
#endif
