// Delta and ratio tracking over the constant-majorant segments of each kind of fog.
#include "volume/tracking.h"

#include "volume/bricks/brick_walk.h"
#include "volume/bricks/half.h"
#include "volume/medium.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
// A segment of fog along a ray, with bounds of its density.
struct Fog {
    double low = 0, high = 0;
    float minimum = 0, majorant = 0;

    bool even() const { return minimum == majorant; }
};

float lerp(float a, float b, float weight) { return a + weight * (b - a); }

// Trilinear density of a brick at a point in brick coordinates, 0..8.
float brick_value(const uint16_t* values, vec3 point) {
    const vec3 inside = glm::clamp(point, vec3(0), vec3(8));
    const ivec3 cell = glm::min(ivec3(inside), ivec3(7));
    const vec3 weight = inside - vec3(cell);
    const uint16_t* corner = values + (cell.x * 9 + cell.y) * 9 + cell.z;
    const auto along_z = [&](int offset) {
        return lerp(float_from_half(corner[offset]), float_from_half(corner[offset + 1]), weight.z);
    };
    return lerp(lerp(along_z(0), along_z(9), weight.y), lerp(along_z(81), along_z(90), weight.y), weight.x);
}

template<class Visit>
void walk_brick_fog(const BrickPool& pool, const Ray& ray, Interval<double> range, const Visit& visit) {
    const LocalRay local = local_ray(pool, ray);
    walk_bricks(pool, local, range, [&](ivec3 brick, int64_t at, double low, double high) {
        const int32_t id = pool.index[at];
        if (id < 0) return visit(Fog{low, high, pool.minimum[at], pool.maximum[at]}, [](double) { return 0.0f; });
        const uint16_t* values = &pool.values[size_t(id - 1) * brick_stride];
        const dvec3 start = local.origin - dvec3(brick * 8);
        return visit(Fog{low, high, pool.minimum[at], pool.maximum[at]},
                     [&](double t) { return brick_value(values, vec3(start + t * local.direction)); });
    });
}

// Height fog in layers of half a scale height, up to a density of about 2^-24.
template<class Visit>
void walk_height_fog(const Medium& medium, const Ray& ray, Interval<double> range, const Visit& visit) {
    constexpr int layers = 34;
    const double start = ray.origin.y - medium.density.height_base, slope = ray.direction.y,
                 falloff = medium.density.height_falloff;
    const auto density = [&](double t) {
        return static_cast<float>(std::exp(-std::max(start + t * slope, 0.0) / falloff));
    };
    if (slope == 0) return void(visit(Fog{range.low, range.high, density(0), density(0)}, density));

    // Layer 0 is below the base, layer k spans (k-1)/2 to k/2 scale heights above it.
    for (int i = 0; i <= layers && !range.empty(); ++i) {
        const int layer = slope > 0 ? i : layers - i;
        const double top = (0.5 * falloff * layer - start) / slope,
                     bottom = layer == 0 ? -infinity : (0.5 * falloff * (layer - 1) - start) / slope;
        const double enters = slope > 0 ? bottom : top;
        const double leaves = slope > 0 ? top : (layer == 0 ? infinity : bottom);
        const float above = layer == 0 ? 1.0f : static_cast<float>(std::exp(-0.5 * (layer - 1)));
        const Fog fog{std::max(range.low, enters), std::min(range.high, leaves), layer == 0 ? 1.0f : 0.0f, above};
        if (fog.low < fog.high && !visit(fog, density)) return;
    }
}

// Calls visit(fog, density function of t) for the segments of the ray in order until it returns false.
template<class Visit> void walk_fog(const Medium& medium, const Ray& ray, Interval<float> range, const Visit& visit) {
    const Interval<double> whole{range.low, range.high};
    if (medium.density.kind == DensityKind::bricks) return walk_brick_fog(*medium.density.bricks, ray, whole, visit);
    const Interval<double> inside = clip(medium.density.bounds, local_ray(medium.density.world_to_local, ray), whole);
    if (inside.empty()) return;
    if (medium.density.kind == DensityKind::height) return walk_height_fog(medium, ray, inside, visit);
    visit(Fog{inside.low, inside.high, 1, 1}, [](double) { return 1.0f; });
}

double free_depth(float u) { return -std::log1p(-static_cast<double>(u)); }

// A walk from one tentative collision to the next, up to a real one.
struct Walk {
    double distance = infinity; // to the real collision
    int tentative = 0;          // number of tentative collisions, real ones included
    double depth = 0;           // optical depth of the majorants up to the end, for an extinction of 1
};

Walk track(const Medium& medium, double extinction, const Ray& ray, Interval<float> range, float first,
           RandomStream& random, int& lookups) {
    Walk walk;
    double left = free_depth(first); // majorant optical depth to the next tentative collision
    walk_fog(medium, ray, range, [&](const Fog& fog, const auto& density) {
        const double majorant = extinction * fog.majorant;
        for (double t = fog.low; majorant > 0;) {
            const double step = left / majorant;
            if (t + step >= fog.high) {
                left -= majorant * (fog.high - t), walk.depth += fog.majorant * (fog.high - t);
                break;
            }
            t += step, ++walk.tentative, walk.depth += fog.majorant * step;
            if (fog.even() || (++lookups, random.next() * fog.majorant < density(t))) return walk.distance = t, false;
            left = free_depth(random.next());
        }
        return true;
    });
    return walk;
}

// Residual ratio tracking in N channels, of which the transmittance starts at the given values: where one is small or
// 0, less effort or none is spent on it.
template<size_t N> using Channels = std::array<double, N>;
template<size_t N>
Channels<N> ratio_track(const Medium& medium, const Channels<N>& extinction, Channels<N> transmittance, const Ray& ray,
                        Interval<float> range, RandomStream& random, int& lookups) {
    constexpr double small = 0.1, often = 4;
    Channels<N> certain{}; // control optical depth not yet applied
    double left = free_depth(random.next());
    walk_brick_fog(*medium.density.bricks, ray, {range.low, range.high}, [&](const Fog& fog, const auto& density) {
        for (size_t c = 0; c < N; ++c) {
            certain[c] += extinction[c] * fog.minimum * (fog.high - fog.low);
            if (certain[c] > small) transmittance[c] *= std::exp(-certain[c]), certain[c] = 0;
        }
        // Variance scales with the remaining light, so the optimal rate of lookups is proportional to it.
        const auto best_rate = [&] {
            double rate = 0;
            for (size_t c = 0; c < N; ++c)
                if (transmittance[c] > 0)
                    rate = std::max(rate, std::max(1.0, often * transmittance[c]) *
                                              (extinction[c] * (fog.majorant - fog.minimum)));
            return rate;
        };
        double rate = best_rate();
        for (double t = fog.low; rate > 0; rate = best_rate()) {
            const double step = left / rate;
            if (t + step >= fog.high) {
                left -= rate * (fog.high - t);
                break;
            }
            t += step, ++lookups;
            const double residual = density(t) - fog.minimum;
            for (double& share : transmittance)
                share *= std::clamp(1 - extinction[&share - transmittance.data()] * residual / rate, 0.0, 1.0);
            left = free_depth(random.next());
            if (std::ranges::any_of(transmittance, [&](double share) { return share < small; })) {
                const double survival = random.next() * small;
                for (double& share : transmittance)
                    if (share < small) share = survival < share ? small : 0;
            }
        }
        return std::ranges::any_of(transmittance, [](double share) { return share > 0; });
    });
    for (size_t c = 0; c < N; ++c) transmittance[c] *= std::exp(-certain[c]);
    return transmittance;
}

dvec3 channel_extinctions(const Medium& medium) {
    return double{gray_extinction(medium.optics)} * dvec3(medium.optics.channels);
}

double depth_on(const Medium& medium, const Ray& ray, Interval<float> range) {
    return optical_depth(medium, {ray.at(range.low), ray.direction, range.length()});
}
}

float collision_distance(const Medium& medium, const Ray& ray, Interval<float> range, float first, RandomStream& random,
                         int& lookups) {
    const double extinction = gray_extinction(medium.optics);
    return static_cast<float>(track(medium, extinction, ray, range, first, random, lookups).distance);
}

float collision_distance(const Medium& medium, int channel, const Ray& ray, Interval<float> range, float first,
                         RandomStream& random, int& lookups, vec3& pdfs) {
    if (is_gray(medium)) return collision_distance(medium, ray, range, first, random, lookups);
    const dvec3 extinctions = channel_extinctions(medium);
    const double own = extinctions[channel];
    const Walk walk = track(medium, own, ray, range, first, random, lookups);
    const dvec3 logarithms = double(walk.tentative) * glm::log(extinctions / own) - walk.depth * (extinctions - own);
    pdfs *= vec3(glm::exp(logarithms - std::max({logarithms.x, logarithms.y, logarithms.z})));
    return static_cast<float>(walk.distance);
}

float ratio_transmittance(const Medium& medium, const Ray& ray, Interval<float> range, RandomStream& random,
                          int& lookups) {
    if (medium.density.kind != DensityKind::bricks) return static_cast<float>(std::exp(-depth_on(medium, ray, range)));
    const double extinction = gray_extinction(medium.optics);
    return static_cast<float>(ratio_track<1>(medium, {extinction}, {1}, ray, range, random, lookups)[0]);
}

vec3 channel_transmittance(const Medium& medium, vec3 weights, const Ray& ray, Interval<float> range,
                           RandomStream& random, int& lookups) {
    if (is_gray(medium)) return vec3(ratio_transmittance(medium, ray, range, random, lookups));
    const dvec3 e = channel_extinctions(medium);
    if (medium.density.kind != DensityKind::bricks)
        return vec3(glm::exp(-depth_on(medium, ray, range) / gray_extinction(medium.optics) * e));
    const dvec3 w = dvec3(weights) / double{std::max(max_component(weights), 1e-37f)};
    const auto [x, y, z] = ratio_track<3>(medium, {e.x, e.y, e.z}, {w.x, w.y, w.z}, ray, range, random, lookups);
    return vec3(x > 0 ? x / w.x : 0, y > 0 ? y / w.y : 0, z > 0 ? z / w.z : 0);
}
}
