// Delta and ratio tracking over the constant-majorant segments of each kind of fog.
#include "volume/tracking.h"

#include "volume/bricks/brick_walk.h"
#include "volume/bricks/half.h"
#include "volume/medium.h"

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
}

float collision_distance(const Medium& medium, const Ray& ray, Interval<float> range, float first, RandomStream& random,
                         int& lookups) {
    double left = free_depth(first), found = infinity; // majorant optical depth to the next tentative collision
    walk_fog(medium, ray, range, [&](const Fog& fog, const auto& density) {
        const double majorant = static_cast<double>(gray_extinction(medium.optics)) * fog.majorant;
        for (double t = fog.low; majorant > 0;) {
            const double step = left / majorant;
            if (t + step >= fog.high) {
                left -= majorant * (fog.high - t);
                break;
            }
            t += step;
            if (fog.even() || (++lookups, random.next() * fog.majorant < density(t))) return found = t, false;
            left = free_depth(random.next());
        }
        return true;
    });
    return static_cast<float>(found);
}

float ratio_transmittance(const Medium& medium, const Ray& ray, Interval<float> range, RandomStream& random,
                          int& lookups) {
    if (medium.density.kind != DensityKind::bricks)
        return static_cast<float>(std::exp(-optical_depth(medium, {ray.at(range.low), ray.direction, range.length()})));
    constexpr double small = 0.1, often = 4;
    const double extinction = gray_extinction(medium.optics);
    double transmittance = 1, certain = 0; // transmittance so far, and control optical depth not yet applied to it
    double left = free_depth(random.next());
    walk_brick_fog(*medium.density.bricks, ray, {range.low, range.high}, [&](const Fog& fog, const auto& density) {
        certain += extinction * fog.minimum * (fog.high - fog.low);
        if (certain > small) transmittance *= std::exp(-certain), certain = 0;
        // Variance scales with the remaining light, so the optimal rate of lookups is proportional to it.
        const double varying = extinction * (fog.majorant - fog.minimum);
        for (double t = fog.low; varying > 0;) {
            const double rate = std::max(1.0, often * transmittance) * varying, step = left / rate;
            if (t + step >= fog.high) {
                left -= rate * (fog.high - t);
                break;
            }
            t += step, ++lookups;
            transmittance *= std::clamp(1 - extinction * (density(t) - fog.minimum) / rate, 0.0, 1.0);
            left = free_depth(random.next());
            if (transmittance < small) transmittance = random.next() * small < transmittance ? small : 0;
            if (transmittance == 0) return false;
        }
        return true;
    });
    return static_cast<float>(transmittance * std::exp(-certain));
}
}
