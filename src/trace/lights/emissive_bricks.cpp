#include "trace/lights/emissive_bricks.h"

#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/rays/emission_nodes.h"

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

void add_field(uint32_t number, EmissiveBricks& fire, std::vector<double>& powers) {
    const Medium& field = fire.fields[number];
    const BrickPool& pool = *field.density.bricks;
    EmissiveBricks::FieldPdfs& pdfs = fire.pdfs[number];
    pdfs.per_volume.assign(pool.index.size(), 0);
    const double brightness = luminance(field.optics.emission.radiance) * brick_volume(pool);
    double brightest = 0;
    for (size_t cell = 0; cell < pool.index.size(); ++cell) {
        const double power = brightness * mean_in_brick(pool, cell);
        brightest += pool.maximum[cell];
        if (!(power > 0)) continue;
        fire.bricks.push_back({number, static_cast<uint32_t>(cell)}), powers.push_back(power);
    }
    // Expected brightness integral of a line through the box: the mean of the bricks' maxima times the box's length.
    const double across = max_component(field.world_bounds.size());
    const double mean = brightest / static_cast<double>(pool.index.size());
    pdfs.line_scale = static_cast<float>(mean * across > 0 ? 1 / (mean * across) : 0);
}

vec3 point_in(const BrickPool& pool, uint32_t cell, vec3 v) {
    const int number = static_cast<int>(cell);
    const ivec3 brick(number / (pool.size.y * pool.size.z), number / pool.size.z % pool.size.y, number % pool.size.z);
    return vec3(pool.index_to_world * vec4(8.0f * (vec3(brick) + v), 1));
}

EmissionSample place_in(const EmissiveBricks& fire, size_t field, size_t cell, vec3 position) {
    const Medium& medium = fire.fields[field];
    const EmissiveBricks::FieldPdfs& pdfs = fire.pdfs[field];
    return {position, emission_at(medium, position), pdfs.per_volume[cell],
            pdfs.line_scale * medium.density.bricks->maximum[cell]};
}

EmissiveBricks make_emissive_bricks(std::vector<Medium> fields) {
    EmissiveBricks fire;
    fire.fields = std::move(fields);
    std::vector<double> powers;
    fire.pdfs.resize(fire.fields.size());
    for (uint32_t number = 0; number < fire.fields.size(); ++number) add_field(number, fire, powers);
    double total = 0;
    for (const double power : powers) fire.cumulative.push_back(total += power);
    for (double& sum : fire.cumulative) sum /= total;
    for (size_t i = 0; i < powers.size(); ++i) {
        const auto [number, cell] = fire.bricks[i];
        fire.pdfs[number].per_volume[cell] =
            static_cast<float>(powers[i] / (total * brick_volume(*fire.fields[number].density.bricks)));
    }
    return fire;
}
}

std::shared_ptr<const EmissiveBricks> emissive_bricks(const Snapshot& snapshot) {
    CacheKey key;
    std::vector<Medium> fields;
    for (const Medium& medium : snapshot.media) {
        const Emission& emission = medium.optics.emission;
        if (!only_emits(medium.optics) || !(luminance(emission.radiance) > 0)) continue;
        key.add(medium.density.bricks).add(emission.field).add(emission.radiance).add(emission.scale);
        fields.push_back(medium);
    }
    if (fields.empty()) return nullptr;
    auto fire = cached(snapshot, "fire", std::move(key), [&] { return make_emissive_bricks(std::move(fields)); });
    return fire->bricks.empty() ? nullptr : fire;
}

EmissionSample emission_sample_at(const EmissiveBricks& fire, size_t field, vec3 position) {
    const BrickPool& pool = *fire.fields[field].density.bricks;
    const ivec3 brick = glm::clamp(ivec3(glm::floor(local_point(pool, position) / 8.0f)), ivec3(0), pool.size - 1);
    return place_in(fire, field, static_cast<size_t>((brick.x * pool.size.y + brick.y) * pool.size.z + brick.z),
                    position);
}

EmissionSample sample_emission(const EmissiveBricks& fire, float u, vec3 v) {
    const auto found = std::ranges::upper_bound(fire.cumulative, static_cast<double>(u));
    const auto index = std::min<size_t>(static_cast<size_t>(found - fire.cumulative.begin()), fire.bricks.size() - 1);
    const auto [field, cell] = fire.bricks[index];
    return place_in(fire, field, cell, point_in(*fire.fields[field].density.bricks, cell, v));
}

namespace {
// A point uniformly distributed within one cell.
struct PickedCell {
    double distance = 0, inverse_pdf = 0;
};
PickedCell pick_cell(const BrickPool& luminance, const Ray& line, float u) {
    static thread_local std::vector<EmissionCell> cells;
    cells.clear();
    double total = 0;
    find_emission_cells(luminance, line, 0, [&](const EmissionCell& cell) {
        if (!(cell.most > 0)) return;
        cells.push_back(cell), total += cell.most * (cell.high - cell.low);
    });
    double left = u * total;
    for (const EmissionCell& cell : cells) {
        const double own = cell.most * (cell.high - cell.low);
        if (left < own || &cell == &cells.back())
            return {cell.low + std::min(left / own, 1.0) * (cell.high - cell.low), total / cell.most};
        left -= own;
    }
    return {};
}
}

EmissionOnLine emission_on_line(const EmissiveBricks& fire, size_t field, const Ray& line, float u) {
    const PickedCell picked = pick_cell(*fire.fields[field].density.bricks, line, u);
    if (!(picked.inverse_pdf > 0)) return {};
    const auto distance = static_cast<float>(picked.distance);
    return {emission_sample_at(fire, field, line.at(distance)), distance, static_cast<float>(picked.inverse_pdf)};
}
}
