#include "modes/froxel/history/froxel_history.h"

#include "base/parallel.h"

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
    const float width = froxel_width(grid, z);
    const float reach = near * std::max(width, high - low);
    return std::ranges::any_of(lights, [&](const Light& light) {
        const vec3 offset = light.position - center;
        return !is_distant(light) && glm::dot(offset, offset) < reach * reach;
    });
}

bool all_finite(const float* v) { return std::isfinite(v[0] + v[1] + v[2]); }
}

void clear_invalid(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight& light) {
    for_tiles(grid, [&](ivec2, size_t tile) {
        for (int k = 0; k < grid.slices(); ++k) {
            float* v = light.at(grid, tile, k);
            const bool known = !is_hidden(grid, tiles, tile, k) && v[3] > 0 && all_finite(v);
            for (int c = 0; c < 4 && !known; ++c) v[c] = 0;
        }
    });
}

std::vector<uint8_t> stale_froxels(const FroxelGrid& grid, const FroxelLight& remembered, std::span<const Light> lights,
                                   int frame, bool statics) {
    const ivec2 turns[] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
    const ivec2 turn = turns[frame % 4];
    const auto is_local = [](const Light& light) { return !is_distant(light); };
    const bool local = std::ranges::any_of(lights, is_local);
    const size_t slices = static_cast<size_t>(grid.slices());
    std::vector<uint8_t> stale(grid.tiles() * slices);
    for_tiles(grid, [&](ivec2 at, size_t tile) {
        if ((at.x & 1) == turn.x && (at.y & 1) == turn.y) return;
        const float* extinction = remembered.at(grid, tile, 0) + 3;
        uint8_t* column = stale.data() + tile * slices;
        if (statics && !local) return void(std::fill_n(column, slices, uint8_t{1}));
        for (size_t k = 0; k < slices; ++k)
            column[k] =
                (statics || extinction[4 * k] > 0) && !(local && is_near_light(grid, at, static_cast<int>(k), lights));
    });
    return stale;
}
}
