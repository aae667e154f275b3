#include "modes/cone/cone_integral.h"

#include <algorithm>
#include <cmath>

namespace tyndall::test {
namespace {
constexpr double endless = std::numeric_limits<double>::infinity();

Interval<double> inside(const Box& box, dvec3 origin, dvec3 direction, double length) {
    Interval<double> range{0, length};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return {};
            continue;
        }
        const double a = (box.low[axis] - origin[axis]) / direction[axis];
        const double b = (box.high[axis] - origin[axis]) / direction[axis];
        range.low = std::max(range.low, std::min(a, b)), range.high = std::min(range.high, std::max(a, b));
    }
    return range.high > range.low ? range : Interval<double>{};
}

// Mean of exp(-max(h, 0)/H) between two heights above the base: antiderivative H (1 - e^(-h/H)) above, h below.
double mean_density(double h0, double h1, double falloff) {
    if (std::abs(h1 - h0) < 1e-7 * falloff) return std::exp(-std::max(0.5 * (h0 + h1), 0.0) / falloff);
    const auto sum = [&](double h) { return h > 0 ? -falloff * std::expm1(-h / falloff) : h; };
    // From the lower end, so that thin air far up keeps its digits.
    const double low = std::min(h0, h1), high = std::max(h0, h1);
    if (low > 0) return std::exp(-low / falloff) * sum(high - low) / (high - low);
    return (sum(high) - sum(low)) / (high - low);
}

double depth(std::span<const Medium> media, dvec3 origin, dvec3 direction, double length) {
    double sum = 0;
    for (const Medium& medium : media) {
        const Interval<double> in = inside(medium.density.bounds, origin, direction, length);
        if (in.empty()) continue;
        const double h0 = origin.y + in.low * direction.y - medium.density.height_base;
        const double h1 = origin.y + in.high * direction.y - medium.density.height_base;
        const bool height = medium.density.kind == DensityKind::height;
        sum += gray_extinction(medium.optics) * in.length() *
               (height ? mean_density(h0, h1, medium.density.height_falloff) : 1);
    }
    return sum;
}

double strength(const Light& light, dvec3 to_light, double distance) {
    const double reach = capped_radius(light);
    double amount = 1 / std::max(distance * distance, reach * reach);
    if (!std::isinf(light.range)) amount *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
    if (!has_cone(light)) return amount;
    const dvec3 axis(light.direction);
    const double sine = glm::length(glm::cross(axis, to_light)), cosine = -glm::dot(axis, to_light);
    const double versine = cosine > 0 ? sine * sine / (1 + cosine) : 1 - cosine;
    const auto versine_of = [](double angle) { return 2 * std::pow(std::sin(angle / 2), 2); };
    const double outer = versine_of(light.outer_cone), inner = versine_of(light.inner_cone);
    const double x = std::clamp((outer - versine) / std::max(outer - inner, 1e-6), 0.0, 1.0);
    return amount * x * x;
}

// Gauss–Kronrod 7-15, halved until the two agree.
double adaptive(const std::function<double(double)>& f, double a, double b, double tolerance, int left) {
    static constexpr double x[] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                   0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                   0.586087235467691130294144691693,    0.405845151377397166906606412076961,
                                   0.207784955007898467600689403773245, 0};
    static constexpr double k[] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                   0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                   0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                   0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    static constexpr double g[] = {0, 0.129484966168869693270611432679082, 0, 0.279705391489276667901467771423780,
                                   0, 0.381830050505118944950369775488975, 0, 0.417959183673469387755102040816327};
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    double fine = 0, coarse = 0;
    for (int i = 0; i < 8; ++i) {
        const double sum = i == 7 ? f(middle) : f(middle - half * x[i]) + f(middle + half * x[i]);
        fine += k[i] * sum, coarse += g[i] * sum;
    }
    fine *= half, coarse *= half;
    if (std::abs(fine - coarse) <= tolerance || left == 0) return fine;
    return adaptive(f, a, middle, 0.5 * tolerance, left - 1) + adaptive(f, middle, b, 0.5 * tolerance, left - 1);
}
}

double cone_integral(const Light& light, std::span<const Medium> media, const Ray& ray) {
    const dvec3 o(ray.origin), d(ray.direction), apex(light.position), axis = glm::normalize(dvec3(light.direction));
    const bool sun = is_distant(light);
    const auto integrand = [&](double t) {
        const dvec3 point = o + t * d, towards = apex - point;
        const double away = glm::length(towards);
        const dvec3 to_light = sun ? -axis : away > 0 ? towards / away : -axis;
        const double amount = sun ? 1 : strength(light, to_light, away);
        if (amount == 0) return 0.0;
        double scattered = 0;
        for (const Medium& medium : media) {
            const Box& box = medium.density.bounds;
            if (glm::any(glm::lessThan(point, dvec3(box.low))) || glm::any(glm::greaterThan(point, dvec3(box.high))))
                continue;
            const double height = std::max(point.y - medium.density.height_base, 0.0) / medium.density.height_falloff;
            const double density = medium.density.kind == DensityKind::height ? std::exp(-height) : 1;
            scattered += gray_extinction(medium.optics) * density *
                         phase_value_of<double>(medium.optics.phase, glm::dot(to_light, d));
        }
        const double dim =
            depth(media, o, d, t) + depth(media, point, to_light, sun ? 1e12 : std::max(away - light.radius, 0.0));
        return scattered * amount * std::exp(-dim);
    };

    // Cut where the equation has its kinks; in between in the angle seen from the light.
    const double nearest = sun ? 0 : glm::dot(apex - o, d) / glm::dot(d, d);
    const double off = std::max(glm::length(apex - o - nearest * d), 1e-5);
    std::vector<double> cuts{0, double(ray.t_max), nearest};
    const auto add = [&](Interval<double> s) { cuts.push_back(s.low), cuts.push_back(s.high); };
    for (const Medium& medium : media) add(inside(medium.density.bounds, o, d, ray.t_max));
    if (has_cone(light))
        add(inside_cone(apex, axis, light.outer_cone, o, d)), add(inside_cone(apex, axis, light.inner_cone, o, d));
    for (const double radius : {double(light.range), double(capped_radius(light))})
        if (!sun && radius > off && std::isfinite(radius)) {
            const double half = std::sqrt(radius * radius - off * off);
            add({nearest - half, nearest + half});
        }
    std::erase_if(cuts, [&](double t) { return !(t >= 0 && t <= ray.t_max); });
    std::sort(cuts.begin(), cuts.end());
    const std::function<double(double)> in_angle = [&](double theta) {
        const double cosine = std::cos(theta);
        return integrand(nearest + off * std::tan(theta)) * off / (cosine * cosine);
    };
    const auto sum_with = [&](double tolerance, int left) {
        double sum = 0;
        for (size_t i = 0; i + 1 < cuts.size(); ++i) {
            const double a = cuts[i], b = cuts[i + 1];
            if (!(b > a)) continue;
            sum += sun ? adaptive(integrand, a, b, tolerance, left)
                       : adaptive(in_angle, std::atan((a - nearest) / off), std::atan((b - nearest) / off), tolerance,
                                  left);
        }
        return sum;
    };
    const double rough = sum_with(endless, 0);
    return sum_with(std::max(2e-6 * rough, 1e-14), 26);
}
}
