// Fluence at sixteen points, inside kernels compiled per instruction set (base/simd/simd.h says how).
#if defined(TYNDALL_TRACE_FLUENCE_FLUENCE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_FLUENCE_FLUENCE_SIMD_H
#undef TYNDALL_TRACE_FLUENCE_FLUENCE_SIMD_H
#else
#define TYNDALL_TRACE_FLUENCE_FLUENCE_SIMD_H
#endif

#include "base/simd/simd.h"
#include "trace/fluence/fluence.h"
#include "volume/emission/emission_field_simd.h"
#include "volume/medium.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
struct FluenceAt16 {
    Vec3s fluence, flux[3]; // flux: along each axis, by color
};

struct FluenceAxis {
    Ints low, high, home; // cells
    Floats weight;        // interpolation weight of `high`
    Floats coord;         // in cells from the grid's lower corner
};

// Planes of the surfaces that cut points' home cells: how far a point lies in front, 0 if none does.
struct FluenceCuts {
    Floats n[3], d;

    HWY_INLINE Floats at(const Floats& x, const Floats& y, const Floats& z) const {
        return fma(n[0], x, fma(n[1], y, fma(n[2], z, d)));
    }
};
HWY_INLINE FluenceCuts cuts_of(const FluenceGrid& grid, const Ints& home) {
    const float* base = &grid.cuts.data()->x;
    const Ints at = home * 4;
    return {{gather(base, at), gather(base + 1, at), gather(base + 2, at)}, gather(base + 3, at)};
}

HWY_INLINE Floats corner_share(const FluenceAxis& x, const FluenceAxis& y, const FluenceAxis& z, int corner) {
    return (corner & 4 ? x.weight : 1.0f - x.weight) * (corner & 2 ? y.weight : 1.0f - y.weight) *
           (corner & 1 ? z.weight : 1.0f - z.weight);
}

HWY_INLINE Mask16 has_bit(const Ints& value, int bit) { return to_floats(value & bit) > 0.0f; }

// Of each corner (4 = high in x, 2 in y, 1 in z): whether no wall separates it from the home cell, stepping along x,
// then y, then z. For points behind the surface that cuts the home cell: whether the corner lies behind it too; the
// home cell itself if none does.
HWY_INLINE void open_corners(const FluenceGrid& grid, const FluenceAxis& x, const FluenceAxis& y, const FluenceAxis& z,
                             Mask16 (&open)[8]) {
    const auto wall = [&](const Ints& ix, const Ints& iy, const Ints& iz, int axis) HWY_ATTR {
        return has_bit(gather(grid.walls.data(), (ix * grid.size.y + iy) * grid.size.z + iz), 1 << axis);
    };
    const auto away = [](const FluenceAxis& axis, bool high) HWY_ATTR {
        const Mask16 at_high = to_floats(axis.home) > to_floats(axis.low);
        return high ? !at_high : at_high;
    };
    const Mask16 wall_x = wall(x.low, y.home, z.home, 0);
    for (int i = 0; i < 2; ++i) {
        const Ints& ix = i ? x.high : x.low;
        const Mask16 open_x = !(away(x, i) & wall_x), wall_y = wall(ix, y.low, z.home, 1);
        for (int j = 0; j < 2; ++j) {
            const Mask16 open_y = open_x & !(away(y, j) & wall_y), wall_z = wall(ix, j ? y.high : y.low, z.low, 2);
            for (int k = 0; k < 2; ++k) open[4 * i + 2 * j + k] = open_y & !(away(z, k) & wall_z);
        }
    }
    const FluenceCuts cuts = cuts_of(grid, (x.home * grid.size.y + y.home) * grid.size.z + z.home);
    const Mask16 behind = cuts.at(x.coord, y.coord, z.coord) < 0.0f;
    if (!any(behind)) return;
    Mask16 there[8], none = behind;
    for (int corner = 0; corner < 8; ++corner) {
        const bool i = (corner & 4) != 0, j = (corner & 2) != 0, k = (corner & 1) != 0;
        const Floats cx = to_floats(i ? x.high : x.low) + 0.5f, cy = to_floats(j ? y.high : y.low) + 0.5f,
                     cz = to_floats(k ? z.high : z.low) + 0.5f;
        const Mask16 other = away(x, i) | away(y, j) | away(z, k);
        there[corner] = (cuts.at(cx, cy, cz) < 0.0f) & other & (corner_share(x, y, z, corner) > 0.0f);
        none = none & !there[corner];
        open[corner] = (open[corner] & !behind) | (there[corner] & behind);
    }
    if (!any(none)) return;
    for (int corner = 0; corner < 8; ++corner)
        open[corner] = open[corner] |
                       (none & !(away(x, (corner & 4) != 0) | away(y, (corner & 2) != 0) | away(z, (corner & 1) != 0)));
}

// Same as fluence_at().
HWY_INLINE FluenceAt16 fluence_at16(const FluenceGrid& grid, const Vec3s& point) {
    const Box& box = grid.bounds;
    const Mask16 inside = (point.x >= box.low.x) & (point.x <= box.high.x) & (point.y >= box.low.y) &
                          (point.y <= box.high.y) & (point.z >= box.low.z) & (point.z <= box.high.z);
    const float scale = 1 / grid.cell;
    const auto axis = [&](const Floats& p, float low, int cells) HWY_ATTR {
        const float last = static_cast<float>(cells - 1);
        const Floats coord = (p - low) * scale, at = min(max(coord - 0.5f, 0.0f), last);
        const Ints cell = truncate(at);
        return FluenceAxis{cell, min(cell + 1, cells - 1), truncate(at + 0.5f), at - to_floats(cell), coord};
    };
    const FluenceAxis x = axis(point.x, box.low.x, grid.size.x), y = axis(point.y, box.low.y, grid.size.y),
                      z = axis(point.z, box.low.z, grid.size.z);
    Mask16 open[8];
    const bool walls = !grid.walls.empty();
    if (walls) open_corners(grid, x, y, z, open);
    Floats sums[12], whole = 0.0f;
    for (Floats& sum : sums) sum = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const Ints& ix = corner & 4 ? x.high : x.low;
        const Ints& iy = corner & 2 ? y.high : y.low;
        const Ints& iz = corner & 1 ? z.high : z.low;
        const Ints at = ((ix * grid.size.y + iy) * grid.size.z + iz) * 12;
        const Floats weight = zero_unless(walls ? inside & open[corner] : inside, corner_share(x, y, z, corner));
        whole = whole + weight;
        for (int i = 0; i < 12; ++i) sums[i] = fma(gather(grid.values.data() + i, at), weight, sums[i]);
    }
    if (walls)
        for (Floats& sum : sums) sum = sum / max(whole, 1e-20f);
    return {{sums[0], sums[1], sums[2]},
            {{sums[3], sums[4], sums[5]}, {sums[6], sums[7], sums[8]}, {sums[9], sums[10], sums[11]}}};
}

// Same as scattered_fluence().
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

HWY_INLINE Vec3s scattered_by_draine(const FluenceAt16& at, const Vec3s& direction, const PhaseLobe& lobe) {
    const float mean = static_cast<float>(mean_cosine(lobe)), given = static_cast<float>(lobe.alpha);
    const auto channel = [&](const Floats& fluence, const Floats& x, const Floats& y, const Floats& z) HWY_ATTR {
        const Vec3s along{x, y, z};
        const Floats flux = sqrt(dot(along, along)), m = min(flux / max(fluence, 1e-30f), 1.0f), square = m * m;
        const Floats alpha = 3.0f * square * given / (3.0f + given * (1.0f - square));
        Floats g = m * static_cast<float>(lobe.g);
        for (int i = 0; i < draine_steps; ++i) {
            const Floats twice = 2.0f * g * g;
            g = m * mean * (1.0f + alpha * (1.0f + twice) * (1.0f / 3)) / (1.0f + alpha * (3.0f + twice) * 0.2f);
        }
        const Floats cosine = -dot(along, direction) / max(flux, 1e-30f), g2 = g * g;
        const Floats q = max(1.0f + g2 - 2.0f * g * cosine, 1e-4f);
        const Floats whole = 4 * pi * (1.0f + alpha * (1.0f + 2.0f * g2) * (1.0f / 3));
        return fluence * (1.0f - g2) * (1.0f + alpha * cosine * cosine) / (whole * q * sqrt(q));
    };
    return {channel(at.fluence.x, at.flux[0].x, at.flux[1].x, at.flux[2].x),
            channel(at.fluence.y, at.flux[0].y, at.flux[1].y, at.flux[2].y),
            channel(at.fluence.z, at.flux[0].z, at.flux[1].z, at.flux[2].z)};
}

// Sum over a phase function's lobes. Out of line, like shape_value().
HWY_NOINLINE inline Vec3s scattered_by_lobes(const FluenceAt16& at, const Vec3s& direction, const PhaseShape& shape) {
    if (shape.lobes.empty()) return scattered_fluence(at, direction, shape.mean_cosine);
    Vec3s sum = splat(vec3(0));
    for (const PhaseLobe& lobe : shape.lobes)
        sum = fma(lobe.alpha == 0 ? scattered_fluence(at, direction, static_cast<float>(lobe.g))
                                  : scattered_by_draine(at, direction, lobe),
                  static_cast<float>(lobe.weight), sum);
    return sum;
}

// Radiance that all media scatter toward the eye per meter; `extinction(m)`: of each medium.
template<class Extinction>
HWY_INLINE Vec3s scattered_fluence(const FluenceGrid& grid, const std::vector<Medium>& media, const Vec3s& point,
                                   const Vec3s& direction, const Extinction& extinction) {
    const FluenceAt16 at = fluence_at16(grid, point);
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < media.size(); ++m) {
        const Optics& optics = media[m].optics;
        const Vec3s scattered = optics.phase.shape ? scattered_by_lobes(at, direction, *optics.phase.shape)
                                                   : scattered_fluence(at, direction, mean_cosine(optics.phase));
        sum = fma(scattered * albedo16(optics, point), extinction(m), sum);
    }
    return sum;
}
}
HWY_AFTER_NAMESPACE();
#endif
