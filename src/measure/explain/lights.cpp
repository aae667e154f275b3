// Where one part of the ray sees a light, and what blocks it.
#include "measure/explain/parts.h"
#include "volume/medium.h"

#include "integrate/lights/light_along.h"
#include "scene/scene.h"
#include "trace/shadows/intervals/shadow_slices.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int blocker_places = 5;    // along a stretch
constexpr size_t blocker_points = 8; // of a soft light
constexpr int max_sheets = 8;        // BLEND surfaces before the blocker
constexpr double shortest = 1e-7;    // stretch, relative to the ray: less is rounding

// Where one more or one less point of the light is visible, or where its reach begins or ends.
struct Change {
    double t = 0;
    int seen = 0, reached = 0;
};

LightState lighting_of(int seen, int points) {
    return seen == 0 ? LightState::shadowed : seen < points ? LightState::partial : LightState::full;
}

std::vector<LightStretch> shares_of(std::vector<Change> changes, int points) {
    std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.t < b.t; });
    std::vector<LightStretch> shares;
    int seen = 0, reached = 0;
    for (size_t i = 0; i + 1 < changes.size(); ++i) {
        seen += changes[i].seen, reached += changes[i].reached;
        if (!(changes[i].t < changes[i + 1].t)) continue;
        const LightState state = reached > 0 ? lighting_of(seen, points) : LightState::out_of_reach;
        shares.push_back({changes[i].t, changes[i + 1].t, state, reached > 0 ? double(seen) / points : 0.0, {}});
    }
    return shares;
}

// Merges neighbors of the same state; a stretch shorter than `least` is merged into the one before it.
std::vector<LightStretch> joined(const std::vector<LightStretch>& shares, double least) {
    std::vector<LightStretch> result;
    for (const LightStretch& next : shares) {
        const double length = next.high - next.low;
        if (result.empty() || (next.state != result.back().state && length >= least)) {
            result.push_back(next);
            continue;
        }
        LightStretch& last = result.back();
        const double before = last.high - last.low;
        if (next.state == last.state) last.share = (last.share * before + next.share * length) / (before + length);
        last.high = next.high;
    }
    return result;
}

// The instance of the first opaque surface, or else of the first surface; -1 = none.
int blocking_instance(const Occluders& occluders, Ray ray) {
    int first = -1;
    for (int sheet = 0; sheet < max_sheets; ++sheet) {
        Hits hits;
        occluders.closest({&ray, 1}, 0, hits);
        if (hits.instance[0] < 0) return first;
        if (first < 0) first = hits.instance[0];
        if (occluders.surface(ray, hits, 0).alpha >= 1) return hits.instance[0];
        const float gone = hits.t[0] + surface_skip(ray.at(hits.t[0]), hits.t[0]);
        ray = {ray.at(gone), ray.direction, ray.t_max - gone};
        if (!(ray.t_max > 0)) return first;
    }
    return first;
}

dvec3 point_at(const Ray& ray, double t) { return dvec3(ray.origin) + t * dvec3(ray.direction); }
}

LightOnSegment light_on(const RayScene& scene, const RaySegment& segment, size_t index) {
    const Light& light = scene.fog.lights[index];
    const uint32_t count = scene.points_of(light);
    LightOnSegment on;
    on.light = index;
    for (uint32_t k = 0; k < count; ++k) on.points.push_back(light_point(segment.batch, 0, light, index, k, count));

    std::vector<Change> changes{{0, 0, 0}, {segment.ray.t_max, 0, 0}};
    find_light(light, on.points[0], segment.ray, nullptr, scene.fog.media, on.along);
    for (const Interval<double>& reached : on.along.lit)
        changes.push_back({reached.low, 0, 1}), changes.push_back({reached.high, 0, -1});
    const ShadowSlices* slices = scene.casters(index) ? &scene.casters(index)->shadow_slices() : nullptr;
    LightAlong along;
    for (const LightPoint& point : on.points) {
        find_light(light, point, segment.ray, slices, scene.fog.media, along);
        for (const Interval<double>& lit : along.lit)
            changes.push_back({lit.low, 1, 0}), changes.push_back({lit.high, -1, 0});
    }
    on.shares = shares_of(std::move(changes), static_cast<int>(count));
    on.lit = joined(on.shares, shortest * segment.ray.t_max);
    return on;
}

void add_alpha_shadows(const RayScene& scene, const RaySegment& segment, size_t first_step, const RayReport& report,
                       LightOnSegment& on, std::vector<LightAtStep>& at) {
    std::vector<LightStretch> seen;
    size_t stretch = 0;
    double done = 0; // distance up to which `seen` covers the part
    const auto copy_to = [&](double t) {
        while (stretch < on.lit.size() && on.lit[stretch].low < t) {
            LightStretch piece = on.lit[stretch];
            piece.low = std::max(piece.low, done), piece.high = std::min(piece.high, t);
            if (piece.low < piece.high) seen.push_back(piece);
            if (on.lit[stretch].high > t) break;
            ++stretch;
        }
        done = t;
    };
    for (size_t i = 0; i < at.size(); ++i) {
        if (!(at[i].share > 0)) continue;
        const RayStep& step = report.steps[first_step + i];
        const size_t points = std::min(on.points.size(), blocker_points);
        float through = 0;
        for (size_t p = 0; p < points; ++p)
            through += scene.casters(on.light)->transmission(
                ray_to_point(on.points[p], point_at(segment.ray, step.middle() - segment.start)), 0);
        through /= static_cast<float>(points);
        if (!(through < 1)) continue;
        at[i].share *= through;
        copy_to(step.low - segment.start);
        seen.push_back({step.low - segment.start,
                        step.high - segment.start,
                        through > 0 ? LightState::partial : LightState::shadowed,
                        at[i].share,
                        {}});
        done = step.high - segment.start;
        while (stretch < on.lit.size() && on.lit[stretch].high <= done) ++stretch;
    }
    copy_to(segment.ray.t_max);
    on.lit = joined(seen, shortest * segment.ray.t_max);
}

void name_blockers(const RayScene& scene, const RaySegment& segment, LightOnSegment& on) {
    for (LightStretch& stretch : on.lit) {
        if (stretch.state == LightState::full || stretch.state == LightState::out_of_reach) continue;
        std::vector<std::pair<int, std::string>> counts; // minus the number of hits, and the name
        for (int i = 0; i < blocker_places; ++i) {
            const double t = stretch.low + (stretch.high - stretch.low) * (i + 0.5) / blocker_places;
            for (size_t p = 0; p < std::min(on.points.size(), blocker_points); ++p) {
                const int instance =
                    blocking_instance(*scene.casters(on.light), ray_to_point(on.points[p], point_at(segment.ray, t)));
                if (instance < 0) continue;
                const std::string name = name_of_instance(*scene.snapshot.scene, instance);
                const auto known = std::ranges::find(counts, name, &std::pair<int, std::string>::second);
                if (known == counts.end())
                    counts.push_back({-1, name});
                else
                    --known->first;
            }
        }
        std::ranges::stable_sort(counts, {}, &std::pair<int, std::string>::first);
        for (auto& [count, name] : counts) stretch.blockers.push_back(std::move(name));
    }
}
}
