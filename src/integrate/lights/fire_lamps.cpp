#include "integrate/lights/fire_lamps.h"

#include "base/random.h"
#include "integrate/lights/lamps.h"
#include "trace/lights/emissive_bricks.h"

#include <algorithm>
#include <numeric>

namespace tyndall {
namespace {
constexpr uint32_t places_asked = 1 << 14;

struct FireSample {
    dvec3 position{0}, candela{0};
    double weight = 0; // luminance of `candela`
};

// One part of the fire.
struct FirePart {
    std::vector<FireSample> places;
    dvec3 middle{0}, candela{0}, spread{0}; // spread: mean squared distance to `middle` per axis
    double weight = 0;
};

FirePart part_of(std::vector<FireSample> places) {
    FirePart part;
    for (const FireSample& place : places)
        part.candela += place.candela, part.weight += place.weight, part.middle += place.weight * place.position;
    part.middle /= part.weight;
    for (const FireSample& place : places) {
        const dvec3 offset = place.position - part.middle;
        part.spread += place.weight / part.weight * (offset * offset);
    }
    part.places = std::move(places);
    return part;
}

// Splits a part at its center along its longest axis; the second half is empty if the part has no extent.
std::pair<FirePart, FirePart> halves(FirePart part) {
    int axis = part.spread.x >= part.spread.y ? 0 : 1;
    if (part.spread.z > part.spread[axis]) axis = 2;
    const auto second = std::ranges::partition(
        part.places, [&](const FireSample& place) { return place.position[axis] <= part.middle[axis]; });
    std::vector<FireSample> after(second.begin(), second.end());
    part.places.erase(second.begin(), second.end());
    return {part_of(std::move(part.places)), after.empty() ? FirePart{} : part_of(std::move(after))};
}

std::vector<FireSample> fire_samples(const EmissiveBricks& fire) {
    std::vector<FireSample> places;
    for (uint32_t i = 0; i < places_asked; ++i) {
        const Sample2 first = sample2(i, hash(0xf12eu)), second = sample2(i, hash(0xf12fu));
        const EmissionSample place = sample_emission(fire, first.x, {first.y, second.x, second.y});
        const double weight = double{luminance(place.emission)} / place.pdf / places_asked;
        if (weight > 0)
            places.push_back(
                {dvec3(place.position), dvec3(place.emission) / double{place.pdf} / double{places_asked}, weight});
    }
    return places;
}

// Error measure of replacing a part by one lamp: weight times spread.
double split_error(const FirePart& part) { return part.weight * (part.spread.x + part.spread.y + part.spread.z); }
}

std::vector<Light> fire_lamps(const Snapshot& snapshot) {
    const auto fire = emissive_bricks(snapshot, Emitting::as_lamps);
    std::vector<FireSample> places = fire ? fire_samples(*fire) : std::vector<FireSample>{};
    if (places.empty()) return {};
    std::vector<FirePart> parts{part_of(std::move(places))};
    while (parts.size() < max_lamps) {
        const auto worst = std::ranges::max_element(parts, {}, split_error);
        if (!(split_error(*worst) > 0)) break;
        auto [one, other] = halves(std::move(*worst));
        *worst = std::move(one);
        if (other.places.empty()) break;
        parts.push_back(std::move(other));
    }
    std::vector<Light> lamps;
    for (const FirePart& part : parts) {
        Light lamp;
        lamp.name = "fire " + std::to_string(lamps.size() + 1);
        lamp.position = vec3(part.middle), lamp.intensity = vec3(part.candela);
        lamp.radius = ball_radius(part.spread);
        lamp.core = 1e-5f * snapshot.extent;
        lamp.surface_scale = 0;
        lamps.push_back(lamp);
    }
    return lamps;
}

// The mean of 1/r² over a ball of radius R at distance d is 1/d² · (1 + R²/(5 d²) + ...): the variance along an axis is
// R²/5, and ∇²(1/r²) = 2/r⁴.
double far_distance(const Light& lamp, double share) { return double{lamp.radius} / std::sqrt(5 * share); }

Snapshot with_fire_lamps(Snapshot snapshot) {
    const std::vector<Light> lamps = fire_lamps(snapshot);
    snapshot.lights.insert(snapshot.lights.end(), lamps.begin(), lamps.end());
    return snapshot;
}
}
