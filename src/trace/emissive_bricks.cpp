#include "trace/emissive_bricks.h"

#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
float mean_in_brick(const BrickPool& pool, size_t cell) {
    const int32_t id = pool.index[cell];
    if (id <= 0) return id == 0 ? 0 : pool.constants[static_cast<size_t>(-id - 1)];
    const uint16_t* values = &pool.values[static_cast<size_t>(id - 1) * brick_stride];
    float sum = 0;
    for (int i = 0; i < 729; ++i) sum += float_from_half(values[i]);
    return sum / 729;
}

double brick_volume(const BrickPool& pool) {
    return 512 * std::abs(static_cast<double>(glm::determinant(mat3(pool.index_to_world))));
}

void add_medium(const Medium& medium, uint32_t number, EmissiveBricks& glow, std::vector<double>& powers) {
    const BrickPool& pool = *medium.density.bricks;
    EmissiveBricks::MediumChances& chances = glow.media[number];
    chances.per_volume.assign(pool.index.size(), 0);
    const double brightness = luminance(medium.optics.emission.radiance) * brick_volume(pool);
    double brightest = 0;
    for (size_t cell = 0; cell < pool.index.size(); ++cell) {
        const double power = brightness * mean_in_brick(pool, cell);
        brightest += pool.maximum[cell];
        if (!(power > 0)) continue;
        glow.bricks.push_back({number, static_cast<uint32_t>(cell)}), powers.push_back(power);
    }
    // What an average line through the box finds: the mean of the bricks' maxima, over the length of the box.
    const double across = max_component(medium.world_bounds.size());
    const double mean = brightest / static_cast<double>(pool.index.size());
    chances.line_scale = static_cast<float>(mean * across > 0 ? 1 / (mean * across) : 0);
}

vec3 point_in(const BrickPool& pool, uint32_t cell, vec3 v) {
    const int number = static_cast<int>(cell);
    const ivec3 brick(number / (pool.size.y * pool.size.z), number / pool.size.z % pool.size.y, number % pool.size.z);
    return vec3(pool.index_to_world * vec4(8.0f * (vec3(brick) + v), 1));
}
}

EmissiveBricks make_emissive_bricks(std::span<const Medium> fields) {
    EmissiveBricks glow;
    std::vector<double> powers;
    glow.media.resize(fields.size());
    for (size_t m = 0; m < fields.size(); ++m) add_medium(fields[m], static_cast<uint32_t>(m), glow, powers);
    double total = 0;
    for (const double power : powers) glow.cumulative.push_back(total += power);
    for (double& sum : glow.cumulative) sum /= total;
    for (size_t i = 0; i < powers.size(); ++i) {
        const auto [medium, cell] = glow.bricks[i];
        glow.media[medium].per_volume[cell] =
            static_cast<float>(powers[i] / (total * brick_volume(*fields[medium].density.bricks)));
    }
    return glow;
}

EmissivePlace pick_emissive_place(const EmissiveBricks& glow, std::span<const Medium> fields, float u, vec3 v) {
    const auto found = std::ranges::upper_bound(glow.cumulative, static_cast<double>(u));
    const auto index = std::min<size_t>(static_cast<size_t>(found - glow.cumulative.begin()), glow.bricks.size() - 1);
    const auto [number, cell] = glow.bricks[index];
    const Medium& medium = fields[number];
    EmissivePlace place;
    place.position = point_in(*medium.density.bricks, cell, v);
    place.emission = emission_at(medium, place.position);
    place.density = glow.media[number].per_volume[cell];
    place.line_density = glow.media[number].line_scale * medium.density.bricks->maximum[cell];
    return place;
}

EmissiveDensities emissive_densities(const EmissiveBricks& glow, std::span<const Medium> fields, size_t medium,
                                     vec3 point) {
    const BrickPool& pool = *fields[medium].density.bricks;
    const ivec3 brick = glm::clamp(ivec3(glm::floor(local_point(pool, point) / 8.0f)), ivec3(0), pool.size - 1);
    const auto cell = static_cast<size_t>((brick.x * pool.size.y + brick.y) * pool.size.z + brick.z);
    return {glow.media[medium].per_volume[cell], glow.media[medium].line_scale * pool.maximum[cell]};
}
}
