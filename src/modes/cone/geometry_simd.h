// Geometry of 16 rays and a cone (see base/simd/simd.h for how such files are compiled). Distances along a ray are
// relative to its closest point to the light; in the plane of ray and light, the cone is a wedge.
#if defined(TYNDALL_MODES_CONE_GEOMETRY_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_CONE_GEOMETRY_SIMD_H
#undef TYNDALL_MODES_CONE_GEOMETRY_SIMD_H
#else
#define TYNDALL_MODES_CONE_GEOMETRY_SIMD_H
#endif

#include "base/simd/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// a·b - c·d to within two rounding errors of the result, despite cancellation (Kahan).
HWY_INLINE Floats difference_of_products(const Floats& a, const Floats& b, const Floats& c, const Floats& d) {
    const Floats product = c * d;
    return fma(a, b, -product) - fma(c, d, -product);
}

HWY_INLINE Vec3s cross(const Vec3s& a, const Vec3s& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

// Angle of (x, y) to the x axis, for x, y >= 0: Taylor series for the half angle.
HWY_INLINE Floats angle_of(const Floats& y, const Floats& x) {
    const Mask16 steep = y > x;
    const Floats z = min(x, y) / max(max(x, y), 1e-37f);
    const Floats w = z / (1.0f + sqrt(fma(z, z, 1.0f))), w2 = w * w;
    Floats p = fma(w2, -1.0f / 15, 1.0f / 13);
    p = fma(p, -w2, 1.0f / 11), p = fma(p, -w2, 1.0f / 9), p = fma(p, -w2, 1.0f / 7);
    p = fma(p, -w2, 1.0f / 5), p = fma(p, -w2, 1.0f / 3), p = fma(p, -w2, 1.0f);
    const Floats angle = 2.0f * w * p;
    return select(steep, 0.5f * pi - angle, angle);
}

// cos u and sin(u)/u for 0 <= u <= π/2.
HWY_INLINE void cosine_and_sinc(const Floats& u, Floats& cosine, Floats& sinc) {
    const Floats u2 = u * u;
    Floats c = fma(u2, 1.0f / 479001600, -1.0f / 3628800), s = fma(u2, -1.0f / 39916800, 1.0f / 362880);
    c = fma(c, u2, 1.0f / 40320), c = fma(c, u2, -1.0f / 720), c = fma(c, u2, 1.0f / 24);
    s = fma(s, u2, -1.0f / 5040), s = fma(s, u2, 1.0f / 120), s = fma(s, u2, -1.0f / 6);
    cosine = fma(fma(c, u2, -0.5f), u2, 1.0f), sinc = fma(s, u2, 1.0f);
}

// Rays relative to a light at the origin: the closest point, its distance, and the components of the light's axis in
// the direction of that point, along the ray, and across both. `rest`: what rounding the origin to float loses, which
// matters close to a light.
struct SeenRays {
    Floats nearest, distance, squared; // t of the closest point; its distance, and the square
    Floats axis_out, axis_along, axis_across;
    Vec3s out; // unit, towards the closest point
};

HWY_INLINE SeenRays seen_rays(const Vec3s& origin, const Vec3s& rest, const Vec3s& direction, vec3 axis) {
    SeenRays seen;
    const Vec3s normal = cross(origin, direction) + cross(rest, direction);
    const Floats squared = dot(normal, normal);
    const Mask16 through = squared < 1e-30f; // the ray passes through the light: any `out` will do
    const Floats inverse = 1.0f / sqrt(select(through, 1.0f, squared));
    seen.nearest = -dot(origin, direction);
    seen.squared = zero_unless(!through, squared), seen.distance = sqrt(seen.squared);
    seen.out = cross(direction, normal * inverse);
    seen.axis_along = dot(direction, splat(axis));
    seen.axis_across = zero_unless(!through, dot(normal, splat(axis)) * inverse);
    const Floats aside = sqrt(max(1.0f - seen.axis_along * seen.axis_along, 0.0f));
    seen.axis_out = select(through, aside, dot(seen.out, splat(axis)));
    return seen;
}

// Interval of the rays within a half angle 0..π/2 of the axis: the wedge's sides, at ±ω from the projected axis with
// cos ω = cosine / cos(angle between axis and plane), meet the ray at distance · tan.
HWY_INLINE Interval<Floats> inside_wedge(const SeenRays& seen, float cosine, float sine) {
    const Floats across = abs(seen.axis_across), room = (sine - across) * (sine + across);
    const Floats turn = sqrt(max(room, 0.0f));
    const Floats low_x = fma(seen.axis_out, cosine, seen.axis_along * turn);
    const Floats low_y = fma(seen.axis_along, cosine, -(seen.axis_out * turn));
    const Floats high_x = fma(seen.axis_out, cosine, -(seen.axis_along * turn));
    const Floats high_y = fma(seen.axis_along, cosine, seen.axis_out * turn);
    const Mask16 low_ahead = low_x > 0.0f, high_ahead = high_x > 0.0f;
    // For a half-space (π/2) parallel to the ray, neither side is ahead.
    const Mask16 met = (room > 0.0f) & (low_ahead | high_ahead | (seen.axis_out > 0.0f));
    const Floats low = select(low_ahead, seen.distance * low_y / select(low_ahead, low_x, 1.0f), -infinity);
    const Floats high = select(high_ahead, seen.distance * high_y / select(high_ahead, high_x, 1.0f), infinity);
    return {select(met, low, 0.0f), select(met, high, 0.0f)};
}

// Nodes on a segment low..high (relative to the closest point, which is not inside), uniform in the angle θ seen from
// the light. With far the end of larger |s|, u = θ(far) - θ: s = (far cos u - d² sin(u)/d) / (cos u + far sin(u)/d),
// which holds for d = 0 too.
struct AnglePiece {
    Floats sign, near, far, squared;
    Floats angle, per_distance; // total angle, and angle / distance: ∫ ds/r²

    HWY_INLINE AnglePiece(const Interval<Floats>& piece, const SeenRays& seen) : squared(seen.squared) {
        sign = select(piece.low + piece.high < 0.0f, -1.0f, 1.0f);
        const Floats a = abs(piece.low), b = abs(piece.high);
        near = min(a, b), far = max(a, b);
        const Floats length = piece.high - piece.low, x = max(fma(far, near, squared), 1e-30f);
        const Floats y = seen.distance * length;
        angle = angle_of(y, x);
        per_distance = select(y < x * 1e-3f, length / x, angle / max(seen.distance, 1e-30f));
    }
    HWY_INLINE Floats place(float share) const {
        Floats cosine, sinc;
        cosine_and_sinc(angle * share, cosine, sinc);
        const Floats sine = per_distance * share * sinc;
        return sign * fma(sine, -squared, far * cosine) / fma(sine, far, cosine);
    }
    // Alternative nodes, denser near the closest point: ds = 3 share² · length · dshare.
    HWY_INLINE Floats cubic(float share) const { return sign * fma(far - near, share * share * share, near); }
};
}
HWY_AFTER_NAMESPACE();
#endif
