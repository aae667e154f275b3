// Analytic optical depth. Trilinear density along a ray is a cubic in every voxel cell, which two Gauss points
// integrate exactly. Ray positions and sums are in double, values inside a cell in float.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/optical_depth.cpp"
#include <hwy/foreach_target.h>

#include "base/simd/simd.h"
#include "volume/bricks/brick_walk.h"
#include "volume/medium.h"

#include <cstring>

#ifndef TYNDALL_VOLUME_CROSSED_CELLS
#define TYNDALL_VOLUME_CROSSED_CELLS
namespace tyndall {
// Sixteen cells that a ray crosses; unused ones have zero length.
struct CrossedCells {
    uint32_t pairs[4][16]; // half floats adjacent in z: at y, y + 1, and both again at x + 1
    float middle[3][16];   // midpoint of the ray segment, relative to the cell's corner
    float half[16];        // half of the segment's length, meters
    float direction[3];    // in voxels per meter
};
}
#endif

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
Floats lerp(const Floats& a, const Floats& b, const Floats& share) { return fma(share, b - a, a); }

double column_kernel(const CrossedCells& cells) {
    Floats v[8];
    for (int pair = 0; pair < 4; ++pair) load_half_pairs(cells.pairs[pair], v[2 * pair], v[2 * pair + 1]);
    constexpr float gauss = 0.57735026918962576451f; // 1/√3
    const Floats half = load(cells.half);
    Floats sum = 0.0f;
    for (const float side : {-gauss, gauss}) {
        Floats w[3];
        for (int axis = 0; axis < 3; ++axis)
            w[axis] = fma(half, side * cells.direction[axis], load(cells.middle[axis]));
        const Floats near = lerp(lerp(v[0], v[1], w[2]), lerp(v[2], v[3], w[2]), w[1]);
        const Floats far = lerp(lerp(v[4], v[5], w[2]), lerp(v[6], v[7], w[2]), w[1]);
        sum = sum + lerp(near, far, w[0]);
    }
    alignas(64) float parts_of[16];
    store(sum * half, parts_of);
    double sums[4] = {};
    for (size_t i = 0; i < 16; ++i) sums[i % 4] += parts_of[i];
    return sums[0] + sums[1] + (sums[2] + sums[3]);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(column_kernel);

namespace {
// Integral of exp(-max(height, 0) / falloff) over `length` meters of a line that starts at `height` and rises by
// `slope` per meter. The part above 0 is evaluated from its lower end, exp(-h/H) H/|s| (1 - exp(-|s| L/H)), to avoid
// overflow and cancellation.
double height_column(double height, double slope, double length, double falloff) {
    if (slope == 0) {
        const double density = std::exp(-std::max(height, 0.0) / falloff);
        // Treat densities that underflow in float as 0: rays may be infinite.
        return static_cast<float>(density) == 0 ? 0 : length * density;
    }
    const double lower = slope > 0 ? height : height + slope * length, rate = std::abs(slope) / falloff;
    const double below = std::clamp(-lower / std::abs(slope), 0.0, length);
    const double above = below < length ? length - below : 0.0;
    return below + std::exp(-std::max(lower, 0.0) / falloff) * -std::expm1(-rate * above) / rate;
}

// Integrates density over the cells that a ray crosses, sixteen at a time.
class CellSum {
public:
    explicit CellSum(const LocalRay& ray) : ray_(ray) {
        for (int axis = 0; axis < 3; ++axis) cells_.direction[axis] = static_cast<float>(ray.direction[axis]);
    }
    // `values` belong to the brick whose first cell is `first`.
    void add(const uint16_t* values, ivec3 first, ivec3 cell, double low, double high) {
        const ivec3 in = cell - first;
        const uint16_t* corner = values + (in.x * 9 + in.y) * 9 + in.z;
        corners_[count_] = corner;
        __builtin_prefetch(corner), __builtin_prefetch(corner + 81);
        const dvec3 middle = ray_.origin + 0.5 * (low + high) * ray_.direction - dvec3(cell);
        for (int axis = 0; axis < 3; ++axis) cells_.middle[axis][count_] = static_cast<float>(middle[axis]);
        cells_.half[count_] = static_cast<float>(0.5 * (high - low));
        if (++count_ == 16) finish();
    }
    double sum() {
        if (count_ > 0) finish();
        return sum_;
    }

private:
    void finish() {
        for (size_t i = 0; i < count_; ++i)
            for (size_t pair = 0; pair < 4; ++pair)
                std::memcpy(&cells_.pairs[pair][i], corners_[i] + (pair >> 1) * 81 + (pair & 1) * 9, sizeof(uint32_t));
        for (; count_ < 16; ++count_) cells_.half[count_] = 0;
        sum_ += HWY_DYNAMIC_DISPATCH(column_kernel)(cells_), count_ = 0;
    }

    const LocalRay& ray_;
    CrossedCells cells_{};
    const uint16_t* corners_[16]; // first value of each cell
    size_t count_ = 0;
    double sum_ = 0;
};

double brick_column(const BrickPool& pool, const Ray& ray) {
    const LocalRay local = local_ray(pool, ray);
    CellSum cells(local);
    double constant = 0;
    walk_bricks(pool, local, {0, ray.t_max}, [&](ivec3 brick, int64_t at, double low, double high) {
        const int32_t id = pool.index[at];
        if (id < 0) {
            constant += pool.constants[-id - 1] * (high - low);
            return;
        }
        const ivec3 first = brick * 8;
        const uint16_t* values = &pool.values[size_t(id - 1) * brick_stride];
        walk_cells(local, {low, high}, 1, first, first + 7,
                   [&](ivec3 cell, double from, double to) { cells.add(values, first, cell, from, to); });
    });
    return constant + cells.sum();
}

// Density integrated along the ray, in meters.
double density_column(const Medium& medium, const Ray& ray) {
    if (medium.density.kind == DensityKind::bricks) return brick_column(*medium.density.bricks, ray);
    const Interval<double> inside =
        clip(medium.density.bounds, local_ray(medium.density.world_to_local, ray), {0, ray.t_max});
    if (inside.empty() || medium.density.kind == DensityKind::homogeneous) return inside.length();
    const double height = ray.origin.y + inside.low * ray.direction.y - medium.density.height_base;
    return height_column(height, ray.direction.y, inside.length(), medium.density.height_falloff);
}
}

double optical_depth(const Medium& medium, const Ray& ray) {
    return gray_extinction(medium.optics) == 0 ? 0 : gray_extinction(medium.optics) * density_column(medium, ray);
}

double optical_depth(std::span<const Medium> media, const Ray& ray) {
    double sum = 0;
    for (const Medium& medium : media) sum += optical_depth(medium, ray);
    return sum;
}
}
#endif
