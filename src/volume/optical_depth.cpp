// Optical depth in closed form, in double. Along a ray trilinear density is a cubic in every voxel cell, which two
// Gauss points integrate exactly.
#include "volume/brick_walk.h"
#include "volume/half.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Integral of exp(-max(height, 0) / falloff) over `length` metres of a line that starts at `height` and rises by
// `slope` per metre. Each part counts from its lower end: exp(-h/H) H/|s| (1 - exp(-|s| L/H)), without overflow or
// cancellation.
double height_column(double height, double slope, double length, double falloff) {
    if (slope == 0) {
        const double density = std::exp(-std::max(height, 0.0) / falloff);
        return density == 0 ? 0 : length * density;
    }
    const double lower = slope > 0 ? height : height + slope * length, rate = std::abs(slope) / falloff;
    const double below = std::clamp(-lower / std::abs(slope), 0.0, length);
    const double above = below < length ? length - below : 0.0;
    return below + std::exp(-std::max(lower, 0.0) / falloff) * -std::expm1(-rate * above) / rate;
}

double cell_column(const uint16_t* corner, ivec3 cell, const LocalRay& ray, double low, double high) {
    double v[8];
    for (int c = 0; c < 8; ++c) v[c] = float_from_half(corner[(c >> 2) * 81 + ((c >> 1) & 1) * 9 + (c & 1)]);
    constexpr double gauss = 0.57735026918962576451; // 1/√3
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    double sum = 0;
    for (const double t : {middle - gauss * half, middle + gauss * half}) {
        const dvec3 w = ray.origin + t * ray.direction - dvec3(cell);
        const double a = v[0] + w.z * (v[1] - v[0]), b = v[2] + w.z * (v[3] - v[2]);
        const double c = v[4] + w.z * (v[5] - v[4]), d = v[6] + w.z * (v[7] - v[6]);
        const double e = a + w.y * (b - a), f = c + w.y * (d - c);
        sum += e + w.x * (f - e);
    }
    return sum * half;
}

double brick_column(const BrickPool& pool, const Ray& ray) {
    const LocalRay local = local_ray(pool, ray);
    double column = 0;
    walk_bricks(pool, local, {0, ray.t_max}, [&](ivec3 brick, int64_t at, double low, double high) {
        const int32_t id = pool.index[at];
        if (id < 0) {
            column += pool.constants[-id - 1] * (high - low);
            return;
        }
        const ivec3 first = brick * 8;
        const uint16_t* values = &pool.values[size_t(id - 1) * brick_stride];
        walk_cells(local, {low, high}, 1, first, first + 7, [&](ivec3 cell, double from, double to) {
            const ivec3 in = cell - first;
            column += cell_column(values + (in.x * 9 + in.y) * 9 + in.z, cell, local, from, to);
        });
    });
    return column;
}

// Density integrated along the ray, in metres.
double density_column(const Medium& medium, const Ray& ray) {
    if (medium.kind == DensityKind::bricks) return brick_column(*medium.bricks, ray);
    const Stretch inside = clip(medium.bounds, local_ray(medium.world_to_local, ray), {0, ray.t_max});
    if (inside.empty() || medium.kind == DensityKind::homogeneous) return inside.length();
    const double height = ray.origin.y + inside.low * ray.direction.y - medium.height_base;
    return height_column(height, ray.direction.y, inside.length(), medium.height_falloff);
}
}

double optical_depth(const Medium& medium, const Ray& ray) {
    return medium.optics.extinction == 0 ? 0 : medium.optics.extinction * density_column(medium, ray);
}

double optical_depth(std::span<const Medium> media, const Ray& ray) {
    double sum = 0;
    for (const Medium& medium : media) sum += optical_depth(medium, ray);
    return sum;
}
}
