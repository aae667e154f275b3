#include "modes/froxel/beams/beam_shadows.h"

#include "scene/light.h"
#include "trace/shadows/cached_shadows.h"

#include <algorithm>

namespace tyndall {
namespace {
// Corners of a tetrahedron, rotated away from the axes that geometry tends to follow. From any side, they have the
// variance of the sphere's disk, a quarter of its squared radius along each axis.
constexpr double askew[4][3] = {
    {0.3323, 0.0873, -0.7949}, {-0.6396, -0.5836, -0.0170}, {-0.3117, 0.7623, 0.2679}, {0.6190, -0.2660, 0.5440}};
}

size_t lamp_points(const Light& light) { return is_soft(light) ? std::size(askew) : 1; }

LampViews lamp_views(const Snapshot& snapshot, const Light& light, const View& view, float margin) {
    if (!is_soft(light)) return {cached_shadow_view(snapshot, light, view, margin)};
    LampViews views;
    for (const auto& [x, y, z] : askew)
        views.push_back(cached_shadow_view(snapshot, light, view, margin, double(light.radius) * dvec3(x, y, z)));
    return views;
}

namespace {
// A segment, and the fraction of the lamp that lights it.
struct Shared {
    float low, high, share;
};

// The segments that one point of the lamp lights, per ray.
struct LitByPoint {
    LitSegments lit;
};

// Splits a ray wherever one of the points starts or stops lighting it. Neighboring points light similar segments, so
// their ends are almost sorted, and an insertion sort is fast.
void find_shares(const std::vector<LitByPoint>& points, size_t ray, std::vector<Shared>& shared) {
    static thread_local std::vector<std::pair<float, int>> ends;
    ends.clear(), shared.clear();
    size_t most = 0;
    for (const LitByPoint& point : points) most = std::max(most, point.lit[ray].size());
    const auto add = [&](double at, int change) {
        const auto end = static_cast<float>(at);
        size_t place = ends.size();
        ends.emplace_back();
        for (; place > 0 && end < ends[place - 1].first; --place) ends[place] = ends[place - 1];
        ends[place] = {end, change};
    };
    for (size_t k = 0; k < most; ++k) {
        for (const LitByPoint& point : points)
            if (k < point.lit[ray].size()) add(point.lit[ray][k].low, 1);
        for (const LitByPoint& point : points)
            if (k < point.lit[ray].size()) add(point.lit[ray][k].high, -1);
    }
    const float of_one = 1 / static_cast<float>(points.size());
    int count = 0;
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        count += ends[i].second;
        if (count > 0 && ends[i].first < ends[i + 1].first)
            shared.push_back({ends[i].first, ends[i + 1].first, of_one * static_cast<float>(count)});
    }
}

// Squared distance from the lamp.
float distance2(const Ray& ray, vec3 lamp, float t) {
    const vec3 way = ray.at(t) - lamp;
    return glm::dot(way, way);
}

// Merges adjacent short segments into one fully lit segment as long as their lit part, around their mean, or extends a
// fully lit neighbor: over such a short part of a ray, the lamp's light is uniform.
void join_short(const Ray& ray, vec3 lamp, std::vector<Shared>& shared) {
    constexpr float little = 0.05f; // of the distance to the lamp
    const auto is_short = [&](float low, float high) {
        const float length = (high - low) / little;
        return length * length < std::min(distance2(ray, lamp, low), distance2(ray, lamp, high));
    };
    size_t kept = 0;
    for (size_t i = 0, next; i < shared.size(); i = next) {
        const float low = shared[i].low;
        float amount = 0, moment = 0;
        for (next = i; next < shared.size() && is_short(low, shared[next].high); ++next) {
            const Shared& s = shared[next];
            amount += s.share * (s.high - s.low),
                moment += s.share * (s.high - s.low) * (0.5f * (s.low + s.high) - low);
        }
        if (next == i) {
            shared[kept++] = shared[next++];
            continue;
        }
        const float middle = low + moment / amount;
        if (next < shared.size() && shared[next].share == 1 && shared[next].low == shared[next - 1].high)
            shared[next].low -= amount;
        else if (kept > 0 && shared[kept - 1].share == 1 && shared[kept - 1].high == low)
            shared[kept - 1].high += amount;
        else
            shared[kept++] = {middle - 0.5f * amount, middle + 0.5f * amount, 1};
    }
    shared.resize(kept);
}
}

void find_lit_segments(const LampViews& views, vec3 lamp, const RayBatch& batch, float margin, const float (&low)[16],
                       const float (&high)[16], LitIntervals& lit) {
    static thread_local std::vector<LitByPoint> points;
    points.resize(views.size());
    Interval<double> ranges[16];
    for (size_t i = 0; i < 16; ++i) ranges[i] = {low[i], high[i]};
    const int tile = tile_of(*views.front(), batch.positions, margin);
    for (size_t k = 0; k < views.size(); ++k) {
        for (std::vector<Interval<double>>& of_ray : points[k].lit) of_ray.clear();
        append_lit(*views[k], batch.rays, ranges, tile, points[k].lit);
    }

    static thread_local std::vector<Shared> shared;
    lit.rows.clear();
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        if (!(low[i] < high[i])) continue;
        find_shares(points, i, shared);
        join_short(batch.rays[i], lamp, shared);
        for (size_t k = 0; k < shared.size(); ++k) {
            if (k == lit.rows.size()) lit.rows.emplace_back();
            LitIntervals::Row& row = lit.rows[k];
            row.low[i] = shared[k].low, row.high[i] = shared[k].high, row.share[i] = shared[k].share;
        }
    }
    for (LitIntervals::Row& row : lit.rows) {
        row.all = {infinity, -infinity};
        for (size_t i = 0; i < 16; ++i)
            if (row.low[i] < row.high[i])
                row.all = {std::min(row.all.low, row.low[i]), std::max(row.all.high, row.high[i])};
    }
}
}
