#include "modes/froxel_memory.h"

#include "base/parallel.h"

#include <array>

namespace tyndall {
namespace {
void for_tiles(const FroxelGrid& grid, const std::function<void(ivec2, size_t)>& body) {
    parallel_for(grid.size.y, [&](int64_t y) {
        for (int x = 0; x < grid.size.x; ++x) {
            const ivec2 at(x, static_cast<int>(y));
            body(at, grid.tile_index(at));
        }
    });
}

bool is_near_light(const FroxelGrid& grid, ivec2 at, int slice, std::span<const Light> lights) {
    constexpr float near = 4; // froxels
    const float low = grid.faces[static_cast<size_t>(slice)], high = grid.faces[static_cast<size_t>(slice) + 1];
    const float z = 0.5f * (low + high);
    const vec3 center = grid.point(grid.pixel_of(vec2(at)), z);
    const float width = static_cast<float>(grid.tile) * (glm::length(grid.origin_x) + z * glm::length(grid.step_x));
    const float reach = near * std::max(width, high - low);
    return std::ranges::any_of(lights, [&](const Light& light) {
        const vec3 offset = light.position - center;
        return light.kind != LightKind::sun && glm::dot(offset, offset) < reach * reach;
    });
}

bool all_finite(const float* v) { return std::isfinite(v[0] + v[1] + v[2]); }

// Trilinear sum of light and extinction, and how much of it is known, at a pixel and depth of the remembered frame.
std::array<float, 5> remembered_at(const FroxelMemory& memory, vec2 pixel, float z) {
    const FroxelGrid& grid = memory.grid;
    const vec2 place = grid.tile_of(pixel);
    std::array<float, 5> sum{};
    const vec2 last(grid.size - 1);
    const bool inside = place.x >= 0 && place.y >= 0 && place.x <= last.x && place.y <= last.y;
    if (!inside || !(z >= grid.faces.front() && z <= grid.faces.back())) return sum;
    const ivec2 cell = glm::min(ivec2(place), grid.size - 2);
    const vec2 f = place - vec2(cell);

    // Between the centres of two slices.
    int k = slice_of(grid, z);
    const auto center = [&](int i) {
        return 0.5f * (grid.faces[static_cast<size_t>(i)] + grid.faces[static_cast<size_t>(i) + 1]);
    };
    if (z < center(k)) --k;
    const int near = std::max(k, 0), far = std::min(k + 1, grid.slices() - 1);
    const float depth = far > near ? std::clamp((z - center(near)) / (center(far) - center(near)), 0.0f, 1.0f) : 0.0f;
    for (int corner = 0; corner < 4; ++corner) {
        const int x = corner & 1, y = corner >> 1;
        const float across = (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y);
        const size_t tile = grid.tile_index(cell + ivec2(x, y));
        const float *a = memory.light.at(grid, tile, near), *b = memory.light.at(grid, tile, far);
        for (size_t c = 0; c < 4; ++c) sum[c] += across * ((1 - depth) * a[c] + depth * b[c]);
        sum[4] += across * ((a[3] > 0 ? 1 - depth : 0) + (b[3] > 0 ? depth : 0));
    }
    return sum;
}

// Least and most light among three slices of this frame's new froxels that hold fog, and extinction among all of them;
// least > most where there are none.
struct Bounds {
    std::array<float, 4> low{infinity, infinity, infinity, infinity};
    std::array<float, 4> high{-infinity, -infinity, -infinity, -infinity};
    void add(const float* light, size_t from, size_t to) {
        for (size_t c = from; c < to; ++c) low[c] = std::min(low[c], light[c]), high[c] = std::max(high[c], light[c]);
    }
    void add(const Bounds& other) {
        for (size_t c = 0; c < 4; ++c)
            low[c] = std::min(low[c], other.low[c]), high[c] = std::max(high[c], other.high[c]);
    }
};

std::vector<Bounds> bounds_in_depth(const FroxelGrid& grid, const FroxelTiles& tiles, const uint8_t* stale,
                                    const FroxelLight& light) {
    const int slices = grid.slices();
    std::vector<Bounds> bounds(grid.tiles() * static_cast<size_t>(slices));
    for_tiles(grid, [&](ivec2, size_t tile) {
        Bounds* column = bounds.data() + tile * static_cast<size_t>(slices);
        for (int k = 0; k < slices && !is_hidden(grid, tiles, tile, k); ++k) {
            const float* here = light.at(grid, tile, k);
            const bool is_new = !stale || !stale[tile * static_cast<size_t>(slices) + static_cast<size_t>(k)];
            const size_t from = is_new && here[3] > 0 && all_finite(here) ? 0 : 3;
            for (int i = std::max(k - 1, 0); i <= std::min(k + 1, slices - 1); ++i) column[i].add(here, from, 4);
        }
    });
    return bounds;
}
}

FroxelMemory memory_of(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light) {
    FroxelMemory memory{grid, light};
    for_tiles(grid, [&](ivec2, size_t tile) {
        for (int k = 0; k < grid.slices(); ++k) {
            float* v = memory.light.at(grid, tile, k);
            const bool known = !is_hidden(grid, tiles, tile, k) && v[3] > 0 && all_finite(v);
            for (int c = 0; c < 4 && !known; ++c) v[c] = 0;
        }
    });
    return memory;
}

FroxelLight recall(const FroxelMemory& memory, const FroxelGrid& grid, const FroxelTiles& tiles) {
    constexpr float least = 0.3f; // share of the neighbours that must be known
    FroxelLight remembered;
    remembered.values.assign(4 * grid.tiles() * static_cast<size_t>(grid.slices()), 0.0f);
    for_tiles(grid, [&](ivec2 at, size_t tile) {
        const vec2 pixel = grid.pixel_of(vec2(at));
        for (int k = 0; k < grid.slices() && !is_hidden(grid, tiles, tile, k); ++k) {
            const size_t i = static_cast<size_t>(k);
            const vec3 then = project(memory.grid, grid.point(pixel, 0.5f * (grid.faces[i] + grid.faces[i + 1])));
            const std::array<float, 5> sum = remembered_at(memory, vec2(then), then.z);
            if (!(sum[4] > least) || !all_finite(sum.data())) continue;
            float* v = remembered.at(grid, tile, k);
            for (size_t c = 0; c < 4; ++c) v[c] = sum[c] / sum[4];
        }
    });
    return remembered;
}

std::vector<uint8_t> stale_froxels(const FroxelGrid& grid, const FroxelLight& remembered, std::span<const Light> lights,
                                   int frame) {
    const ivec2 turns[] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
    const ivec2 turn = turns[frame % 4];
    std::vector<uint8_t> stale(grid.tiles() * static_cast<size_t>(grid.slices()));
    for_tiles(grid, [&](ivec2 at, size_t tile) {
        const bool in_turn = (at.x & 1) == turn.x && (at.y & 1) == turn.y;
        for (int k = 0; k < grid.slices(); ++k)
            stale[tile * static_cast<size_t>(grid.slices()) + static_cast<size_t>(k)] =
                !in_turn && remembered.at(grid, tile, k)[3] > 0 && !is_near_light(grid, at, k, lights);
    });
    return stale;
}

void blend_history(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& remembered,
                   const uint8_t* stale, float weight, FroxelLight& light) {
    const std::vector<Bounds> in_depth = bounds_in_depth(grid, tiles, stale, light);
    const size_t slices = static_cast<size_t>(grid.slices());
    for_tiles(grid, [&](ivec2 at, size_t tile) {
        const ivec2 low = glm::max(at - 1, 0), high = glm::min(at + 1, grid.size - 1);
        for (int k = 0; k < grid.slices() && !is_hidden(grid, tiles, tile, k); ++k) {
            const size_t i = tile * slices + static_cast<size_t>(k);
            const float* before = remembered.at(grid, tile, k);
            if (!(before[3] > 0)) continue;
            Bounds around;
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    around.add(in_depth[grid.tile_index({x, y}) * slices + static_cast<size_t>(k)]);
            float* now = light.at(grid, tile, k);
            const bool is_stale = stale && stale[i];
            for (size_t c = 0; c < 4; ++c) {
                const bool bounded = around.low[c] <= around.high[c];
                const float kept = bounded ? std::clamp(before[c], around.low[c], around.high[c]) : before[c];
                // Extinction is new everywhere.
                now[c] = is_stale && c < 3 ? kept : now[c] + weight * (kept - now[c]);
            }
        }
    });
}
}
