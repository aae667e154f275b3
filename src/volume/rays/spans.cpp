#include "volume/rays/spans.h"

#include "volume/bricks/brick_walk.h"
#include "volume/medium.h"

#include <numbers>

namespace tyndall {
namespace {
using std::numbers::ln2;
constexpr double farthest = 1e12; // meters; unbounded fog ends here
constexpr int highest_band = 24;  // density 2^-24 of that at the base; height fog above is ignored

// Calls visit(interval, largest density, smallest density) along homogeneous or height fog. Height fog is split into
// bands over which its density halves: band k spans (k-1)·ln 2 to k·ln 2 falloff lengths above the base, band 0 lies
// below it.
template<class Visit> void walk_bands(const Ray& ray, const Medium& medium, const Visit& visit) {
    const double t_max = std::min<double>(ray.t_max, farthest);
    const Interval<double> inside =
        clip(medium.density.bounds, local_ray(medium.density.world_to_local, ray), {0, t_max});
    if (inside.empty()) return;
    if (medium.density.kind == DensityKind::homogeneous) return visit(inside, 1.0, 1.0);

    const double start = (double(ray.origin.y) - medium.density.height_base) / medium.density.height_falloff;
    const double slope = double(ray.direction.y) / medium.density.height_falloff;
    const auto density = [&](double t) { return std::exp(-std::max(start + slope * t, 0.0)); };
    const double entry = (start + slope * inside.low) / ln2;
    int band = entry <= 0 ? 0 : 1 + static_cast<int>(std::min<double>(entry, highest_band));
    if (slope == 0) {
        if (band <= highest_band) visit(inside, density(0), density(0));
        return;
    }

    const bool rising = slope > 0;
    for (double low = inside.low; low < inside.high && band >= 0; band += rising ? 1 : -1) {
        if (rising && band > highest_band) return;
        const double edge = ((rising ? band : band - 1) * ln2 - start) / slope;
        const double high = !rising && band == 0 ? inside.high : std::min(inside.high, edge);
        if (high <= low) continue;
        if (band <= highest_band) visit({low, high}, density(rising ? low : high), density(rising ? high : low));
        low = high;
    }
}

// The interval inside a grid's box, and the part `within` it without the first and last voxel, in which density rises
// from 0 at the entry face and falls to 0 at the exit face.
struct GridStretch {
    Interval<double> whole, within;
};
GridStretch grid_stretch(const BrickPool& pool, const LocalRay& ray, double t_end) {
    constexpr double at_face = 0.01; // voxels
    const Interval<double> whole = clip(pool.local_bounds, ray, {0, t_end});
    const dvec3 entry = ray.origin + whole.low * ray.direction, exit = ray.origin + whole.high * ray.direction;
    const dvec3 low(pool.local_bounds.low), high(pool.local_bounds.high);
    Interval<double> within = whole;
    for (int axis = 0; axis < 3; ++axis) {
        const bool up = ray.direction[axis] > 0;
        const double voxel = 1 / std::abs(ray.direction[axis]);
        if ((up ? entry[axis] - low[axis] : high[axis] - entry[axis]) < at_face)
            within.low = std::max(within.low, whole.low + voxel);
        if ((up ? high[axis] - exit[axis] : exit[axis] - low[axis]) < at_face)
            within.high = std::min(within.high, whole.high - voxel);
    }
    return {whole, within};
}

void append_bricks(const BrickPool& pool, const LocalRay& ray, Interval<double> range, double extinction,
                   double varied_rate, bool apart, std::vector<Span>& spans) {
    const size_t first = spans.size();
    walk_bricks(pool, ray, range, [&](ivec3, int64_t at, double low, double high) {
        const Span span{low, high, extinction * pool.maximum[at], pool.index[at] < 0 ? 0 : varied_rate, apart};
        const bool joins = spans.size() > first && spans.back().high == low &&
                           spans.back().extinction == span.extinction && spans.back().rate == span.rate;
        if (joins)
            spans.back().high = high;
        else
            spans.push_back(span);
    });
}

void append_brick_spans(const Ray& ray, const Medium& medium, double t_end, const StepRule& rule,
                        std::vector<Span>& spans) {
    const BrickPool& pool = *medium.density.bricks;
    const LocalRay local = local_ray(pool, ray);
    const auto [whole, within] = grid_stretch(pool, local, t_end);
    if (whole.empty()) return;
    const double varied_rate = glm::length(local.direction) / rule.voxels, extinction = gray_extinction(medium.optics);

    // If no brick needs steps shorter than the rule's longest, one span replaces all bricks. A step in the few empty
    // ones costs less than finding them on every ray.
    const double highest = extinction * pool.highest, rate = std::max(varied_rate, highest / rule.optical_depth);
    const bool even = pool.crowded && rate * rule.length <= 1;
    const double longest_step = 1 / std::max(rate, 1.0 / rule.length);
    const auto append = [&](Interval<double> part, bool apart) {
        if (even && !part.empty())
            spans.push_back({part.low, part.high, highest, varied_rate, apart});
        else if (!part.empty())
            append_bricks(pool, local, part, extinction, varied_rate, apart, spans);
    };
    const Interval<double> in{whole.low, within.low}, out{within.high, whole.high};
    const bool in_apart = !within.empty() && in.length() < longest_step;
    const bool out_apart = !within.empty() && out.length() < longest_step;
    if (in_apart) append(in, true);
    append({in_apart ? within.low : whole.low, out_apart ? within.high : whole.high}, false);
    if (out_apart) append(out, true);
}
}

double horizon(const Ray& ray, std::span<const Medium> media) {
    double end = std::min<double>(ray.t_max, farthest);
    for (const Medium& medium : media) {
        if (medium.density.kind == DensityKind::bricks) continue;
        double depth = 0;
        walk_bands(ray, medium, [&](Interval<double> stretch, double, double smallest) {
            const double extinction = gray_extinction(medium.optics) * smallest;
            const double opaque = stretch.low + (opaque_depth - depth) / extinction;
            if (depth < opaque_depth && opaque < stretch.high) end = std::min(end, opaque);
            depth += extinction * stretch.length();
        });
    }
    return end;
}

void append_spans(const Ray& ray, const Medium& medium, double t_end, const StepRule& rule, std::vector<Span>& spans) {
    if (medium.density.kind == DensityKind::bricks) return append_brick_spans(ray, medium, t_end, rule, spans);
    walk_bands(ray, medium, [&](Interval<double> stretch, double largest, double) {
        const double high = std::min(stretch.high, t_end);
        if (stretch.low < high) spans.push_back({stretch.low, high, gray_extinction(medium.optics) * largest, 0});
    });
}

void append_near_spans(const Ray& ray, vec3 point, double closest, double ratio, double longest,
                       std::vector<Span>& spans) {
    const dvec3 direction(ray.direction), to_point = dvec3(point) - dvec3(ray.origin);
    const double middle = glm::dot(to_point, direction);
    const double distance = glm::length(to_point - middle * direction);
    const double inner = std::max(distance, closest);
    if (!(ratio > 0) || ratio * inner >= longest) return;

    // Shells of doubling radius; the rate of a shell follows from its inner radius.
    int shells = 1;
    while (ratio * std::ldexp(inner, shells) < longest && shells < 64) ++shells;
    const auto reach = [&](int shell) {
        const double radius = std::ldexp(inner, shell);
        return std::sqrt(std::max(radius * radius - distance * distance, 0.0));
    };
    const auto rate = [&](int shell) { return 1 / (ratio * std::ldexp(inner, shell)); };
    for (int k = shells - 1; k > 0; --k) spans.push_back({middle - reach(k + 1), middle - reach(k), 0, rate(k)});
    spans.push_back({middle - reach(1), middle + reach(1), 0, rate(0)});
    for (int k = 1; k < shells; ++k) spans.push_back({middle + reach(k), middle + reach(k + 1), 0, rate(k)});
}

void overlay(const std::vector<Span>& first, const std::vector<Span>& second, bool keep_second,
             std::vector<Span>& result) {
    constexpr double none = std::numeric_limits<double>::infinity();
    double at = -none;
    for (size_t i = 0, j = 0; i < first.size() || (keep_second && j < second.size());) {
        // The next piece begins where either list continues and ends at the next boundary of either.
        const double a = i < first.size() ? std::max(first[i].low, at) : none;
        const double b = j < second.size() ? std::max(second[j].low, at) : none;
        const double low = std::min(a, b);
        const double a_end = a == none ? none : a > low ? a : first[i].high;
        const double b_end = b == none ? none : b > low ? b : second[j].high;
        const double high = std::min(a_end, b_end);
        if (a == low && b == low)
            result.push_back({low, high, first[i].extinction + second[j].extinction,
                              std::max(first[i].rate, second[j].rate), first[i].apart || second[j].apart});
        else if (a == low)
            result.push_back({low, high, first[i].extinction, first[i].rate, first[i].apart});
        else if (keep_second)
            result.push_back({low, high, second[j].extinction, second[j].rate, second[j].apart});
        at = high;
        if (i < first.size() && first[i].high <= at) ++i;
        if (j < second.size() && second[j].high <= at) ++j;
    }
}
}
