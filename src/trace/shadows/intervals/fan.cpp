// Bounds on where triangles can lie that shadow a ray, or any of several rays.
#include "trace/shadows/intervals/shadow_slice.h"

namespace tyndall {
namespace {
constexpr double farthest = 1e9; // meters

void set(ShadowFan& fan, int i, dvec3 normal, double least) {
    fan.x[i] = normal.x, fan.y[i] = normal.y, fan.z[i] = normal.z, fan.least[i] = least;
}

dvec3 normal_of(const ShadowFan& fan, int i) { return {fan.x[i], fan.y[i], fan.z[i]}; }

double slack(dvec3 point) { return 1e-9 * (1 + glm::length(point)); }

// Points whose convex hull contains everything between the rays and their lights, within the box of all triangles.
std::vector<dvec3> hull_of(std::span<const ShadowSlice> slices, std::span<const LightPoint> points, const Box& box) {
    const dvec3 middle = 0.5 * (dvec3(box.low) + dvec3(box.high));
    const double size = glm::length(dvec3(box.high) - middle);
    std::vector<dvec3> hull;
    for (size_t i = 0; i < slices.size(); ++i) {
        const dvec3 start = slices[i].origin, end = start + slices[i].x_max * slices[i].x;
        hull.push_back(start), hull.push_back(end);
        if (!points[i].far) {
            hull.push_back(points[i].at);
            continue;
        }
        const double beyond = size + std::max(glm::length(start - middle), glm::length(end - middle));
        hull.push_back(start + beyond * points[i].at), hull.push_back(end + beyond * points[i].at);
    }
    return hull;
}

double min_of(const std::vector<dvec3>& hull, dvec3 normal) {
    double least = std::numeric_limits<double>::infinity();
    for (const dvec3 point : hull) least = std::min(least, glm::dot(normal, point) - slack(point));
    return least;
}
}

ShadowSlice make_slice(const Ray& ray, const LightPoint& light) {
    ShadowSlice slice;
    slice.origin = dvec3(ray.origin), slice.far = light.far;
    slice.per_meter = glm::length(dvec3(ray.direction));
    slice.x = dvec3(ray.direction) / slice.per_meter;
    slice.x_max = std::min<double>(ray.t_max, farthest) * slice.per_meter;
    const dvec3 towards = light.far ? light.at : light.at - slice.origin;
    dvec3 across = towards - glm::dot(towards, slice.x) * slice.x;
    across -= glm::dot(across, slice.x) * slice.x; // removes rounding error along the ray, if `across` is small
    const dvec3 size = glm::abs(slice.origin);
    const double hair = 1e-9 * glm::length(towards) + (light.far ? 0 : 1e-12 * std::max({size.x, size.y, size.z, 1.0}));
    slice.light_x = glm::dot(towards, slice.x), slice.light_y = glm::length(across);
    if (slice.light_y > hair) {
        slice.y = across / slice.light_y;
    } else {
        const dvec3 other = std::abs(slice.x.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        slice.y = glm::normalize(glm::cross(slice.x, other)), slice.light_y = hair;
    }
    slice.normal = glm::cross(slice.x, slice.y);
    return slice;
}

ShadowFan make_fan(const ShadowSlice& s) {
    const double back_x = s.far ? s.light_x : s.light_x - s.x_max; // from the ray's end to the light
    const dvec3 no(0), end = s.x_max * s.x;
    const std::pair<dvec3, dvec3> sides[] = {{s.normal, no},
                                             {-s.normal, no},
                                             {s.y, no},
                                             {s.light_y * s.x - s.light_x * s.y, no},
                                             {back_x * s.y - s.light_y * s.x, end},
                                             {s.far ? no : -s.y, s.light_y * s.y}};
    ShadowFan fan;
    for (int i = 0; i < 6; ++i) {
        const auto& [side, point] = sides[i];
        if (side == no) continue;
        const dvec3 normal = glm::normalize(side);
        set(fan, i, normal, glm::dot(normal, s.origin + point) - slack(point));
    }
    return fan;
}

// The half spaces of the middle ray, moved until they contain all rays, and the outermost of the planes through the
// line from the rays' origin to the light.
ShadowSlices coherent_slices(const ShadowSlices& slices, std::span<const Ray> rays,
                             std::span<const LightPoint> points) {
    ShadowSlices found;
    found.corners = slices.corners;
    if (slices.nodes.empty()) return found;
    static thread_local std::vector<ShadowSlice> all;
    all.clear();
    for (size_t i = 0; i < rays.size(); ++i) all.push_back(make_slice(rays[i], points[i]));
    const std::vector<dvec3> hull = hull_of(all, points, {slices.nodes[0].low, slices.nodes[0].high});
    const ShadowSlice& middle = all[all.size() / 2];
    ShadowFan fan = make_fan(middle);
    for (int i = 0; i < 6; ++i)
        if (normal_of(fan, i) != dvec3(0)) fan.least[i] = min_of(hull, normal_of(fan, i));

    const dvec3 to_light = middle.light_x * middle.x + middle.light_y * middle.y;
    const dvec3 side = glm::cross(middle.normal, to_light);
    const auto [low, high] =
        std::ranges::minmax(all, {}, [&](const ShadowSlice& slice) { return glm::dot(slice.normal, side); });
    for (int i = 0; i < 2; ++i) {
        const dvec3 normal = i == 0 ? low.normal : high.normal;
        const double from = min_of(hull, normal), back = min_of(hull, -normal), here = glm::dot(normal, middle.origin);
        if (from - here > back + here)
            set(fan, 6 + i, normal, from);
        else
            set(fan, 6 + i, -normal, back);
    }
    append_leaves(slices, fan, found.nodes);
    return found;
}
}
