#include "scene/lights/light_reach.h"

#include "scene/light.h"

namespace tyndall {
Interval<double> inside_cone(dvec3 apex, dvec3 axis, double half_angle, dvec3 origin, dvec3 direction) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const double length = glm::length(direction);
    const dvec3 d = direction / length;
    // Parametrized from the point nearest to the apex, so that no large terms cancel.
    const double nearest = glm::dot(apex - origin, d);
    const dvec3 p = (origin - apex) + nearest * d;
    const double dv = glm::dot(d, axis), pv = glm::dot(p, axis), pp = glm::dot(p, p);
    const double cosine = std::cos(half_angle), c2 = cosine * cosine;
    const auto to_t = [&](double s) { return (nearest + s) / length; };
    const auto inside = [&](double s) { return pv + s * dv >= cosine * std::sqrt(pp + s * s); };

    // A line through the apex crosses the cone only there.
    const double far = glm::length(apex - origin);
    if (pp <= 1e-24 * far * far || pp == 0) {
        if (std::abs(dv) < cosine) return {};
        return dv > 0 ? Interval<double>{to_t(0), endless} : Interval<double>{-endless, to_t(0)};
    }

    // Roots of ((p + s·d)·v)² = c² |p + s·d|², whose discriminant is c² (pv² + dv² pp - c² pp), on the cone ahead of
    // the apex.
    const double a = dv * dv - c2, b = dv * pv, c = pv * pv - c2 * pp;
    const double discriminant = c2 * (pv * pv + (dv * dv - c2) * pp);
    double root[2];
    int roots = 0;
    if (discriminant >= 0) {
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        const double found[2] = {a != 0 ? q / a : endless, q != 0 ? c / q : endless};
        for (const double s : found)
            if (std::isfinite(s) && pv + s * dv >= 0) root[roots++] = s;
    }
    if (roots == 2 && root[0] > root[1]) std::swap(root[0], root[1]);
    if (roots == 2 && inside(0.5 * (root[0] + root[1]))) return {to_t(root[0]), to_t(root[1])};
    if (roots > 0) {
        const double step = 1 + std::abs(root[0]) + std::abs(root[roots - 1]);
        if (inside(root[roots - 1] + step)) return {to_t(root[roots - 1]), endless};
        if (inside(root[0] - step)) return {-endless, to_t(root[0])};
        return {};
    }
    return inside(0) ? Interval<double>{-endless, endless} : Interval<double>{};
}

Interval<double> chord(double nearest, double distance, double radius, double length) {
    if (!(distance < radius)) return {};
    const double half = std::sqrt((radius - distance) * (radius + distance)) / length;
    return {nearest - half, nearest + half};
}

Interval<double> inside_ball(dvec3 center, double radius, dvec3 origin, dvec3 direction) {
    const double length = glm::length(direction);
    const dvec3 d = direction / length;
    const double nearest = glm::dot(center - origin, d);
    return chord(nearest / length, glm::length(center - origin - nearest * d), radius, length);
}

Interval<float> light_reach(const Light& light, const Ray& ray, Interval<float> stretch) {
    const Interval<double> reach = light_reach(light, dvec3(ray.origin), dvec3(ray.direction));
    const Interval<float> result =
        intersection(stretch, {static_cast<float>(reach.low), static_cast<float>(reach.high)});
    return result.empty() ? Interval<float>{} : result;
}
}
