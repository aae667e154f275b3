#include "trace/fluence/fluence.h"

#include "base/parallel.h"
#include "base/random.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_profile.h"
#include "trace/fluence/light_paths.h"
#include "trace/fluence/settings.h"
#include "trace/fluence/smoothing.h"
#include "trace/fluence/walls.h"
#include "trace/frame_cache.h"
#include "trace/lights/environment.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int64_t block_paths = 512; // traced by one thread at a time
constexpr int64_t round_blocks = 64; // traced before their segments are put into the grid
constexpr int slab_cells = 4;        // along x, filled by one thread at a time
constexpr int64_t pilot_share = 8;   // the pilot traces 1 / pilot_share as many paths, to find where light matters
constexpr int64_t fewest_hits = 8;   // pilot hits per stratum, on average; coarser strata below that
constexpr int max_side = 32;         // strata along each side of a light's square, in the pilot
constexpr double evenly = 0.2;       // fraction of the paths that the pilot does not redistribute

// Cells aligned to world-space multiples of their size: the grid stays fixed while the fog's bounds change slightly.
FluenceGrid grid_over(const Box& fog, int resolution) {
    FluenceGrid grid;
    const float longest = max_component(fog.size());
    if (!(longest > 0) || !std::isfinite(longest)) return grid;
    grid.cell = longest / static_cast<float>(resolution);
    const vec3 low = glm::floor(fog.low / grid.cell + 1e-3f), high = glm::ceil(fog.high / grid.cell - 1e-3f);
    grid.size = glm::max(ivec3(high - low), ivec3(1));
    grid.bounds = {grid.cell * low, grid.cell * (low + vec3(grid.size))};
    grid.values.resize(12 * static_cast<size_t>(grid.size.x) * static_cast<size_t>(grid.size.y) *
                       static_cast<size_t>(grid.size.z));
    return grid;
}

// Adds the lengths of a segment in the cells of a slab (Amanatides & Woo 1987).
void add_segment(const PathSegment& segment, int first, int last, FluenceGrid& grid, FluenceOctants& octants) {
    const float scale = 1 / grid.cell;
    const float start = (segment.from.x - grid.bounds.low.x) * scale,
                end_x = start + segment.length * segment.direction.x * scale;
    if (std::max(start, end_x) < static_cast<float>(first) || std::min(start, end_x) > static_cast<float>(last)) return;
    const vec3 from = (segment.from - grid.bounds.low) * scale, step = segment.direction * scale;
    const Box slab{vec3(first, 0, 0), vec3(last, grid.size.y, grid.size.z)};
    const Interval<float> inside = clip(slab, from, step, {0, segment.length});
    if (inside.empty()) return;

    const float brightness = luminance(segment.light);
    float values[12];
    for (int c = 0; c < 3; ++c) values[c] = segment.light[c];
    for (int axis = 0; axis < 3; ++axis)
        for (int c = 0; c < 3; ++c) values[3 + 3 * axis + c] = segment.light[c] * segment.direction[axis];

    const ivec3 lowest(first, 0, 0), highest(last - 1, grid.size.y - 1, grid.size.z - 1);
    ivec3 cell = glm::clamp(ivec3(glm::floor(from + inside.low * step)), lowest, highest);
    vec3 next, across;
    for (int axis = 0; axis < 3; ++axis) {
        const float border = static_cast<float>(cell[axis] + (step[axis] > 0 ? 1 : 0));
        next[axis] = step[axis] == 0 ? infinity : (border - from[axis]) / step[axis];
        across[axis] = step[axis] == 0 ? infinity : 1 / std::abs(step[axis]);
    }
    for (float t = inside.low;;) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const float end = std::min(next[axis], inside.high), length = std::max(end - t, 0.0f);
        const size_t index = cell_index(grid, cell);
        float* to = grid.values.data() + 12 * index;
        for (int i = 0; i < 12; ++i) to[i] += length * values[i];
        if (!octants.empty()) {
            const vec3 place = from + (t + 0.5f * length) * step, within = place - vec3(cell);
            const int octant = (within.x > 0.5f ? 4 : 0) + (within.y > 0.5f ? 2 : 0) + (within.z > 0.5f ? 1 : 0);
            octants[8 * index + static_cast<size_t>(octant)] += length * brightness * vec4(place, 1);
        }
        if (!(next[axis] < inside.high)) return;
        t = end, next[axis] += across[axis];
        cell[axis] += step[axis] > 0 ? 1 : -1;
        if (cell[axis] < lowest[axis] || cell[axis] > highest[axis]) return;
    }
}

// Every slab adds the segments in the same order. `octants` is empty if it is not needed.
void add_segments(const std::vector<LightPathResult>& blocks, FluenceGrid& grid, FluenceOctants& octants) {
    parallel_for((grid.size.x + slab_cells - 1) / slab_cells, [&](int64_t slab) {
        const int first = static_cast<int>(slab) * slab_cells, last = std::min(first + slab_cells, grid.size.x);
        for (const LightPathResult& block : blocks)
            for (const PathSegment& segment : block.segments) add_segment(segment, first, last, grid, octants);
    });
}

// Traces every other path, starting at `first`, into the grid.
void add_half(const Snapshot& snapshot, const RayStrata& strata, const LightPathRules& rules, int64_t paths, int first,
              FluenceGrid& grid, FluenceOctants& octants) {
    const int64_t half = (paths + 1 - first) / 2;
    std::vector<LightPathResult> blocks(static_cast<size_t>(round_blocks));
    for (int64_t round = 0; round < half; round += round_blocks * block_paths) {
        parallel_for(round_blocks, [&](int64_t b) {
            LightPathResult& result = blocks[static_cast<size_t>(b)];
            result.segments.clear();
            const int64_t done = round + b * block_paths, count = std::min(block_paths, half - done);
            if (count > 0) trace_light_paths(snapshot, strata, rules, first + 2 * done, count, paths, result, 2);
        });
        add_segments(blocks, grid, octants);
    }
}

// Contributions of the pilot's paths, by stratum.
struct Pilot {
    int side = 0;
    std::vector<double> squares; // Σ (power · length)²
    int64_t hits = 0;            // paths that contributed anything

    // Merges each 2×2 strata into one.
    void coarsen() {
        const size_t count = squares.size() / static_cast<size_t>(side * side);
        const int half = side / 2;
        std::vector<double> merged(count * static_cast<size_t>(half * half));
        for (size_t i = 0; i < squares.size(); ++i) {
            const int stratum = static_cast<int>(i % static_cast<size_t>(side * side));
            const size_t square = i / static_cast<size_t>(side * side);
            merged[square * static_cast<size_t>(half * half) +
                   static_cast<size_t>(stratum / side / 2 * half + stratum % side / 2)] += squares[i];
        }
        squares = std::move(merged), side = half;
    }
};

Pilot fly_pilot(const Snapshot& snapshot, LightPathRules rules, int64_t paths) {
    const RayStrata strata = even_strata(snapshot, rules.reach, max_side);
    Pilot pilot{max_side, std::vector<double>(strata.cumulative.size(), 0.0)};
    std::vector<LightPathResult> results(static_cast<size_t>((paths + block_paths - 1) / block_paths));
    rules.seed = hash(rules.seed, 1u);
    parallel_for(static_cast<int64_t>(results.size()), [&](int64_t b) {
        LightPathResult& result = results[static_cast<size_t>(b)];
        result.of_stratum.resize(pilot.squares.size());
        trace_light_paths(snapshot, strata, rules, b * block_paths, std::min(block_paths, paths - b * block_paths),
                          paths, result);
        result.segments = {};
    });
    for (const LightPathResult& result : results) {
        pilot.hits += result.hits;
        for (size_t i = 0; i < pilot.squares.size(); ++i) pilot.squares[i] += result.of_stratum[i];
    }
    return pilot;
}

// Stratum probabilities proportional to the root mean square of their paths' contributions (Neyman 1934), with strata
// large enough for reliable estimates.
RayStrata strata_by_pilot(const Snapshot& snapshot, const LightPathRules& rules, int64_t paths) {
    Pilot pilot = fly_pilot(snapshot, rules, std::max<int64_t>(paths / pilot_share, 1));
    while (pilot.side > 1 && pilot.hits < fewest_hits * static_cast<int64_t>(pilot.squares.size())) pilot.coarsen();
    RayStrata strata = even_strata(snapshot, rules.reach, pilot.side);
    const std::vector<double> even = strata.cumulative;
    const auto chance = [&](size_t i) { return even[i] - (i > 0 ? even[i - 1] : 0.0); };
    double sum = 0, together = 0;
    for (size_t i = 0; i < even.size(); ++i) sum += std::sqrt(chance(i) * pilot.squares[i]);
    if (!(sum > 0)) return strata;
    for (size_t i = 0; i < even.size(); ++i) {
        const double wanted = std::sqrt(chance(i) * pilot.squares[i]) / sum;
        strata.cumulative[i] = together += evenly * chance(i) + (1 - evenly) * wanted;
    }
    return strata;
}

// Adds the surfaces that a light illuminates, and those that shadow it.
void add_links(int casters, int lit, const Snapshot& snapshot, CacheKey& key) {
    key.add(lit), key.add(casters);
    if (casters >= 0) key.add(snapshot.casters[static_cast<size_t>(casters)].occluders);
    if (lit < 0) return;
    for (const bool instance : snapshot.lit[static_cast<size_t>(lit)]) key.add(instance);
}

// Adds how a light's intensity depends on direction, and its face's radiance on position.
void add_filter(const Light& light, CacheKey& key) {
    if (light.area && light.area->texture)
        for (const char c : light.area->texture->content) key.add(c);
    if (!light.filter) return;
    const LightFilter& filter = *light.filter;
    const std::string contents = (filter.profile ? filter.profile->content : std::string()) + " " +
                                 (filter.gobo ? filter.gobo->content : std::string());
    for (const char c : contents) key.add(c);
    for (const LightAxes& axes : {filter.profile_axes, filter.gobo_axes}) key.add(axes.right).add(axes.up);
    key.add(filter.gobo_half);
}

void add_phase(const Phase& phase, CacheKey& key) {
    key.add(phase.kind).add(phase.g);
    if (!phase.shape) return;
    for (const PhaseLobe& lobe : phase.shape->lobes) key.add(lobe.weight).add(lobe.g).add(lobe.alpha);
    for (const float value : phase.shape->table.values) key.add(value);
}

void add_environment(const Environment& environment, const Snapshot& snapshot, CacheKey& key) {
    const BackgroundState& map = environment.map;
    key.add(map.kind).add(map.color).add(map.zenith).add(map.ground).add(map.image).add(map.intensity);
    key.add(map.rotation).add(environment.scale).add(environment.volume_scale).add(environment.surface_scale);
    key.add(environment.shadows), add_links(environment.casters, environment.lit, snapshot, key);
}

CacheKey fluence_key(const Snapshot& snapshot, const FluenceSettings& settings, uint32_t seed) {
    CacheKey key;
    key.add(seed);
    key.add(snapshot.occluders).add(snapshot.bounds);
    key.add(settings.orders).add(settings.resolution).add(settings.paths);
    for (const Light& light : snapshot.lights) {
        add_links(light.casters, light.lit, snapshot,
                  key.add(light).add(light.intensity).add(light.volume_scale).add(light.surface_scale));
        add_filter(light, key);
    }
    if (snapshot.environment) add_environment(*snapshot.environment, snapshot, key);
    for (const Medium& medium : snapshot.media) {
        const Optics& optics = medium.optics;
        key.add(medium.density.kind).add(gray_extinction(optics)).add(optics.albedo);
        add_phase(optics.phase, key);
        key.add(medium.density.bounds)
            .add(medium.world_bounds)
            .add(medium.density.height_base)
            .add(medium.density.height_falloff);
        for (int column = 0; column < 4; ++column) key.add(medium.density.world_to_local[column]);
        key.add(medium.density.bricks);
        if (optics.albedo_field) key.add(optics.albedo_field).add(optics.base_albedo);
    }
    return key;
}
}

FluenceGrid make_fluence(const Snapshot& snapshot, const FluenceSettings& settings, uint32_t seed) {
    LightPathRules rules;
    rules.reach = light_reach(snapshot);
    FluenceGrid grid = grid_over(fog_bounds(snapshot, rules.reach), settings.resolution);
    if (grid.empty() || !has_lights(snapshot)) return {};
    rules.reach.grow(grid.bounds); // fills cells at the border like all others
    rules.recorded = grid.bounds, rules.orders = settings.orders, rules.seed = seed;
    const bool surfaces = snapshot.occluders && !snapshot.occluders->empty();
    FluenceOctants octants(surfaces ? grid.values.size() / 12 * 8 : 0, vec4(0));
    const RayStrata strata = strata_by_pilot(snapshot, rules, settings.paths);

    // Two interleaved halves of the paths: their difference measures the noise.
    add_half(snapshot, strata, rules, settings.paths, 0, grid, octants);
    std::vector<float> difference(grid.values.size(), 0.0f);
    std::swap(difference, grid.values);
    add_half(snapshot, strata, rules, settings.paths, 1, grid, octants);
    const float volume = grid.cell * grid.cell * grid.cell;
    for (size_t i = 0; i < difference.size(); ++i) {
        const float one = difference[i] / volume, other = grid.values[i] / volume;
        grid.values[i] = one + other, difference[i] = one - other;
    }
    if (surfaces) find_walls(*snapshot.occluders, octants, grid, difference);
    smooth(std::move(difference), grid);
    return grid;
}

std::shared_ptr<const FluenceGrid> cached_fluence(const Snapshot& snapshot, const FluenceSettings& settings,
                                                  uint32_t seed) {
    if (settings.orders < 2 || snapshot.media.empty() || !has_lights(snapshot)) return nullptr;
    const std::shared_ptr<const FluenceGrid> grid = cached(snapshot, "fluence", fluence_key(snapshot, settings, seed),
                                                           [&] { return make_fluence(snapshot, settings, seed); });
    return grid->empty() ? nullptr : grid;
}
}
