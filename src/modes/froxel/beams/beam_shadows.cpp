#include "modes/froxel/beams/beam_shadows.h"

namespace tyndall {
namespace {
// The tile of the view that the rays lie in, or -1: then all faces are looked at.
int tile_of(const ShadowView& view, std::span<const vec2> positions, float margin) {
    if (positions.empty() || view.tiles.x == 0) return -1;
    vec2 middle(0);
    for (const vec2 p : positions) middle += p / static_cast<float>(positions.size());
    const ivec2 tile = glm::clamp(ivec2(glm::floor(middle / float(shadow_tile_side))), ivec2(0), view.tiles - 1);
    for (const vec2 p : positions) {
        const vec2 low = vec2(tile * shadow_tile_side) - margin, high = vec2((tile + 1) * shadow_tile_side) + margin;
        if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) return -1;
    }
    return tile.y * view.tiles.x + tile.x;
}
}

void find_beam_lit(const ShadowView& view, const RayBatch& batch, float margin, const float (&low)[16],
                   const float (&high)[16], LitIntervals& lit) {
    static thread_local std::vector<ShadowCrossing> crossings;
    static thread_local std::vector<Interval<double>> stretches[16];
    ShadowViewRays rays;
    Interval<double> ranges[16];
    rays.edges = false, rays.tile = tile_of(view, batch.positions, margin);
    for (size_t i = 0; i < 16; ++i) stretches[i].clear();
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        if (!(low[i] < high[i])) continue;
        ranges[i] = {low[i], high[i]};
        place_ray(view, {batch.rays[i].origin, batch.rays[i].direction, std::nextafter(high[i], infinity)},
                  static_cast<int>(i), rays);
    }
    crossings.clear();
    find_crossings(view, rays, crossings);
    int dark[16];
    std::fill(dark, dark + 16, view.dark);
    append_lit(dark, crossings, ranges, stretches);

    size_t most = 0;
    for (const auto& of_ray : stretches) most = std::max(most, of_ray.size());
    lit.rows.resize(most);
    for (size_t k = 0; k < most; ++k)
        for (size_t i = 0; i < 16; ++i) {
            const bool some = k < stretches[i].size() && low[i] < high[i];
            lit.rows[k].low[i] = some ? static_cast<float>(stretches[i][k].low) : 0;
            lit.rows[k].high[i] = some ? static_cast<float>(stretches[i][k].high) : 0;
        }
}
}
