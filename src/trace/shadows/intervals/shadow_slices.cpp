// From a ray and a light to lit intervals. All geometry is in double; vertices are the floats that Embree has.
#include "trace/shadows/intervals/shadow_slice.h"

namespace tyndall {
namespace {
using Point = ShadowSlice::Point;
using Slice = ShadowSlice;

// Appends the interval that a segment shadows: the point (x, y) lies between t and the light (lx, ly) if
// t = (x·ly - y·lx) / (ly - w·y), with w = 0 for a sun and 1 otherwise, and 0 < y < ly.
void append_shadow(const Slice& slice, Point a, Point b, std::vector<Interval<double>>& shadows) {
    if (a.y > b.y) std::swap(a, b);
    const double top = slice.far ? std::numeric_limits<double>::infinity() : shadow_reach<double> * slice.light_y;
    if (!(b.y > 0) || !(a.y < top)) return;
    const Point low = a, high = b;
    if (a.y < 0) a = {between(low, high, -low.y / (high.y - low.y)).x, 0};
    if (b.y > top) b = {between(low, high, (top - low.y) / (high.y - low.y)).x, top};
    const auto on_ray = [&](Point p) {
        return (p.x * slice.light_y - p.y * slice.light_x) / (slice.light_y - (slice.far ? 0 : p.y));
    };
    const double s = on_ray(a), t = on_ray(b);
    const Interval<double> shadow{std::max(std::min(s, t), 0.0), std::min(std::max(s, t), slice.x_max)};
    if (!shadow.empty()) shadows.push_back({shadow.low / slice.per_meter, shadow.high / slice.per_meter});
}

// The interval of the line start + t·along inside a circle; empty if it misses.
Interval<double> in_ball(Point start, Point along, Point center, double squared_radius) {
    const double dx = start.x - center.x, dy = start.y - center.y;
    const double a = along.x * along.x + along.y * along.y, b = along.x * dx + along.y * dy;
    const double inside = b * b - a * (dx * dx + dy * dy - squared_radius);
    if (!(a > 0) || !(inside > 0)) return {};
    return {(-b - std::sqrt(inside)) / a, (-b + std::sqrt(inside)) / a};
}

// The light's sphere in the slice's coordinates.
struct Ball {
    Point center{0, 0};
    double squared_radius = 0; // of the disc in which the plane intersects it
};

Ball ball_in(const Slice& slice, const LightPoint& light) {
    if (slice.far || !(light.radius > 0)) return {};
    const dvec3 center = light.center - slice.origin;
    const double off = glm::dot(slice.normal, center);
    return {{glm::dot(slice.x, center), glm::dot(slice.y, center)}, light.radius * light.radius - off * off};
}

void append_outside(const Slice& slice, const Ball& ball, Point a, Point b, std::vector<Interval<double>>& shadows) {
    const Interval<double> inside = in_ball(a, {b.x - a.x, b.y - a.y}, ball.center, ball.squared_radius);
    if (inside.empty() || inside.low >= 1 || inside.high <= 0) return append_shadow(slice, a, b, shadows);
    if (inside.low > 0) append_shadow(slice, a, between(a, b, inside.low), shadows);
    if (inside.high < 1) append_shadow(slice, between(a, b, inside.high), b, shadows);
}

// Appends the parts of 0..t_max that no shadow covers; ignores gaps below rounding.
void append_gaps(std::vector<Interval<double>>& shadows, double t_max, std::vector<Interval<double>>& lit) {
    std::sort(shadows.begin(), shadows.end(), [](Interval<double> a, Interval<double> b) { return a.low < b.low; });
    const double smallest = 1e-12 * (1 + t_max);
    double from = 0;
    for (const Interval<double>& shadow : shadows) {
        if (shadow.low > from + smallest) lit.push_back({from, shadow.low});
        from = std::max(from, shadow.high);
    }
    if (t_max > from + smallest) lit.push_back({from, t_max});
}

// Adds the interval inside the light's sphere, where everything is lit.
void add_stretch(Interval<double> added, std::vector<Interval<double>>& lit) {
    if (added.empty()) return;
    std::vector<Interval<double>> joined;
    for (const Interval<double>& stretch : lit) {
        if (stretch.high < added.low || stretch.low > added.high)
            joined.push_back(stretch);
        else
            added = {std::min(added.low, stretch.low), std::max(added.high, stretch.high)};
    }
    joined.push_back(added);
    std::sort(joined.begin(), joined.end(), [](Interval<double> a, Interval<double> b) { return a.low < b.low; });
    lit = std::move(joined);
}
}

void find_lit(const ShadowSlices& slices, const Ray& ray, const LightPoint& light, std::vector<Interval<double>>& lit) {
    static thread_local std::vector<Interval<double>> shadows;
    static thread_local std::vector<ShadowSlice::Segment> segments;
    lit.clear();
    if (!(ray.t_max > 0) || !is_finite(ray.origin) || !is_finite(ray.direction)) return;
    const Slice slice = make_slice(ray, light);
    const double t_max = slice.x_max / slice.per_meter;
    if (slices.nodes.empty()) return lit.push_back({0, t_max});
    const Ball ball = ball_in(slice, light);
    shadows.clear(), segments.clear();
    append_segments(slices, slice, segments);
    for (const auto& [a, b] : segments)
        if (ball.squared_radius > 0)
            append_outside(slice, ball, a, b, shadows);
        else
            append_shadow(slice, a, b, shadows);
    append_gaps(shadows, t_max, lit);
    if (ball.squared_radius > 0) {
        const Interval<double> inside = in_ball({0, 0}, {slice.per_meter, 0}, ball.center, ball.squared_radius);
        add_stretch({std::max(inside.low, 0.0), std::min(inside.high, t_max)}, lit);
    }
}

namespace {
void set_lane(ShadowPacket& packet, size_t i, const Slice& slice) {
    for (int axis = 0; axis < 3; ++axis) {
        packet.origin[axis][i] = slice.origin[axis], packet.normal[axis][i] = slice.normal[axis];
        packet.x[axis][i] = slice.x[axis], packet.y[axis][i] = slice.y[axis];
    }
    packet.light_x[i] = slice.light_x, packet.light_y[i] = slice.light_y, packet.near[i] = slice.far ? 0 : 1;
    packet.top[i] = slice.far ? std::numeric_limits<double>::infinity() : shadow_reach<double> * slice.light_y;
    packet.end[i] = slice.x_max, packet.meters[i] = 1 / slice.per_meter;
    packet.active |= 1u << i;
}

// Whether a light's sphere overlaps a box.
bool meets_ball(const LightPoint& light, const ShadowSlices::Node& box) {
    if (light.far || !(light.radius > 0)) return false;
    const dvec3 nearest = glm::clamp(light.center, dvec3(box.low), dvec3(box.high));
    return glm::distance(nearest, light.center) <= light.radius;
}
}

void find_lit(const ShadowSlices& slices, std::span<const Ray> rays, std::span<const LightPoint> points,
              std::vector<Interval<double>> (&lit)[16]) {
    static thread_local std::vector<Interval<double>> shadows[16];
    static thread_local std::vector<ShadowSlice::Segment> segments;
    ShadowPacket packet;
    Slice planes[16];
    for (size_t i = 0; i < rays.size(); ++i) {
        lit[i].clear(), shadows[i].clear();
        if (!(rays[i].t_max > 0) || !is_finite(rays[i].origin) || !is_finite(rays[i].direction)) continue;
        planes[i] = make_slice(rays[i], points[i]);
        set_lane(packet, i, planes[i]);
    }

    ShadowSlices around; // leaves in a light's sphere, whose triangles are clipped at its surface
    around.corners = slices.corners;
    for (size_t at = 0; at < slices.nodes.size(); ++at) {
        const ShadowSlices::Node& node = slices.nodes[at];
        if (node.count == 0) continue;
        if (std::ranges::any_of(points, [&](const LightPoint& point) { return meets_ball(point, node); }))
            around.nodes.push_back(node);
        else
            append_shadows(slices, node, packet, shadows);
    }
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!(packet.active >> i & 1)) continue;
        const Ball ball = ball_in(planes[i], points[i]);
        segments.clear();
        if (!around.nodes.empty()) append_segments(around, planes[i], segments);
        for (const auto& [a, b] : segments) append_outside(planes[i], ball, a, b, shadows[i]);
        const double t_max = planes[i].x_max / planes[i].per_meter;
        append_gaps(shadows[i], t_max, lit[i]);
        if (!(ball.squared_radius > 0)) continue;
        const Interval<double> inside = in_ball({0, 0}, {planes[i].per_meter, 0}, ball.center, ball.squared_radius);
        add_stretch({std::max(inside.low, 0.0), std::min(inside.high, t_max)}, lit[i]);
    }
}
}
