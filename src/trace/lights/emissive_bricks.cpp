#include "trace/lights/emissive_bricks.h"

#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/half.h"
#include "volume/rays/emission_nodes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <limits>

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

// Layers of height fog that resolve its falloff, where memory allows; homogeneous fog has one.
int layers_of(const Density& density, float height) {
    constexpr float by_falloff = 2, most = 4096;
    if (density.kind != DensityKind::height) return 1;
    return static_cast<int>(std::clamp(std::ceil(by_falloff * height / density.height_falloff), 1.0f, most));
}

// Cells of fog without bricks: layers along y, each with the density in its middle.
std::shared_ptr<const BrickPool> cells_of(const Medium& medium, const Box& box) {
    const int layers = layers_of(medium.density, box.size().y);
    BrickPool pool;
    pool.size = {1, layers, 1};
    const vec3 voxel = box.size() / vec3(8 * pool.size);
    pool.local_bounds = {vec3(0), vec3(8 * pool.size)};
    Medium whole = medium; // also beside a rotated box, so that no cell is darker than the fog in it
    whole.density.bounds = everywhere();
    std::vector<int32_t> index;
    std::vector<float> densities;
    for (int y = 0; y < layers; ++y) {
        const vec3 middle = box.low + voxel * vec3(4, 8 * y + 4, 4);
        densities.push_back(std::max(density_at(whole, middle), std::numeric_limits<float>::min()));
        index.push_back(-y - 1);
    }
    pool.index = std::move(index), pool.constants = densities;
    pool.minimum = densities, pool.maximum = std::move(densities);
    place(pool, glm::scale(glm::translate(dmat4(1), dvec3(box.low)), dvec3(voxel)));
    return std::make_shared<const BrickPool>(std::move(pool));
}

// The bounds of fog, those of unbounded fog cut off where light from there to the scene is lost. In height fog, light
// comes from further away above the base, where there is less fog.
Box sampled_bounds(const Medium& medium, const Snapshot& snapshot) {
    if (is_finite(medium.world_bounds.size())) return medium.world_bounds;
    const bool is_height = medium.density.kind == DensityKind::height;
    const float depth = is_height ? 30.0f : 10.0f; // optical, at the highest density
    const float reach = std::min(snapshot.extent + depth / gray_extinction(medium.optics), 1e9f);
    const Box scene = snapshot.bounds.empty() ? Box{snapshot.anchor, snapshot.anchor} : snapshot.bounds;
    Box near{scene.low - reach, scene.high + reach};
    if (is_height) near.high.y = std::min(near.high.y, medium.density.height_base + 16 * medium.density.height_falloff);
    return {glm::max(medium.world_bounds.low, near.low), glm::min(medium.world_bounds.high, near.high)};
}

void add_field(uint32_t number, EmissiveBricks& fire, std::vector<double>& powers) {
    const Medium& field = fire.fields[number];
    EmissiveBricks::FieldSampling& sampling = fire.sampling[number];
    const BrickPool& pool = *sampling.bricks;
    sampling.per_volume.assign(pool.index.size(), 0);
    const double brightness = luminance(field.optics.emission.radiance) * brick_volume(pool);
    double brightest = 0;
    for (size_t cell = 0; cell < pool.index.size(); ++cell) {
        const double power = brightness * mean_in_brick(pool, cell);
        brightest += pool.maximum[cell];
        if (!(power > 0)) continue;
        fire.bricks.push_back({number, static_cast<uint32_t>(cell)}), powers.push_back(power);
    }
    // Expected brightness integral of a line through the box: the mean of the bricks' maxima times the box's length.
    const double across = max_component(pool.bounds.size());
    const double mean = brightest / static_cast<double>(pool.index.size());
    sampling.line_scale = static_cast<float>(mean * across > 0 ? 1 / (mean * across) : 0);
}

vec3 point_in(const BrickPool& pool, uint32_t cell, vec3 v) {
    const int number = static_cast<int>(cell);
    const ivec3 brick(number / (pool.size.y * pool.size.z), number / pool.size.z % pool.size.y, number % pool.size.z);
    return vec3(pool.index_to_world * vec4(8.0f * (vec3(brick) + v), 1));
}

EmissionSample place_in(const EmissiveBricks& fire, size_t field, size_t cell, vec3 position) {
    const Medium& medium = fire.fields[field];
    const EmissiveBricks::FieldSampling& sampling = fire.sampling[field];
    return {position, emission_at(medium, position), sampling.per_volume[cell],
            sampling.line_scale * sampling.bricks->maximum[cell]};
}

EmissiveBricks make_emissive_bricks(std::vector<Medium> fields, const Snapshot& snapshot) {
    EmissiveBricks fire;
    fire.fields = std::move(fields);
    std::vector<double> powers;
    for (const Medium& field : fire.fields)
        fire.sampling.push_back({field.density.kind == DensityKind::bricks
                                     ? field.density.bricks
                                     : cells_of(field, sampled_bounds(field, snapshot)),
                                 {},
                                 0});
    for (uint32_t number = 0; number < fire.fields.size(); ++number) add_field(number, fire, powers);
    double total = 0;
    for (const double power : powers) fire.cumulative.push_back(total += power);
    for (double& sum : fire.cumulative) sum /= total;
    for (size_t i = 0; i < powers.size(); ++i) {
        const auto [number, cell] = fire.bricks[i];
        EmissiveBricks::FieldSampling& sampling = fire.sampling[number];
        sampling.per_volume[cell] = static_cast<float>(powers[i] / (total * brick_volume(*sampling.bricks)));
    }
    return fire;
}
}

bool emits_as_lamps(const Medium& medium) {
    constexpr float thin = 1; // optical depth from the middle to the edge
    const float across = max_component(medium.world_bounds.size());
    const float density = medium.density.kind == DensityKind::bricks ? medium.density.bricks->mean_in_bricks : 1;
    return only_emits(medium.optics) || 0.5f * across * density * gray_extinction(medium.optics) < thin;
}

std::shared_ptr<const EmissiveBricks> emissive_bricks(const Snapshot& snapshot, Emitting which) {
    CacheKey key;
    std::vector<Medium> fields;
    for (const Medium& medium : snapshot.media) {
        const Emission& emission = medium.optics.emission;
        const bool counts = which == Emitting::all || only_emits(medium.optics) ||
                            (which == Emitting::as_lamps && emits_as_lamps(medium));
        if (!counts || !(luminance(emission.radiance) > 0)) continue;
        const Density& density = medium.density;
        key.add(density.bricks).add(emission.field).add(emission.radiance).add(emission.scale);
        if (!density.bricks) {
            key.add(sampled_bounds(medium, snapshot)).add(density.bounds);
            for (glm::length_t column = 0; column < 4; ++column) key.add(density.world_to_local[column]);
            key.add(density.kind).add(density.height_base).add(density.height_falloff);
        }
        fields.push_back(medium);
    }
    if (fields.empty()) return nullptr;
    auto fire =
        cached(snapshot, "fire", std::move(key), [&] { return make_emissive_bricks(std::move(fields), snapshot); });
    return fire->bricks.empty() ? nullptr : fire;
}

EmissionSample emission_sample_at(const EmissiveBricks& fire, size_t field, vec3 position) {
    const BrickPool& pool = *fire.sampling[field].bricks;
    const ivec3 brick = glm::clamp(ivec3(glm::floor(local_point(pool, position) / 8.0f)), ivec3(0), pool.size - 1);
    return place_in(fire, field, static_cast<size_t>((brick.x * pool.size.y + brick.y) * pool.size.z + brick.z),
                    position);
}

EmissionSample sample_emission(const EmissiveBricks& fire, float u, vec3 v) {
    const auto found = std::ranges::upper_bound(fire.cumulative, static_cast<double>(u));
    const auto index = std::min<size_t>(static_cast<size_t>(found - fire.cumulative.begin()), fire.bricks.size() - 1);
    const auto [field, cell] = fire.bricks[index];
    return place_in(fire, field, cell, point_in(*fire.sampling[field].bricks, cell, v));
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
    const PickedCell picked = pick_cell(*fire.sampling[field].bricks, line, u);
    if (!(picked.inverse_pdf > 0)) return {};
    const auto distance = static_cast<float>(picked.distance);
    return {emission_sample_at(fire, field, line.at(distance)), distance, static_cast<float>(picked.inverse_pdf)};
}
}
