// Fluence at sixteen points, inside kernels compiled per instruction set (base/simd.h says how).
#if defined(TYNDALL_TRACE_FLUENCE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_FLUENCE_SIMD_H
#undef TYNDALL_TRACE_FLUENCE_SIMD_H
#else
#define TYNDALL_TRACE_FLUENCE_SIMD_H
#endif

#include "base/simd.h"
#include "trace/fluence.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
struct FluenceAt16 {
    Vec3s fluence, flux[3]; // flux: along each axis, of the colours
};

// As fluence_at().
HWY_INLINE FluenceAt16 fluence_at16(const FluenceGrid& grid, const Vec3s& point) {
    const Box& box = grid.bounds;
    const Mask16 inside = (point.x >= box.low.x) & (point.x <= box.high.x) & (point.y >= box.low.y) &
                          (point.y <= box.high.y) & (point.z >= box.low.z) & (point.z <= box.high.z);
    const float scale = 1 / grid.cell;
    struct Axis {
        Ints low, high;
        Floats weight;
    };
    const auto axis = [&](const Floats& p, float low, int cells) HWY_ATTR {
        const float last = static_cast<float>(cells - 1);
        const Floats at = min(max((p - low) * scale - 0.5f, 0.0f), last);
        const Ints cell = truncate(at);
        return Axis{cell, min(cell + 1, cells - 1), at - to_floats(cell)};
    };
    const Axis x = axis(point.x, box.low.x, grid.size.x), y = axis(point.y, box.low.y, grid.size.y),
               z = axis(point.z, box.low.z, grid.size.z);
    Floats sums[12];
    for (Floats& sum : sums) sum = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const Ints& ix = corner & 1 ? x.high : x.low;
        const Ints& iy = corner & 2 ? y.high : y.low;
        const Ints& iz = corner & 4 ? z.high : z.low;
        const Ints at = ((ix * grid.size.y + iy) * grid.size.z + iz) * 12;
        const Floats weight =
            zero_unless(inside, (corner & 1 ? x.weight : 1.0f - x.weight) * (corner & 2 ? y.weight : 1.0f - y.weight) *
                                    (corner & 4 ? z.weight : 1.0f - z.weight));
        for (int i = 0; i < 12; ++i) sums[i] = fused(gather(grid.values.data() + i, at), weight, sums[i]);
    }
    return {{sums[0], sums[1], sums[2]},
            {{sums[3], sums[4], sums[5]}, {sums[6], sums[7], sums[8]}, {sums[9], sums[10], sums[11]}}};
}

// As scattered_fluence().
HWY_INLINE Vec3s scattered_fluence(const FluenceAt16& at, const Vec3s& direction, float g) {
    const auto channel = [&](const Floats& fluence, const Floats& x, const Floats& y, const Floats& z) HWY_ATTR {
        const Floats share = g / max(fluence, 1e-30f);
        const Vec3s lobe = Vec3s{x, y, z} * share;
        const Floats squared = min(dot(lobe, lobe), largest_g * largest_g);
        const Floats q = max(1.0f + squared + 2.0f * dot(lobe, direction), 1e-4f);
        return fluence * (1.0f - squared) / (4 * pi * q * sqrt(q));
    };
    return {channel(at.fluence.x, at.flux[0].x, at.flux[1].x, at.flux[2].x),
            channel(at.fluence.y, at.flux[0].y, at.flux[1].y, at.flux[2].y),
            channel(at.fluence.z, at.flux[0].z, at.flux[1].z, at.flux[2].z)};
}

// What fog scatters of it towards the eye per metre; `extinction(m)` of each medium.
template<class Extinction>
HWY_INLINE Vec3s scattered_fluence(const FluenceGrid& grid, const std::vector<Medium>& media, const Vec3s& point,
                                   const Vec3s& direction, const Extinction& extinction) {
    const FluenceAt16 at = fluence_at16(grid, point);
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < media.size(); ++m) {
        const Optics& optics = media[m].optics;
        sum = fused(scattered_fluence(at, direction, mean_cosine(optics.phase)) * splat(optics.albedo), extinction(m),
                    sum);
    }
    return sum;
}
}
HWY_AFTER_NAMESPACE();
#endif
