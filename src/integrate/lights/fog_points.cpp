#include "integrate/lights/fog_points.h"

#include "base/random.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <algorithm>

namespace tyndall {
vec2 point_numbers(const RayBatch& batch, size_t ray, uint32_t k, uint32_t count, uint32_t use) {
    const SampleIndex sample =
        batch.sample_indices.empty() ? SampleIndex{0, batch.ids[ray]} : batch.sample_indices[ray];
    const Sample2 u = sample2(sample.index * count + k, hash(sample.sequence, use));
    return {u.x, u.y};
}

namespace {
// Finds the distance and piece where the optical depth along the ray reaches `depth`: Newton's method with bracketing.
double distance_at(const FogPieces& fog, double depth, size_t& piece) {
    const auto after = std::upper_bound(fog.pieces.begin() + 1, fog.pieces.end(), depth,
                                        [](double d, const FogPieces::Piece& p) { return d < p.depth; });
    piece = static_cast<size_t>(after - fog.pieces.begin()) - 1;
    double low = fog.pieces[piece].low, high = fog.pieces[piece].high, t = 0.5 * (low + high);
    for (int i = 0; i < 24 && high - low > 1e-9 * high; ++i) {
        const double off = fog.depth_at(piece, t) - depth;
        (off > 0 ? high : low) = t;
        double slope = 0;
        for (size_t m = 0; m < fog.media; ++m) slope += fog.extinction[m] * fog.density(piece, m, t);
        const double next = slope > 0 ? t - off / slope : low;
        if (std::abs(next - t) < 1e-9 * high) break;
        t = next > low && next < high ? next : 0.5 * (low + high);
    }
    return t;
}
}

double FogSampler::distance(double u, size_t& piece) const {
    return distance_at(pieces, factor > 0 ? -std::log1p(-factor * u * whole) / factor : u * whole, piece);
}

FogSampler fog_sampler(const FogPieces& pieces, double factor) {
    return {pieces, factor, factor > 0 ? -std::expm1(-factor * pieces.depth) / factor : pieces.depth};
}

EquiAngularSampler equi_angular_sampler(const Ray& ray, const FogPieces& fog, dvec3 point, double radius,
                                        Interval<double> reach) {
    EquiAngularSampler result;
    result.stretch = {std::max(fog.pieces.front().low, reach.low), std::min(fog.pieces.back().high, reach.high)};
    if (!(result.stretch.high > result.stretch.low)) return result;
    const dvec3 offset = point - dvec3(ray.origin), direction(ray.direction);
    const double nearest = glm::dot(offset, direction);
    const double height = std::max(glm::length(offset - nearest * direction), radius);
    result.angles = equi_angular(nearest, height, result.stretch.low, result.stretch.high);
    return result;
}

size_t piece_at(const FogPieces& fog, double t) {
    const auto after = std::upper_bound(fog.pieces.begin(), fog.pieces.end(), t,
                                        [](double d, const FogPieces::Piece& p) { return d < p.low; });
    const size_t index = static_cast<size_t>(after - fog.pieces.begin());
    return index > 0 && t < fog.pieces[index - 1].high ? index - 1 : fog.pieces.size();
}

double evaluate_fog(const FogPieces& fog, size_t piece, const Ray& ray, double t, FogSample& there) {
    there.point = ray.at(static_cast<float>(t)), there.direction = ray.direction;
    there.shares.assign(fog.media, 0);
    double total = 0;
    for (size_t m = 0; m < fog.media; ++m) total += fog.extinction[m] * fog.density(piece, m, t);
    if (!(total > 0)) return 0;
    for (size_t m = 0; m < fog.media; ++m)
        there.shares[m] = static_cast<float>(fog.extinction[m] * fog.density(piece, m, t) / total);
    return total;
}

std::pair<vec3, float> scattered(const std::vector<Medium>& media, const FogSample& fog, vec3 towards) {
    const float cosine = glm::dot(fog.direction, towards);
    vec3 albedo(0);
    float density = 0;
    for (size_t m = 0; m < media.size(); ++m) {
        if (!(fog.shares[m] > 0)) continue;
        const Optics& optics = media[m].optics;
        const float share = fog.shares[m] * phase_value(optics.phase, cosine);
        albedo += share * (optics.albedo_field ? albedo_at(optics, fog.point) : optics.albedo), density += share;
    }
    return {albedo, density};
}

vec3 direction_by_phase(const std::vector<Medium>& media, const FogSample& fog, float which, vec2 u) {
    size_t m = 0;
    while (m + 1 < media.size() && which >= fog.shares[m]) which -= fog.shares[m++];
    while (m > 0 && !(fog.shares[m] > 0)) --m;
    return sample_phase(media[m].optics.phase, fog.direction, u);
}
}
