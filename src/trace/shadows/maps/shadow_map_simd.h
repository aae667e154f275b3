// Shadow map lookups in kernels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_TRACE_SHADOWS_MAPS_SHADOW_MAP_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_SHADOWS_MAPS_SHADOW_MAP_SIMD_H
#undef TYNDALL_TRACE_SHADOWS_MAPS_SHADOW_MAP_SIMD_H
#else
#define TYNDALL_TRACE_SHADOWS_MAPS_SHADOW_MAP_SIMD_H
#endif

#include "base/simd/gather_simd.h"
#include "base/simd/simd.h"
#include "trace/shadows/maps/shadow_map.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
HWY_INLINE Ints chosen(const Mask16& where, const Ints& a, const Ints& b) {
    Ints r;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        r.part[i] = hn::IfThenElse(hn::RebindMask(IntTag(), where.part[i]), a.part[i], b.part[i]);
    return r;
}

// Positions of points in the pictures.
struct TexelCoords {
    Floats u, v, w;  // texel coordinates; depth along the light
    Floats texel;    // side of a texel, meters
    Ints first, row; // of the picture: index of its first texel, texels per row
    Mask16 mapped;   // lanes that lie in a picture
};

HWY_INLINE Mask16 in_image(const Floats& u, const Floats& v, ivec2 size) {
    return (u >= shadow_guard) & (u <= static_cast<float>(size.x) - shadow_guard) & (v >= shadow_guard) &
           (v <= static_cast<float>(size.y) - shadow_guard);
}

// The finest cascade that contains each point. Neighboring points mostly share one.
HWY_INLINE void cascade_coords(const ShadowMap& map, const Vec3s& q, TexelCoords& coords) {
    coords.w = q.z, coords.mapped = q.x < q.x;
    for (const ShadowImage& image : map.images) {
        const Floats u = fma(q.x, image.scale.x, image.offset.x);
        const Floats v = fma(q.y, image.scale.y, image.offset.y);
        const Mask16 inside = in_image(u, v, image.size);
        const float texel = 1 / std::min(image.scale.x, image.scale.y);
        const Ints first = static_cast<int32_t>(image.first), row = image.size.x;
        if (&image == map.images.data()) {
            coords.u = u, coords.v = v, coords.texel = texel, coords.first = first, coords.row = row;
        } else {
            const Mask16 here = inside & !coords.mapped;
            coords.u = select(here, u, coords.u), coords.v = select(here, v, coords.v);
            coords.texel = select(here, texel, coords.texel);
            coords.first = chosen(here, first, coords.first), coords.row = chosen(here, row, coords.row);
        }
        coords.mapped = coords.mapped | inside;
        if (!any(!coords.mapped)) break;
    }
}

// The face of a cube, or the one picture of a spot. Faces look along their axes; u and v are the next two in turn.
HWY_INLINE void tangent_coords(const ShadowMap& map, const Vec3s& q, TexelCoords& coords) {
    const ShadowImage& image = map.images[0];
    Floats a = q.x, b = q.y, depth = q.z, face = 0.0f;
    if (map.projection == LightProjection::all_around) {
        const Floats x = abs(q.x), y = abs(q.y), z = abs(q.z);
        const Mask16 along_x = (x >= y) & (x >= z), along_y = y >= z;
        a = select(along_x, q.y, select(along_y, q.z, q.x)), b = select(along_x, q.z, select(along_y, q.x, q.y));
        depth = select(along_x, q.x, select(along_y, q.y, q.z));
        face = select(along_x, 0.0f, select(along_y, 2.0f, 4.0f)) + select(depth < 0.0f, 1.0f, 0.0f);
        depth = abs(depth);
    }
    const Floats inverse = 1.0f / max(depth, 1e-20f);
    coords.u = fma(a * inverse, image.scale.x, image.offset.x);
    coords.v = fma(b * inverse, image.scale.y, image.offset.y);
    coords.w = sqrt(dot(q, q));
    coords.texel = depth * (1 / image.scale.x);
    coords.row = image.size.x;
    coords.first = truncate(face) * (image.size.x * image.size.y);
    coords.mapped = (depth > 0.0f) & in_image(coords.u, coords.v, image.size);
}

// Points in the map's own coordinates: the light, or the sun's anchor, is the origin. Linear along rays.
HWY_INLINE Vec3s turned_to_map(const ShadowMap& map, const Vec3s& p) {
    const mat3& m = map.world_to_map;
    return {dot(p, {m[0].x, m[1].x, m[2].x}), dot(p, {m[0].y, m[1].y, m[2].y}), dot(p, {m[0].z, m[1].z, m[2].z})};
}
HWY_INLINE Vec3s map_coordinates(const ShadowMap& map, const Vec3s& point) {
    return turned_to_map(map, point - splat(map.position));
}

HWY_INLINE TexelCoords texel_coords(const ShadowMap& map, const Vec3s& q) {
    TexelCoords coords;
    map.projection == LightProjection::parallel ? cascade_coords(map, q, coords) : tangent_coords(map, q, coords);
    coords.u = select(coords.mapped, coords.u, shadow_guard), coords.v = select(coords.mapped, coords.v, shadow_guard);
    return coords;
}

// Fraction of the light that reaches 16 points given in map coordinates, by percentage-closer filtering (Reeves et al.
// 1987): depths are compared first, then averaged.
HWY_INLINE Floats lit_fraction_at(const ShadowMap& map, const Vec3s& q) {
    if (map.empty()) return 1.0f;
    const TexelCoords coords = texel_coords(map, q);
    const Floats outside = map.projection == LightProjection::parallel ? 1.0f : 0.0f;
    if (!any(coords.mapped)) return outside;

    // Moves surfaces back by a millionth, to cover float rounding.
    const Floats depth = fma(coords.texel, -map.bias, coords.w - abs(coords.w) * 1e-6f);
    const float* stored = map.depth.data();
    const auto lit = [&](const Ints& texel) HWY_ATTR { return select(gather(stored, texel) >= depth, 1.0f, 0.0f); };
    if (map.pcf == 0)
        return select(coords.mapped, lit(coords.first + truncate(coords.v) * coords.row + truncate(coords.u)), outside);

    const Floats u = coords.u - 0.5f, v = coords.v - 0.5f;
    const Ints i = truncate(u), j = truncate(v);
    const Floats right = u - to_floats(i), down = v - to_floats(j);
    const Ints corner = coords.first + j * coords.row + i;
    const auto blend = [](const Floats& a, const Floats& b, const Floats& weight)
                           HWY_ATTR { return fma(b - a, weight, a); };
    if (map.pcf == 1) {
        const auto lit_pair = [&](const Ints& texel) HWY_ATTR {
            Floats first, second;
            gather_pairs(stored, texel, first, second);
            return blend(select(first >= depth, 1.0f, 0.0f), select(second >= depth, 1.0f, 0.0f), right);
        };
        return select(coords.mapped, blend(lit_pair(corner), lit_pair(corner + coords.row), down), outside);
    }
    Floats sum = 0.0f;
    for (int y = -1; y <= 2; ++y) {
        const Ints row = corner + coords.row * y;
        const Floats across = blend(lit(row + (-1)), lit(row + 2), right) + lit(row) + lit(row + 1);
        sum = fma(across, y == -1 ? 1.0f - down : y == 2 ? down : Floats(1.0f), sum);
    }
    return select(coords.mapped, sum * (1.0f / 9), outside);
}

HWY_INLINE Floats lit_fraction16(const ShadowMap& map, const Vec3s& point) {
    return map.empty() ? Floats(1.0f) : lit_fraction_at(map, map_coordinates(map, point));
}
}
HWY_AFTER_NAMESPACE();
#endif
