// Where sixteen rays of the grid's camera lie among the froxels (see base/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_PLACE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_PLACE_SIMD_H
#undef TYNDALL_MODES_FROXEL_PLACE_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_PLACE_SIMD_H
#endif

#include "base/random.h"
#include "base/simd.h"
#include "modes/froxel_lookup.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Rays: planar depths of their ends, metres of ray per metre of depth, and the tiles around them.
struct Places {
    Floats start, end, slant;
    Floats tile_slant;                 // mean of the tiles' lines
    Mask16 seen;                       // by the grid's camera
    int count = 4;                     // of tiles around a ray
    alignas(64) int32_t tiles[16][16]; // [tile][ray]
    alignas(64) float weights[16][16]; // sum 1
    Floats kept;                       // weight of the tiles that see as far as the ray
    Floats nearest;                    // surface that the pixel's own tile sees
};

// The slices that hold planar depths, as slice_of().
HWY_INLINE Ints slices_of(const FroxelGrid& grid, const Floats& z) {
    const Floats place = (z - grid.faces.front()) * grid.stretches_per_metre;
    const float last = static_cast<float>(grid.first_slice.size()) - 1,
                last_slice = static_cast<float>(grid.slices() - 1);
    Ints k = gather(grid.first_slice.data(), truncate(max(min(place, last), 0.0f)));
    while (true) {
        const Mask16 more = (z >= gather(grid.faces.data() + 1, k)) & (to_floats(k) < last_slice);
        if (!any(more)) return k;
        k = k + truncate(select(more, 1.0f, 0.0f));
    }
}

// First tile and weights along one axis: 2 of a linear look-up, 4 of a cubic B-spline.
struct Axis {
    Ints first;
    Floats weights[4];
};
HWY_INLINE Axis axis_of(const Floats& place, int size, bool cubic) {
    const Floats held = max(min(place, static_cast<float>(size - 1)), 0.0f);
    const Ints cell = min(truncate(held), Ints(size - 2));
    const Floats f = held - to_floats(cell), g = 1.0f - f;
    if (!cubic) return {cell, {g, f, 0.0f, 0.0f}};
    const float sixth = 1.0f / 6;
    const Floats f2 = f * f, g2 = g * g;
    return {cell - Ints(1),
            {g2 * g * sixth, (4.0f - f2 * (2.0f - f) * 3.0f) * sixth, (4.0f - g2 * (2.0f - g) * 3.0f) * sixth,
             f2 * f * sixth}};
}

// Behind what a tile sees its sums mean nothing; only where no tile sees far enough are they taken after all.
void distrust_blind(const FroxelTiles& tiles, const Mask16& blind, Places& places) {
    constexpr float least = 1e-5f;
    Floats total = 0.0f, kept = 0.0f, weights[16];
    for (int t = 0; t < places.count; ++t) {
        const Ints tile = load(places.tiles[t]);
        const Floats behind = max(places.end - gather(tiles.trusted.data(), tile), 0.0f);
        const Floats trusted = max(1.0f - behind * gather(tiles.distrust.data(), tile), 0.0f);
        const Floats weight = load(places.weights[t]);
        kept = fused(weight, trusted, kept);
        weights[t] = weight * max(trusted, least);
        total = total + weights[t];
    }
    const Floats scale = 1.0f / total;
    for (int t = 0; t < places.count; ++t)
        store(select(blind, weights[t] * scale, load(places.weights[t])), places.weights[t]);
    places.kept = select(blind, kept, 1.0f);
}

// Pixels of the rays, in tiles.
void tile_places(const FroxelPicture& picture, const RayBatch& batch, const Places& places, float (&x)[16],
                 float (&y)[16]) {
    alignas(64) float start[16], slant[16];
    store(places.start, start), store(places.slant, slant);
    for (size_t i = 0; i < 16; ++i) {
        const size_t ray = std::min(i, batch.rays.size() - 1);
        vec2 pixel;
        if (ray < batch.positions.size())
            pixel = batch.positions[ray];
        else
            pixel = vec2(project(picture.grid,
                                 batch.rays[ray].at(std::max(picture.grid.faces.back() - start[i], 1.0f) * slant[i])));
        const vec2 at = picture.grid.tile_of(pixel);
        x[i] = at.x, y[i] = at.y;
    }
}

void find_tiles(const FroxelPicture& picture, const RayBatch& batch, Places& places) {
    const FroxelGrid& grid = picture.grid;
    alignas(64) float at_x[16], at_y[16];
    tile_places(picture, batch, places, at_x, at_y);
    const auto whole = [&](const float(&at)[16], int size)
                           HWY_ATTR { return truncate(max(min(load(at) + 0.5f, static_cast<float>(size - 1)), 0.0f)); };
    const Mask16 finite = abs(load(at_x) + load(at_y)) < infinity;
    places.seen = places.seen & finite;
    store(zero_unless(places.seen, load(at_x)), at_x), store(zero_unless(places.seen, load(at_y)), at_y);
    places.nearest =
        gather(picture.tiles.nearest.data(), whole(at_y, grid.size.y) * grid.size.x + whole(at_x, grid.size.x));
    for (size_t i = 0; i < 16 && picture.lookup == FroxelLookup::jittered; ++i) {
        at_x[i] += (i < batch.jitter.size() ? batch.jitter[i] : 0.5f) - 0.5f;
        at_y[i] += to_unit(hash(i < batch.ids.size() ? batch.ids[i] : 0u, 0x66726fu)) - 0.5f;
    }

    const bool cubic = picture.lookup == FroxelLookup::tricubic;
    const Axis x = axis_of(load(at_x), grid.size.x, cubic), y = axis_of(load(at_y), grid.size.y, cubic);
    const int side = cubic ? 4 : 2;
    places.kept = 1.0f;
    places.count = side * side, places.tile_slant = 0.0f;
    for (int j = 0; j < side; ++j)
        for (int k = 0; k < side; ++k) {
            const Ints column = max(min(x.first + Ints(k), grid.size.x - 1), 0);
            const Ints tile = max(min(y.first + Ints(j), grid.size.y - 1), 0) * grid.size.x + column;
            store(tile, places.tiles[side * j + k]), store(x.weights[k] * y.weights[j], places.weights[side * j + k]);
        }
    // The tile at or before the pixel knows whether all around it see far enough.
    const Ints cell = (y.first + Ints(cubic)) * grid.size.x + (x.first + Ints(cubic));
    const Mask16 blind = places.end > gather(picture.tiles.trusted_around.data(), cell);
    if (any(blind)) distrust_blind(picture.tiles, blind, places);
    for (int t = 0; t < places.count; ++t)
        places.tile_slant =
            fused(load(places.weights[t]), gather(grid.slants.data(), load(places.tiles[t])), places.tile_slant);
}

void find_places(const FroxelPicture& picture, const RayBatch& batch, Places& places) {
    const Camera& camera = picture.grid.camera;
    alignas(64) float along[16], start[16], length[16];
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = batch.rays[std::min(i, batch.rays.size() - 1)];
        along[i] = glm::dot(ray.direction, camera.forward);
        start[i] = std::max(planar_depth(camera, ray, 0), 0.0f), length[i] = ray.t_max;
    }
    places.seen = load(along) > 1e-6f;
    const Floats forward = select(places.seen, load(along), 1.0f);
    places.slant = 1.0f / forward, places.start = load(start);
    places.end = min(fused(load(length), forward, places.start), std::numeric_limits<float>::max());
    find_tiles(picture, batch, places);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
