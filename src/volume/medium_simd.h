// Density at sixteen points, for kernels compiled per instruction set (see base/simd/simd.h).
#if defined(TYNDALL_VOLUME_MEDIUM_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_MEDIUM_SIMD_H
#undef TYNDALL_VOLUME_MEDIUM_SIMD_H
#else
#define TYNDALL_VOLUME_MEDIUM_SIMD_H
#endif

#include "base/simd/simd.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
template<int bits> HWY_INLINE Ints shift_right(const Ints& a) {
    Ints r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::ShiftRight<bits>(a.part[i]);
    return r;
}

HWY_INLINE Mask16 positive(const Ints& a) {
    Mask16 r;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        r.part[i] = hn::RebindMask(FloatTag(), hn::Gt(a.part[i], hn::Zero(IntTag())));
    return r;
}

HWY_INLINE Floats lerp(const Floats& a, const Floats& b, const Floats& weight) { return fma(b - a, weight, a); }

// Local coordinates along one axis: the cell and the fraction within it.
struct Cells {
    Ints cell;
    Floats weight;
};
HWY_INLINE Cells cells_of(const Floats& local, int bricks) {
    const Floats inside = min(max(local, 0.0f), 8.0f * static_cast<float>(bricks) - 1);
    const Ints cell = truncate(inside);
    return {cell, inside - to_floats(cell)};
}

// Scalar fallback for pools too large for 32-bit offsets.
inline Floats brick_density_far(const BrickPool& pool, const Vec3s& point) {
    alignas(64) float x[16], y[16], z[16], density[16];
    store(point.x, x), store(point.y, y), store(point.z, z);
    for (int lane = 0; lane < 16; ++lane) density[lane] = sample_density(pool, vec3(x[lane], y[lane], z[lane]));
    return load(density);
}

// Trilinear density of the bricks, 0 outside; bit-identical to sample_density() on hardware with fused multiply-add.
HWY_INLINE Floats brick_density(const BrickPool& pool, const Vec3s& point) {
    if (pool.empty()) return 0.0f;
    constexpr size_t within_reach = (size_t{1} << 31) - brick_stride;
    if (pool.values.size() > within_reach) return brick_density_far(pool, point);

    mat4 matrix = pool.world_to_index;
    matrix[3] = vec4(pool.anchor_index, 1);
    const Vec3s local = transform_points(matrix, point - splat(pool.anchor));
    const Cells x = cells_of(local.x, pool.size.x), y = cells_of(local.y, pool.size.y),
                z = cells_of(local.z, pool.size.z);
    const Ints brick =
        (shift_right<3>(x.cell) * pool.size.y + shift_right<3>(y.cell)) * pool.size.z + shift_right<3>(z.cell);
    const Ints id = gather(pool.index.data(), brick);
    const Mask16 dense = positive(id), constant = positive(Ints(0) - id);

    Floats density = 0.0f;
    if (any(dense)) {
        // Offsets are from the middle of the 4 GB range of signed 32-bit byte offsets. Inactive lanes read brick 0.
        constexpr int32_t middle = 1 << 30;
        const uint16_t* base = pool.values.data() + middle;
        const Ints in_brick = (x.cell & 7) * 81 + (y.cell & 7) * 9 + (z.cell & 7);
        const Ints at = max(id, 1) * brick_stride + in_brick + (-brick_stride - middle);
        Floats a, b, c, d;
        const auto along_z = [&](int offset, Floats& result) HWY_ATTR {
            Floats first, second;
            gather_half_pairs(base + offset, at, first, second);
            result = lerp(first, second, z.weight);
        };
        along_z(0, a), along_z(9, b), along_z(81, c), along_z(90, d);
        density = zero_unless(dense, lerp(lerp(a, b, y.weight), lerp(c, d, y.weight), x.weight));
    }
    if (any(constant)) density = select(constant, gather(pool.constants.data(), max(Ints(-1) - id, 0)), density);
    return density;
}

// True inside the medium's local box.
HWY_INLINE Mask16 inside_bounds(const Medium& medium, const Vec3s& point) {
    const Vec3s p = transform_points(medium.density.world_to_local, point);
    const Box& box = medium.density.bounds;
    return (p.x >= box.low.x) & (p.x <= box.high.x) & (p.y >= box.low.y) & (p.y <= box.high.y) & (p.z >= box.low.z) &
           (p.z <= box.high.z);
}

// Density of any medium, 0 outside it.
HWY_INLINE Floats density16(const Medium& medium, const Vec3s& point) {
    if (medium.density.kind == DensityKind::bricks) return brick_density(*medium.density.bricks, point);
    const Mask16 inside = inside_bounds(medium, point);
    if (medium.density.kind == DensityKind::homogeneous) return zero_unless(inside, 1.0f);
    const Floats height = max(point.y - medium.density.height_base, 0.0f);
    return zero_unless(inside, exp(height * (-1 / medium.density.height_falloff)));
}
}
HWY_AFTER_NAMESPACE();
#endif
