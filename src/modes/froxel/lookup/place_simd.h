// Positions of 16 camera rays in the froxel grid (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_LOOKUP_PLACE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_LOOKUP_PLACE_SIMD_H
#undef TYNDALL_MODES_FROXEL_LOOKUP_PLACE_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_LOOKUP_PLACE_SIMD_H
#endif

#include "base/random.h"
#include "base/simd/reduce_simd.h"
#include "modes/froxel/lookup/lookup.h"
#include "modes/froxel/settings.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Per ray: planar depths of its ends, length per meter of planar depth (slant), and the tiles around it.
struct FroxelTaps {
    Floats start, end, slant;
    Floats tile_slant;                 // weighted mean of the tiles' slants
    Mask16 seen;                       // in front of the grid's camera
    int count = 4;                     // of tiles around a ray
    bool together = false;             // all rays lie between the same tiles
    alignas(64) int32_t tiles[16][16]; // [tile][ray]
    alignas(64) float weights[16][16]; // sum 1
    Floats kept;                       // weight of the tiles that see as far as the ray
    Ints own;                          // the tile that contains the pixel
    Floats nearest;                    // planar depth of the nearest surface it sees
};

// The slices that contain planar depths, as slice_of().
HWY_INLINE Ints slices_of(const FroxelGrid& grid, const Floats& z) {
    const Floats place = (z - grid.faces.front()) * grid.stretches_per_meter;
    const float last = static_cast<float>(grid.first_slice.size()) - 1,
                last_slice = static_cast<float>(grid.slices() - 1);
    Ints k = gather(grid.first_slice.data(), truncate(max(min(place, last), 0.0f)));
    while (true) {
        const Mask16 more = (z >= gather(grid.faces.data() + 1, k)) & (to_floats(k) < last_slice);
        if (!any(more)) return k;
        k = k + truncate(select(more, 1.0f, 0.0f));
    }
}

// The slices that contain planar depths, and their faces. Neighboring rays mostly end within a few slices.
struct SliceLanes {
    Ints slice;
    Floats before, behind;
    int least = 0, most = 0; // of the slices
};
HWY_INLINE SliceLanes slices_around(const FroxelGrid& grid, const Floats& z) {
    constexpr int few = 6;
    const int first = slice_of(grid, least(z)), last = grid.slices() - 1;
    const float* faces = grid.faces.data() + first;
    SliceLanes found{first, faces[0], faces[1], first, first};
    for (int k = 1; first + k <= last; ++k) {
        const Mask16 more = z >= faces[k];
        if (!any(more)) return found;
        if (k == few) break;
        found.slice = found.slice + truncate(select(more, 1.0f, 0.0f)), found.most = first + k;
        found.before = select(more, faces[k], found.before), found.behind = select(more, faces[k + 1], found.behind);
    }
    if (first + few > last) return found;
    const Ints slice = slices_of(grid, z);
    return {slice, gather(grid.faces.data(), slice), gather(grid.faces.data() + 1, slice), first, last};
}

// First tile and weights along one axis: 2 for linear interpolation, 4 for a cubic B-spline.
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

HWY_INLINE bool all_same(const Ints& index) {
    const Floats difference = abs(to_floats(index ^ Ints(hn::GetLane(index.part[0]))));
    return !any(difference > 0.0f);
}

// Same as gather(), but fast if all lanes have the same index.
HWY_INLINE Floats value_at(const float* values, const Ints& index) {
    return all_same(index) ? Floats(values[hn::GetLane(index.part[0])]) : gather(values, index);
}

// Reduces the weights of tiles that do not see as far as a ray; where none does, all keep their relative weights.
void fade_untrusted(const FroxelTiles& tiles, const Mask16& untrusted, FroxelTaps& taps) {
    constexpr float least = 1e-5f;
    Floats total = 0.0f, kept = 0.0f, weights[16];
    for (int t = 0; t < taps.count; ++t) {
        const Ints tile = load(taps.tiles[t]);
        const size_t first = static_cast<size_t>(taps.tiles[t][0]);
        const Floats far = taps.together ? Floats(tiles.trusted[first]) : gather(tiles.trusted.data(), tile);
        const Floats trust_falloff =
            taps.together ? Floats(tiles.trust_falloff[first]) : gather(tiles.trust_falloff.data(), tile);
        const Floats behind = max(taps.end - far, 0.0f);
        const Floats trusted = max(1.0f - behind * trust_falloff, 0.0f);
        const Floats weight = load(taps.weights[t]);
        kept = fma(weight, trusted, kept);
        weights[t] = weight * max(trusted, least);
        total = total + weights[t];
    }
    const Floats scale = 1.0f / total;
    for (int t = 0; t < taps.count; ++t)
        store(select(untrusted, weights[t] * scale, load(taps.weights[t])), taps.weights[t]);
    taps.kept = select(untrusted, kept, 1.0f);
}

// Pixels of the rays.
struct Pixels {
    Floats x, y;
};
HWY_INLINE Pixels pixels_of(const FroxelBuffer& froxels, const RayBatch& batch, const FroxelTaps& taps) {
    Pixels at;
    if (batch.rays.size() == 16 && batch.positions.size() == 16) {
        const auto* from = reinterpret_cast<const float*>(batch.positions.data());
        for (size_t i = 0; i < vectors_per_packet; ++i)
            hn::LoadInterleaved2(FloatTag(), from + 2 * i * lane_step, at.x.part[i], at.y.part[i]);
        return at;
    }
    alignas(64) float x[16], y[16], start[16], slant[16];
    store(taps.start, start), store(taps.slant, slant);
    for (size_t i = 0; i < 16; ++i) {
        const size_t ray = std::min(i, batch.rays.size() - 1);
        vec2 pixel;
        if (ray < batch.positions.size())
            pixel = batch.positions[ray];
        else
            pixel = vec2(project(froxels.grid,
                                 batch.rays[ray].at(std::max(froxels.grid.faces.back() - start[i], 1.0f) * slant[i])));
        x[i] = pixel.x, y[i] = pixel.y;
    }
    return {load(x), load(y)};
}

void jitter_taps(const RayBatch& batch, Floats& x, Floats& y) {
    alignas(64) float at_x[16], at_y[16];
    store(x, at_x), store(y, at_y);
    for (size_t i = 0; i < 16; ++i) {
        at_x[i] += (i < batch.jitter.size() ? batch.jitter[i] : 0.5f) - 0.5f;
        at_y[i] += to_unit(hash(i < batch.ids.size() ? batch.ids[i] : 0u, 0x66726fu)) - 0.5f;
    }
    x = load(at_x), y = load(at_y);
}

// Rays that end with the fog, not at a surface. The last slice spreads its fog evenly, so rays with no surface nearby
// integrate all of it.
Mask16 open_rays(const RayBatch& batch) {
    alignas(64) float open[16];
    for (size_t i = 0; i < 16; ++i) open[i] = i < batch.open.size() && batch.open[i] ? 1.0f : 0.0f;
    return load(open) > 0.0f;
}

void find_tiles(const FroxelBuffer& froxels, const RayBatch& batch, FroxelTaps& taps) {
    const FroxelGrid& grid = froxels.grid;
    const Pixels pixels = pixels_of(froxels, batch, taps);
    const float per_tile = 1 / static_cast<float>(grid.tile);
    Floats at_x = fma(pixels.x, per_tile, 0.5f), at_y = fma(pixels.y, per_tile, 0.5f); // as tile_of()
    taps.seen = taps.seen & (abs(at_x + at_y) < infinity);
    at_x = zero_unless(taps.seen, at_x), at_y = zero_unless(taps.seen, at_y);
    const auto whole = [](const Floats& at, int size)
                           HWY_ATTR { return truncate(max(min(at + 0.5f, static_cast<float>(size - 1)), 0.0f)); };
    taps.own = whole(at_y, grid.size.y) * grid.size.x + whole(at_x, grid.size.x);
    taps.nearest = value_at(froxels.tiles.nearest.data(), taps.own);
    if (froxels.lookup == FroxelLookup::jittered) jitter_taps(batch, at_x, at_y);

    const bool cubic = froxels.lookup == FroxelLookup::tricubic;
    const Axis x = axis_of(at_x, grid.size.x, cubic), y = axis_of(at_y, grid.size.y, cubic);
    const int side = cubic ? 4 : 2;
    taps.kept = 1.0f;
    taps.count = side * side, taps.tile_slant = 0.0f;
    for (int j = 0; j < side; ++j)
        for (int k = 0; k < side; ++k) {
            const Ints column = max(min(x.first + Ints(k), grid.size.x - 1), 0);
            const Ints tile = max(min(y.first + Ints(j), grid.size.y - 1), 0) * grid.size.x + column;
            store(tile, taps.tiles[side * j + k]), store(x.weights[k] * y.weights[j], taps.weights[side * j + k]);
        }
    // The minimum around the tile at or before the pixel says whether all tiles see far enough.
    const Ints cell = (y.first + Ints(cubic)) * grid.size.x + (x.first + Ints(cubic));
    taps.together = all_same(cell);
    const Floats trusted = value_at(froxels.tiles.trusted_around.data(), cell);
    const Mask16 untrusted = taps.end > trusted;
    if (any(untrusted)) fade_untrusted(froxels.tiles, untrusted, taps);
    constexpr float most = std::numeric_limits<float>::max();
    if (!batch.open.empty()) taps.end = select(open_rays(batch) & (trusted > most), most, taps.end);
    for (int t = 0; t < taps.count; ++t) {
        const Floats slant = taps.together ? Floats(grid.slants[static_cast<size_t>(taps.tiles[t][0])])
                                           : gather(grid.slants.data(), load(taps.tiles[t]));
        taps.tile_slant = fma(load(taps.weights[t]), slant, taps.tile_slant);
    }
}

// Whether all rays start exactly at the camera's position.
HWY_INLINE bool from_the_eye(const Camera& camera, const RayBatch& batch) {
    static_assert(offsetof(Ray, direction) == 3 * sizeof(float)); // four floats from `origin` on are inside the Ray
    if (camera.ortho_height > 0) return false;
    using Tag = hn::CappedTag<float, 4>;
    constexpr size_t lanes = hn::MaxLanes(Tag());
    alignas(16) const float eye[4] = {camera.position.x, camera.position.y, camera.position.z, 0};
    alignas(16) const uint32_t counts[4] = {~0u, ~0u, ~0u, 0};
    for (size_t c = 0; c < 4; c += lanes) {
        const auto here = hn::Load(Tag(), eye + c);
        auto off = hn::Zero(Tag());
        for (const Ray& ray : batch.rays) off = hn::Or(off, hn::Xor(hn::LoadU(Tag(), &ray.origin.x + c), here));
        const hn::RebindToUnsigned<Tag> bits;
        const auto counted = hn::And(hn::BitCast(bits, off), hn::Load(bits, counts + c));
        if (!hn::AllTrue(bits, hn::Eq(counted, hn::Zero(bits)))) return false;
    }
    return true;
}

inline void find_taps(const FroxelBuffer& froxels, const RayBatch& batch, FroxelTaps& taps) {
    const FroxelGrid& grid = froxels.grid;
    alignas(64) float along[16], start[16] = {}, length[16];
    if (batch.rays.size() == 16 && batch.positions.size() == 16 && from_the_eye(grid.camera, batch)) {
        const Pixels at = pixels_of(froxels, batch, taps);
        const Vec3s step = fma(splat(grid.step_x), at.x, fma(splat(grid.step_y), at.y, splat(grid.step)));
        for (size_t i = 0; i < 16; ++i) length[i] = batch.rays[i].t_max;
        taps.slant = sqrt(dot(step, step)), taps.seen = Floats(0.0f) < taps.slant, taps.start = 0.0f;
        taps.end = min(load(length) / taps.slant, std::numeric_limits<float>::max());
        return find_tiles(froxels, batch, taps);
    }
    for (size_t i = 0; i < 16; ++i) {
        const Ray& ray = batch.rays[std::min(i, batch.rays.size() - 1)];
        along[i] = glm::dot(ray.direction, grid.camera.forward);
        start[i] = std::max(planar_depth(grid.camera, ray, 0), 0.0f), length[i] = ray.t_max;
    }
    taps.seen = load(along) > 1e-6f;
    const Floats forward = select(taps.seen, load(along), 1.0f);
    taps.slant = 1.0f / forward, taps.start = load(start);
    taps.end = min(fma(load(length), forward, taps.start), std::numeric_limits<float>::max());
    find_tiles(froxels, batch, taps);
}
}
}
HWY_AFTER_NAMESPACE();
#endif
