#include "modes/froxel/tiles.h"

#include "base/parallel.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr int max_layers = 8;    // BLEND surfaces that a ray passes at most
constexpr float horizon = 1e12f; // meters; no ray goes farther
constexpr double opaque_depth = 12;

std::vector<vec2> ray_offsets(int tile) {
    std::vector<vec2> offsets{vec2(0)};
    if (tile == 1) return offsets;
    const int n = std::clamp(tile / 4, 2, 6);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) offsets.push_back((vec2(x, y) + 0.5f) / static_cast<float>(n) - 0.5f);
    return offsets;
}

Ray eye_ray(const FroxelGrid& grid, vec2 pixel, float& along) {
    Ray ray = line_ray(grid, pixel);
    along = glm::dot(ray.direction, grid.camera.forward);
    ray.origin = ray.at(grid.camera.near / along), ray.t_max -= grid.camera.near / along;
    return ray;
}

// Distances to the first opaque surface of up to 16 rays.
void trace_opaque(const Occluders& occluders, std::span<Ray> rays, float* distance) {
    float passed[16] = {};
    bool done[16] = {};
    std::fill_n(distance, rays.size(), infinity);
    Hits hits;
    for (int layer = 0; layer < max_layers; ++layer) {
        occluders.closest(rays, 0, hits, layer == 0);
        bool all = true;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (done[i] || (done[i] = hits.instance[i] < 0)) continue;
            const int lane = static_cast<int>(i);
            if (!occluders.has_alpha() || occluders.surface(rays[i], hits, lane).alpha >= 1) {
                distance[i] = passed[i] + hits.t[i], done[i] = true;
                continue;
            }
            const float skip = hits.t[i] + shadow_offset(rays[i].at(hits.t[i]));
            rays[i].origin = rays[i].at(skip), rays[i].t_max -= skip, passed[i] += skip;
            all = false;
        }
        if (all) return;
    }
}

void trace_row(const FroxelGrid& grid, const Occluders& occluders, int y, FroxelTiles& tiles) {
    const size_t per_tile = tiles.rays(), total = static_cast<size_t>(grid.size.x) * per_tile;
    float* row = tiles.depth.data() + static_cast<size_t>(y) * total;
    for (size_t first = 0; first < total; first += 16) {
        Ray rays[16];
        float along[16], distance[16];
        const size_t count = std::min<size_t>(16, total - first);
        for (size_t i = 0; i < count; ++i) {
            const size_t ray = first + i;
            const vec2 place = vec2(static_cast<float>(ray / per_tile), y) + tiles.offsets[ray % per_tile];
            rays[i] = eye_ray(grid, grid.pixel_of(place), along[i]);
        }
        trace_opaque(occluders, {rays, count}, distance);
        for (size_t i = 0; i < count; ++i) row[first + i] = grid.camera.near + distance[i] * along[i];
    }
}

// Distance at which unbounded fog reaches optical depth 12, or all but 1e-6 of its total.
float reach_of(const Medium& medium, Ray ray) {
    const auto depth_to = [&](float distance) {
        ray.t_max = distance;
        return optical_depth(medium, ray);
    };
    const double total = depth_to(horizon), enough = std::min(opaque_depth, total - 1e-6);
    if (!(enough > 0)) return 0;
    float high = std::min(1 / medium.majorant(), horizon);
    while (high < horizon && depth_to(high) < enough) high *= 2;
    while (depth_to(0.5f * high) >= enough) high *= 0.5f;
    float low = 0.5f * high;
    for (int step = 0; step < 3; ++step) {
        const float middle = 0.5f * (low + high);
        (depth_to(middle) < enough ? low : high) = middle;
    }
    return std::min(high, horizon);
}

float scene_depth(const FroxelGrid& grid, const Snapshot& snapshot) {
    const Box& bounds = snapshot.bounds;
    const float depth = bounds.empty() ? 0 : planar_depths(grid.camera, bounds).high;
    return depth > 0 ? depth : bounds.empty() ? snapshot.extent : glm::length(bounds.size());
}

void add_ray(const FroxelGrid& grid, const Snapshot& snapshot, vec2 pixel, float surface, float scene,
             FogDepths& depths) {
    const Ray ray = line_ray(grid, pixel);
    const float along = glm::dot(ray.direction, grid.camera.forward);
    const float end = std::min(ray.t_max, surface / along);
    for (const Medium& medium : snapshot.media) {
        const Interval<float> inside = clip(medium.world_bounds, ray.origin, ray.direction, {0, end});
        if (inside.empty()) continue;
        depths.near = std::min(depths.near, inside.low * along);
        float out = inside.high * along;
        if (std::isinf(out)) {
            out = reach_of(medium, ray) * along;
            depths.end = std::max(depths.end, out);
            out = std::min(out, scene);
        }
        depths.far = std::max(depths.far, out);
    }
}
}

FroxelTiles make_froxel_tiles(const FroxelGrid& grid, const Snapshot& snapshot) {
    FroxelTiles tiles;
    tiles.offsets = ray_offsets(grid.tile);
    const size_t rays = tiles.rays();
    tiles.depth.assign(grid.tiles() * rays, infinity);
    if (snapshot.occluders && !snapshot.occluders->empty())
        parallel_for(grid.size.y, [&](int64_t y) { trace_row(grid, *snapshot.occluders, static_cast<int>(y), tiles); });
    tiles.nearest.resize(grid.tiles()), tiles.farthest.resize(grid.tiles()), tiles.deepest.resize(grid.tiles());
    parallel_ranges(static_cast<int64_t>(grid.tiles()), 1024, [&](int64_t begin, int64_t end) {
        for (size_t tile = static_cast<size_t>(begin); tile < static_cast<size_t>(end); ++tile) {
            const float* first = tiles.depth.data() + tile * rays;
            const auto [low, high] = std::minmax_element(first, first + rays);
            tiles.nearest[tile] = *low, tiles.farthest[tile] = *high;
            tiles.deepest[tile] = static_cast<int32_t>(high - first);
        }
    });
    return tiles;
}

void set_trust(const FroxelGrid& grid, FroxelTiles& tiles) {
    tiles.trusted.resize(grid.tiles()), tiles.trust_falloff.resize(grid.tiles());
    tiles.trusted_around.assign(grid.tiles(), infinity);
    for (size_t tile = 0; tile < grid.tiles(); ++tile) {
        const float far = tiles.farthest[tile];
        const size_t k = static_cast<size_t>(slice_of(grid, far));
        const float slack = std::max(grid.thickness(k), far - tiles.nearest[tile]);
        tiles.trusted[tile] = far + 0.5f * slack;
        tiles.trust_falloff[tile] = std::isinf(far) ? 0.0f : 1 / slack;
    }
    parallel_for(grid.size.y, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < grid.size.x; ++x)
            for (int i = 0; i < 16; ++i) {
                const ivec2 other = glm::clamp(ivec2(x + i % 4 - 1, y + i / 4 - 1), ivec2(0), grid.size - 1);
                float& least = tiles.trusted_around[grid.tile_index({x, y})];
                least = std::min(least, tiles.trusted[grid.tile_index(other)]);
            }
    });
}

FogDepths fog_depths(const FroxelGrid& grid, const FroxelTiles& tiles, const Snapshot& snapshot) {
    const float scene = scene_depth(grid, snapshot);
    std::vector<FogDepths> rows(static_cast<size_t>(grid.size.y));
    parallel_for(grid.size.y, [&](int64_t y) {
        for (int x = 0; x < grid.size.x; ++x)
            for (size_t ray = 0; ray < tiles.rays(); ++ray) {
                const vec2 pixel = grid.pixel_of(vec2(x, y) + tiles.offsets[ray]);
                const size_t tile = grid.tile_index({x, y});
                add_ray(grid, snapshot, pixel, tiles.depth[tile * tiles.rays() + ray], scene,
                        rows[static_cast<size_t>(y)]);
            }
    });
    FogDepths all;
    for (const FogDepths& row : rows) {
        all.near = std::min(all.near, row.near);
        all.far = std::max(all.far, row.far), all.end = std::max(all.end, row.end);
    }
    return all;
}
}
