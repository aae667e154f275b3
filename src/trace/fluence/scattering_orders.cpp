#include "trace/fluence/scattering_orders.h"

#include "base/parallel.h"
#include "trace/fluence/light_paths.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
// Probability of a collision in a homogeneous sphere of optical radius a, from a random point in a random direction.
double chance_to_stay(double a) {
    if (a < 0.03) return a * (0.75 - a * (0.4 - a / 6)); // series of the closed form below
    return 1 - 3 / (8 * a * a * a) * (2 * a * a - 1 + (1 + 2 * a) * std::exp(-2 * a));
}
}

double multiple_over_single(double optical_radius, double albedo) {
    const double staying = albedo * chance_to_stay(optical_radius);
    return staying < 1 ? staying / (1 - staying) : double(infinity);
}

double multiple_over_single(const Medium& medium) {
    const vec3 albedo = medium.optics.albedo;
    const double w = max_component(albedo), sigma = gray_extinction(medium.optics);
    if (!is_finite(medium.world_bounds.size())) return w < 1 ? w / (1 - w) : double(infinity);
    const double density = medium.density.kind == DensityKind::bricks ? double(medium.density.bricks->mean) : 1.0;
    const dvec3 size(medium.world_bounds.size());
    return multiple_over_single(sigma * density * std::cbrt(0.75 / pi * size.x * size.y * size.z), w);
}

ScatteringRatio measured_ratio(const Snapshot& snapshot, int paths, uint32_t seed) {
    constexpr int64_t batches = 64;
    LightPathRules rules;
    rules.reach = light_reach(snapshot);
    rules.orders = 65536, rules.seed = seed;
    if (!has_lights(snapshot) || snapshot.media.empty()) return {};
    const int64_t each = std::max<int64_t>(paths / batches, 1);
    const RayStrata strata = even_strata(snapshot, rules.reach, 1);
    std::vector<LightPathResult> results(batches);
    parallel_for(batches, [&](int64_t b) {
        trace_light_paths(snapshot, strata, rules, b * each, each, batches * each, results[static_cast<size_t>(b)]);
    });

    // Ratio estimator, with its variance from the batches' residuals (Cochran 1977, section 2.11).
    double once = 0, more = 0, squares = 0;
    int64_t seen = 0;
    for (const LightPathResult& result : results) {
        once += result.scattered_once, more += result.scattered_more;
        seen += result.first_scatterings;
    }
    const bool surfaces = snapshot.occluders && !snapshot.occluders->empty();
    const double most = surfaces ? infinity : truncation_bound(snapshot, 1);
    if (!(once > 0)) return {more > 0 ? infinity : 0, 0, truncation_bound(snapshot, 1) > 0 ? most : 0}; // no path hit
    const double ratio = more / once;
    for (const LightPathResult& result : results) {
        const double residual = result.scattered_more - ratio * result.scattered_once;
        squares += residual * residual;
    }
    constexpr double student = 2.0; // Student's t, 63 degrees of freedom
    const double spread = student * std::sqrt(squares * batches / (batches - 1.0)) / once;
    const double unseen = 3 / static_cast<double>(seen); // the rule of three: 95 % bound if no event was seen
    const double high = ratio + std::max(spread, unseen);
    return {ratio, std::max(0.0, ratio - spread), std::min(high, most)};
}

double truncation_bound(const Snapshot& snapshot, int orders) {
    double depth = 0, albedo = 0;
    for (const Medium& medium : snapshot.media) {
        const vec3 size = medium.world_bounds.size();
        depth += is_finite(size) ? double(medium.majorant()) * glm::length(dvec3(size)) : double(infinity);
        albedo = std::max<double>(albedo, max_component(medium.optics.albedo));
    }
    const double q = albedo * -std::expm1(-depth);
    return q < 1 ? std::pow(q, orders) / (1 - q) : double(infinity);
}
}
