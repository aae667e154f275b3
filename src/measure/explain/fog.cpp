// Divides the fog on one part of the ray into steps, and finds what each light contributes there.
#include "measure/explain/parts.h"
#include "volume/medium.h"

#include "integrate/style.h"
#include "scene/lights/light_reach.h"
#include "trace/transmittance/light_depth.h"
#include "volume/rays/fog_pieces.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int near_steps = 64; // of equal angle as seen from a local light, over what it reaches

// The density of one medium integrated from the start of the ray, in closed form.
struct Column {
    const std::vector<DensityPiece>& pieces;
    std::vector<double> before; // integral before each piece

    explicit Column(const std::vector<DensityPiece>& all) : pieces(all) {
        double sum = 0;
        for (const DensityPiece& piece : pieces) before.push_back(sum), sum += piece.column(piece.high);
    }
    double to(double t) const {
        const auto after = std::ranges::upper_bound(pieces, t, {}, &DensityPiece::low);
        if (after == pieces.begin()) return 0;
        const size_t i = static_cast<size_t>(after - pieces.begin()) - 1;
        return before[i] + pieces[i].column(std::min(t, pieces[i].high));
    }
};

struct FogOnSegment {
    FogPieces fog;
    std::vector<Column> columns; // of each medium

    Interval<double> range() const { return {fog.pieces.front().low, fog.pieces.back().high}; }
    double depth_to(double t) const {
        double sum = 0;
        for (size_t m = 0; m < columns.size(); ++m) sum += fog.extinction[m] * columns[m].to(t);
        return sum;
    }
};

// Ends of steps: equally spaced in distance, in optical depth and in angle around lamps; and at shadow boundaries.
std::vector<double> step_ends(const FogOnSegment& on, std::span<const LightOnSegment> lights, int count) {
    const Interval<double> range = on.range();
    std::vector<double> ends{range.low, range.high};
    for (int i = 1; i < count; ++i) ends.push_back(range.low + range.length() * i / count);
    const double depth = on.depth_to(range.high);
    for (int i = 1; i < count; ++i) {
        double low = range.low, high = range.high;
        while (high - low > 1e-6 * range.length())
            (on.depth_to(0.5 * (low + high)) < depth * i / count ? low : high) = 0.5 * (low + high);
        ends.push_back(0.5 * (low + high));
    }
    for (const LightOnSegment& light : lights) {
        double first = range.high, last = range.low;
        for (const LightStretch& stretch : light.lit) {
            ends.push_back(stretch.low), ends.push_back(stretch.high);
            if (stretch.state == LightState::out_of_reach) continue;
            first = std::min(first, std::max(stretch.low, range.low));
            last = std::max(last, std::min(stretch.high, range.high));
        }
        const LightAlong& along = light.along;
        if (!along.local() || !(first < last)) continue;
        const EquiAngular<double> angles = along.angles(first, last);
        for (int i = 1; i < near_steps; ++i) ends.push_back(angles.at(double(i) / near_steps).t);
    }
    std::erase_if(ends, [&](double t) { return !(t >= range.low && t <= range.high); });
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end(), [&](double a, double b) { return b - a < 1e-9 * range.high; }),
               ends.end());
    return ends;
}

// A step with the mean densities of all media.
struct Place {
    double low, high;
    std::vector<double> densities;
    double middle() const { return 0.5 * (low + high); }
};

RayStep step_at(const RayScene& scene, const RaySegment& segment, const FogOnSegment& on, const Place& place) {
    const StyleSettings& style = scene.truth.style;
    const double length = place.high - place.low;
    RayStep step;
    step.low = segment.start + place.low, step.high = segment.start + place.high;
    for (size_t m = 0; m < place.densities.size(); ++m) {
        const Optics& optics = scene.fog.media[m].optics;
        const vec3 middle = segment.ray.at(static_cast<float>(place.middle()));
        step.extinction += place.densities[m] * gray_extinction(optics);
        step.glow += only_emits(optics) ? emission_at(scene.fog.media[m], middle)
                                        : static_cast<float>(place.densities[m]) *
                                              (gray_extinction(optics) * albedo_at(optics, middle) * scene.fog.ambient +
                                               optics.emission.radiance);
    }
    const double before = on.depth_to(place.low), across = style.view_depth * step.extinction * length;
    const bool fades = style.range < StyleSettings{}.range;
    const float away = eye_distance(scene.view.camera, segment.ray.at(static_cast<float>(place.middle())));
    const double seen = segment.throughput * (fades ? style_fade(style, away) : 1);
    step.depth = segment.depth + on.depth_to(place.middle());
    step.to_eye = seen * std::exp(-style.view_depth * on.depth_to(place.middle()));
    step.reach =
        seen * std::exp(-style.view_depth * before) * length * (across > 0 ? -std::expm1(-across) / across : 1);
    return step;
}

// Mean visible share of the light over a step.
float share_over(const std::vector<LightStretch>& shares, double low, double high) {
    auto stretch = std::ranges::upper_bound(shares, low, {}, &LightStretch::high);
    double sum = 0;
    for (; stretch != shares.end() && stretch->low < high; ++stretch)
        sum += stretch->share * (std::min(high, stretch->high) - std::max(low, stretch->low));
    return static_cast<float>(sum / (high - low));
}

// Transmittance of the fog between a light and each step.
std::vector<LightAtStep> dimmed(const LightDepth& depth, const Ray& ray, std::span<const Place> places) {
    std::vector<LightAtStep> at(places.size());
    alignas(64) float x[16] = {}, y[16] = {}, z[16] = {}, depths[16];
    alignas(64) int32_t active[16];
    for (size_t first = 0; first < places.size(); first += 16) {
        const size_t count = std::min<size_t>(16, places.size() - first);
        for (size_t i = 0; i < 16; ++i) {
            active[i] = i < count ? -1 : 0;
            if (i >= count) continue;
            const dvec3 point = dvec3(ray.origin) + places[first + i].middle() * dvec3(ray.direction);
            x[i] = float(point.x), y[i] = float(point.y), z[i] = float(point.z);
        }
        light_depths(depth, x, y, z, active, depths);
        for (size_t i = 0; i < count; ++i) at[first + i].transmittance = std::exp(-depths[i]);
    }
    return at;
}

// Light scattered towards the eye in the middle of a step, if all of the light is visible.
vec3 scattered(const RayScene& scene, const LightAlong& along, const RaySegment& segment, const Place& place) {
    const LightSamplesAt arriving = arriving_at(along, place.middle());
    const double cosine = glm::dot(arriving.to_light, dvec3(segment.ray.direction));
    dvec3 sum(0);
    for (size_t m = 0; m < place.densities.size(); ++m) {
        const Optics& optics = scene.fog.media[m].optics;
        sum += place.densities[m] * gray_extinction(optics) * phase_value_of<double>(optics.phase, cosine) *
               dvec3(albedo_at(optics, segment.ray.at(static_cast<float>(place.middle()))));
    }
    return vec3(arriving.amount * sum * arriving.tint * dvec3(along.light->intensity * along.light->volume_scale));
}

std::vector<Place> places_of(const FogOnSegment& on, std::span<const LightOnSegment> lights, int count) {
    const std::vector<double> ends = step_ends(on, lights, count);
    std::vector<Place> places;
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        Place place{ends[i], ends[i + 1], {}};
        for (const Column& column : on.columns)
            place.densities.push_back((column.to(place.high) - column.to(place.low)) / (place.high - place.low));
        places.push_back(std::move(place));
    }
    return places;
}

// Moves a stretch by the distance at which its part starts on the ray.
LightStretch moved(LightStretch stretch, double by) {
    stretch.low += by, stretch.high += by;
    return stretch;
}
}

void append_fog(const RayScene& scene, const RaySegment& segment, RayReport& report) {
    FogOnSegment on;
    find_fog(segment.ray, scene.fog.media, scene.truth.march.min_transmittance, on.fog);
    for (size_t m = 0; m < on.fog.media; ++m) on.columns.emplace_back(on.fog.densities[m]);
    std::vector<LightOnSegment> lights;
    for (size_t l = 0; l < report.lights.size(); ++l) lights.push_back(light_on(scene, segment, l));

    const size_t first = report.steps.size();
    std::vector<Place> places;
    if (!on.fog.pieces.empty()) places = places_of(on, lights, scene.options.steps);
    for (const Place& place : places) {
        report.steps.push_back(step_at(scene, segment, on, place));
        report.glow += static_cast<float>(report.steps.back().reach) * report.steps.back().glow;
    }
    for (size_t l = 0; l < lights.size(); ++l) {
        std::vector<LightAtStep> at = dimmed(scene.depths[l], segment.ray, places);
        for (size_t i = 0; i < places.size(); ++i)
            at[i].share = share_over(lights[l].shares, places[i].low, places[i].high);
        if (report.lights[l].sampled) add_alpha_shadows(scene, segment, first, report, lights[l], at);
        for (size_t i = 0; i < places.size(); ++i)
            if (at[i].share > 0)
                at[i].scattered =
                    at[i].share * at[i].transmittance * scattered(scene, lights[l].along, segment, places[i]);
        name_blockers(scene, segment, lights[l]);
        for (const LightStretch& stretch : lights[l].lit)
            report.lights[l].stretches.push_back(moved(stretch, segment.start));
        report.lights[l].at.insert(report.lights[l].at.end(), at.begin(), at.end());
    }
    for (size_t m = 0; m < on.columns.size(); ++m)
        report.media[m].depth += on.fog.extinction[m] * on.columns[m].to(segment.ray.t_max);
    report.depth += on.depth_to(segment.ray.t_max);
}
}
