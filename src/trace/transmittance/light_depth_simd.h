// Optical depth to a light for kernels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_TRACE_TRANSMITTANCE_LIGHT_DEPTH_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_TRANSMITTANCE_LIGHT_DEPTH_SIMD_H
#undef TYNDALL_TRACE_TRANSMITTANCE_LIGHT_DEPTH_SIMD_H
#else
#define TYNDALL_TRACE_TRANSMITTANCE_LIGHT_DEPTH_SIMD_H
#endif

#include "base/simd/gather_simd.h"
#include "base/simd/simd.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Straight paths from 16 points to the light.
struct Segments16 {
    Vec3s origin, direction; // unit directions
    Floats length;
};

inline constexpr float sun_distance = 1e12f; // meters: beyond all fog, and its square is still finite

HWY_INLINE Segments16 light_segments(const Light& light, const Vec3s& point) {
    if (is_distant(light)) return {point, splat(-light.direction), sun_distance};
    const Vec3s towards = splat(light.position) - point;
    const Floats distance = max(sqrt(dot(towards, towards)), 1e-12f);
    return {point, towards * (1.0f / distance), max(distance - light.radius, 0.0f)};
}

// Narrows ranges to where origin + t·direction lies between two planes of an axis.
HWY_INLINE void clip_axis(const Floats& origin, const Floats& direction, float low, float high,
                          Interval<Floats>& range) {
    const Mask16 along = abs(direction) < 1e-20f;
    const Floats inverse = 1.0f / select(along, 1.0f, direction);
    const Floats a = (low - origin) * inverse, b = (high - origin) * inverse;
    const Mask16 inside = (origin >= low) & (origin <= high);
    range.low = max(range.low, select(along, 0.0f, min(a, b)));
    range.high = select(along, zero_unless(inside, range.high), min(range.high, max(a, b)));
}

// The part of each path inside a medium's box.
HWY_INLINE Interval<Floats> inside_box(const Medium& medium, const Segments16& paths) {
    const mat4& m = medium.density.world_to_local;
    const Vec3s origin = transform_points(m, paths.origin);
    const Vec3s& d = paths.direction;
    const Vec3s direction = {fma(d.z, m[2].x, fma(d.y, m[1].x, d.x * m[0].x)),
                             fma(d.z, m[2].y, fma(d.y, m[1].y, d.x * m[0].y)),
                             fma(d.z, m[2].z, fma(d.y, m[1].z, d.x * m[0].z))};
    Interval<Floats> range{0.0f, paths.length};
    clip_axis(origin.x, direction.x, medium.density.bounds.low.x, medium.density.bounds.high.x, range);
    clip_axis(origin.y, direction.y, medium.density.bounds.low.y, medium.density.bounds.high.y, range);
    clip_axis(origin.z, direction.z, medium.density.bounds.low.z, medium.density.bounds.high.z, range);
    return range;
}

// Mean of exp(-(y-base)/falloff), clamped to 1 below the base, between two heights. Above the base it is the density at
// the lower end times (1-e^-x)/x, with x the height difference over the falloff. The fractions above and below are
// computed separately: on a path to the sun, a fraction of 1e-9 is still kilometers.
HWY_INLINE Floats mean_height_density(const Medium& medium, const Floats& y0, const Floats& y1) {
    const Floats base = medium.density.height_base, low = min(y0, y1), high = max(y0, y1);
    const Mask16 level = high <= low;
    const Floats inverse = 1.0f / select(level, 1.0f, high - low);
    const Floats from = max(low, base), to = max(high, base);
    const Floats above = select(level, select(low > base, 1.0f, 0.0f), (to - from) * inverse);
    const Floats below = select(level, select(low > base, 0.0f, 1.0f), (min(high, base) - min(low, base)) * inverse);
    const float thinning = 1 / medium.density.height_falloff;
    const Floats density = exp((base - from) * thinning) * mean_transmittance((to - from) * thinning);
    return fma(above, density, below);
}

// Exact optical depth of homogeneous and height fog.
HWY_INLINE Floats analytic_depth16(const Medium& medium, const Segments16& paths) {
    const Interval<Floats> range = inside_box(medium, paths);
    const Floats length = max(range.high - range.low, 0.0f) * gray_extinction(medium.optics);
    if (medium.density.kind == DensityKind::homogeneous) return length;
    const Floats y0 = fma(paths.direction.y, range.low, paths.origin.y);
    const Floats y1 = fma(paths.direction.y, range.high, paths.origin.y);
    return zero_unless(length > 0.0f, length * mean_height_density(medium, y0, y1));
}

// Grid coordinates of a point; clears `valid` for points outside the grid's projection.
HWY_INLINE Vec3s grid_coordinates(const LightDepthGrid& grid, const Vec3s& point, Mask16& valid) {
    const mat3& m = grid.world_to_grid;
    const Vec3s p = point - splat(grid.position);
    const Vec3s q = {dot(p, {m[0].x, m[1].x, m[2].x}), dot(p, {m[0].y, m[1].y, m[2].y}),
                     dot(p, {m[0].z, m[1].z, m[2].z})};
    if (grid.projection == LightProjection::parallel) return q;
    const Floats distance = sqrt(dot(q, q));
    if (grid.projection == LightProjection::perspective) {
        valid = valid & (q.z > 0.0f);
        const Floats inverse = 1.0f / max(q.z, 1e-20f);
        return {q.x * inverse, q.y * inverse, distance};
    }
    // Octahedral map (Meyer et al. 2010): the lower half folds outwards over the diagonals.
    const Floats inverse = 1.0f / max(abs(q.x) + abs(q.y) + abs(q.z), 1e-20f);
    const Floats x = q.x * inverse, y = q.y * inverse;
    const Floats folded_x = (1.0f - abs(y)) * select(x < 0.0f, -1.0f, 1.0f);
    const Floats folded_y = (1.0f - abs(x)) * select(y < 0.0f, -1.0f, 1.0f);
    const Mask16 lower = q.z < 0.0f;
    return {select(lower, folded_x, x), select(lower, folded_y, y), distance};
}

// Splits a coordinate into a cell and the fraction within it; clamps to the border.
HWY_INLINE Ints cell_of(const Floats& coordinate, int size, Floats& share) {
    const Floats last = static_cast<float>(size - 1);
    const Floats held = min(zero_unless(coordinate > 0.0f, coordinate), last);
    const Ints cell = min(truncate(held), Ints(std::max(size - 2, 0)));
    share = held - to_floats(cell);
    return cell;
}

HWY_INLINE Floats trilinear16(const std::vector<float>& values, ivec3 size, const Vec3s& at) {
    Floats share_u, share_v, share_w;
    const Ints i = cell_of(at.x, size.x, share_u), j = cell_of(at.y, size.y, share_v);
    const Ints k = cell_of(at.z, size.z, share_w);
    const int row = size.x, layer = size.x * size.y;
    const Ints corner = (k * size.y + j) * row + i;
    const auto across = [&](const float* from) HWY_ATTR {
        Floats a, b, c, d;
        gather_pairs(from, corner, a, b), gather_pairs(from + row, corner, c, d);
        return lerp(lerp(a, b, share_u), lerp(c, d, share_u), share_v);
    };
    return lerp(across(values.data()), across(values.data() + layer), share_w);
}

// Depth of the brick media from the grid: 0 in front of the fog and beside it, all of it behind.
HWY_INLINE Floats grid_depth16(const LightDepthGrid& grid, const Vec3s& point) {
    Mask16 valid = Floats(0.0f) < Floats(1.0f);
    const Vec3s coordinates = grid_coordinates(grid, point, valid);
    const Floats u = fma(coordinates.x, grid.scale.x, grid.offset.x);
    const Floats v = fma(coordinates.y, grid.scale.y, grid.offset.y);
    const Floats w = fma(coordinates.z, grid.scale.z, grid.offset.z);
    constexpr float slack = 1e-3f; // of a cell: borders belong to the grid
    valid = valid & (u >= -slack) & (u <= static_cast<float>(grid.size.x - 1) + slack) & (v >= -slack) &
            (v <= static_cast<float>(grid.size.y - 1) + slack) & (w > 0.0f);
    if (!any(valid)) return 0.0f;

    return zero_unless(valid, trilinear16(*grid.depth, grid.size, {u, v, w}));
}

// Corner coordinates of points among the froxels; clears `inside` for points beyond them.
HWY_INLINE Vec3s froxel_coordinates(const LightDepthFroxels& froxels, const Vec3s& point, Mask16& inside) {
    const Camera& camera = froxels.camera;
    const Vec3s offset = point - splat(camera.position);
    const Floats z = dot(offset, splat(camera.forward));
    const Floats inverse = camera.ortho_height > 0 ? Floats(1.0f) : 1.0f / max(z, 1e-20f);
    const Floats u = fma(dot(offset, splat(camera.right)) * inverse, froxels.scale.x, froxels.offset.x);
    const Floats v = fma(dot(offset, splat(camera.up)) * inverse, froxels.scale.y, froxels.offset.y);
    // The root of a s + (1 - a) s² = share, without cancellation.
    const float a = froxels.first;
    const Floats share = (z - froxels.near) * (1 / (froxels.far - froxels.near));
    const Floats root = sqrt(max(fma(share, 4 * (1 - a), a * a), 0.0f));
    const Floats w = share * 2.0f / (root + a) * static_cast<float>(froxels.size.z - 1);
    const auto within = [](const Floats& x, int size)
                            HWY_ATTR { return (x >= 0.0f) & (x <= static_cast<float>(size - 1)); };
    constexpr float slack = 1e-4f; // of the whole depth: the ends belong to the froxels
    inside = within(u, froxels.size.x) & within(v, froxels.size.y) & (share >= -slack) & (share <= 1 + slack);
    return {u, v, w};
}

// Brick media integrated point by point, by a function too long to be worth inlining.
HWY_INLINE Floats marched_depth16(const LightDepth& depth, const Vec3s& point, const Mask16& active) {
    alignas(64) float x[16], y[16], z[16], is_active[16], result[16];
    alignas(64) int32_t wanted[16];
    store(point.x, x), store(point.y, y), store(point.z, z), store(select(active, 1.0f, 0.0f), is_active);
    for (int lane = 0; lane < 16; ++lane) wanted[lane] = is_active[lane] > 0 ? -1 : 0;
    marched_depths(depth, x, y, z, wanted, result);
    return load(result);
}

// Brick media from the froxels; marched for points outside them.
HWY_INLINE Floats froxel_depth16(const LightDepth& depth, const Vec3s& point, const Mask16& active) {
    if (depth.froxels.empty()) return marched_depth16(depth, point, active);
    Mask16 inside;
    const Vec3s at = froxel_coordinates(depth.froxels, point, inside);
    Floats found = 0.0f;
    if (any(inside & active)) found = zero_unless(inside, trilinear16(*depth.froxels.depth, depth.froxels.size, at));
    const Mask16 outside = active & !inside;
    return any(outside) ? found + marched_depth16(depth, point, outside) : found;
}

// Optical depth between 16 points and a light; 0 where not active.
HWY_INLINE Floats light_depth16(const LightDepth& depth, const Vec3s& point, const Mask16& active) {
    if (depth.method == LightTransmittance::off) return 0.0f;
    if (depth.method == LightTransmittance::average) return zero_unless(active, depth.average * depth.scale);
    Floats sum = 0.0f;
    if (!depth.analytic.empty()) {
        const Segments16 paths = light_segments(depth.light, point);
        for (const Medium& medium : depth.analytic) sum = sum + analytic_depth16(medium, paths);
    }
    if (!depth.grid.empty()) sum = sum + grid_depth16(depth.grid, point);
    if (!depth.marched.empty()) sum = sum + froxel_depth16(depth, point, active);
    return zero_unless(active, sum * depth.scale);
}
}
HWY_AFTER_NAMESPACE();
#endif
