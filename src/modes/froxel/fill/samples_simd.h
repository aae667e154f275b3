// Sample points of 16 froxels, and the fog there (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_FILL_SAMPLES_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_FILL_SAMPLES_SIMD_H
#undef TYNDALL_MODES_FROXEL_FILL_SAMPLES_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_FILL_SAMPLES_SIMD_H
#endif

#include "base/random.h"
#include "modes/froxel/fill/fill.h"
#include "modes/froxel/fill/light_simd.h"
#include "modes/froxel/settings.h"
#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
struct Fill {
    const FroxelScene& scene;
    const FroxelGrid& grid;
    const FroxelTiles& tiles;
    const FillPass& pass;
    FroxelLight& light;

    bool exact() const { return scene.settings.visibility == FroxelVisibility::intervals; }
    bool wants(size_t part) const {
        return !scene.is_beam(part) && (pass.only < 0 || static_cast<size_t>(pass.only) == part);
    }
    // Whether soft lights are sampled at different points. A single sample uses the center: noise would not be
    // averaged.
    bool spreads() const { return scene.settings.shadow_rays > 1 || pass.frame > 0; }
    int samples() const { return scene.settings.shadow_rays; }
};

// 4×4 tiles. Lanes beyond the grid's edge are not there.
struct Lanes {
    ivec2 at[16];
    size_t tile[16];
    bool in_grid[16];
    alignas(64) float farthest[16]; // farthest surface of the tile's rays; -infinity where not there
    int last = 0;                   // one past the last slice that any lane sees
};

// The rays that a sample tries first: pixels, and depths of the surfaces they hit.
struct FirstRays {
    size_t ray;
    alignas(64) float x[16], y[16], depth[16];
};

// Sample points of the lanes: on a ray of the tile that still sees this slice, and at a depth.
struct FroxelSamples {
    alignas(64) float x[16], y[16], z[16], active[16], lit[16], low[16], high[16];
    alignas(64) float first[16]; // 1 where that ray is first_ray()
};

// Index in a sequence that spreads over 4×4 neighboring tiles, samples and frames; users scramble it by slice and
// purpose.
uint32_t spread_index(const Fill& fill, ivec2 at, int sample) {
    const auto cell = static_cast<uint32_t>((at.y & 3) * 4 + (at.x & 3));
    const auto samples = static_cast<uint32_t>(fill.samples());
    return (static_cast<uint32_t>(fill.pass.frame) * 16 + cell) * samples + static_cast<uint32_t>(sample);
}

// Radical inverse of base 2, from ½ on: ½, ¼, ¾, …
float halton(int index) { return to_unit(reverse_bits(static_cast<uint32_t>(index) + 1)); }

// The ray of every tile that a sample uses unless it is blocked.
size_t first_ray(const Fill& fill, int sample) {
    return static_cast<size_t>(fill.pass.frame + sample) % fill.tiles.rays();
}

FirstRays first_rays(const Fill& fill, const Lanes& lanes, int sample) {
    FirstRays first;
    first.ray = first_ray(fill, sample);
    for (size_t i = 0; i < 16; ++i) {
        const vec2 pixel = fill.grid.pixel_of(vec2(lanes.at[i]) + fill.tiles.offsets[first.ray]);
        first.x[i] = pixel.x, first.y[i] = pixel.y;
        first.depth[i] = lanes.in_grid[i] ? fill.tiles.depth[lanes.tile[i] * fill.tiles.rays() + first.ray] : -infinity;
    }
    return first;
}

// Marks the lanes that have to be relit.
void set_lit(const Fill& fill, const Lanes& lanes, int slice, FroxelSamples& points) {
    if (!fill.pass.stale) return store(Floats(1.0f), points.lit);
    const size_t slices = static_cast<size_t>(fill.grid.slices()), k = static_cast<size_t>(slice);
    for (size_t i = 0; i < 16; ++i) points.lit[i] = fill.pass.stale[lanes.tile[i] * slices + k] ? 0.0f : 1.0f;
}

// Sample of one lane: on the first ray, in turn, that is not blocked at its depth; else on the deepest, in front of its
// surface.
void lane_sample(const Fill& fill, const Lanes& lanes, int slice, int sample, size_t i, FroxelSamples& points) {
    const FroxelTiles& tiles = fill.tiles;
    const size_t rays = tiles.rays(), k = static_cast<size_t>(slice), first = first_ray(fill, sample);
    const float near = fill.grid.faces[k], far = fill.grid.faces[k + 1];
    const int samples = fill.samples();
    float u = fill.exact() ? 0.5f : halton(fill.pass.frame);
    if (samples > 1 && !fill.exact()) {
        const uint32_t index = spread_index(fill, lanes.at[i], sample);
        u = (static_cast<float>(sample) + to_unit(hash(index, k))) / static_cast<float>(samples);
    }
    const float* depth = tiles.depth.data() + lanes.tile[i] * rays;
    float z = near + u * (far - near);
    size_t ray = static_cast<size_t>(tiles.deepest[lanes.tile[i]]);
    if (depth[ray] <= z) z = 0.5f * (near + depth[ray]);
    for (size_t j = 0; j < rays && ray != first; ++j)
        if (const size_t next = (first + j) % rays; depth[next] > z) {
            ray = next;
            break;
        }
    const vec2 pixel = fill.grid.pixel_of(vec2(lanes.at[i]) + tiles.offsets[ray]);
    points.x[i] = pixel.x, points.y[i] = pixel.y, points.z[i] = z;
    points.high[i] = std::min(far, depth[ray]);
}

FroxelSamples froxel_samples(const Fill& fill, const Lanes& lanes, const FirstRays& first, int slice, int sample) {
    const float near = fill.grid.faces[static_cast<size_t>(slice)];
    const float far = fill.grid.faces[static_cast<size_t>(slice) + 1];
    FroxelSamples points;
    const Mask16 active = load(lanes.farthest) > near;
    const Floats depth = load(first.depth), middle = 0.5f * (near + far);
    const Mask16 seen = active & (depth > near);
    store(select(active, 1.0f, 0.0f), points.active), store(Floats(near), points.low);
    store(select(seen, 1.0f, 0.0f), points.first), store(min(Floats(far), depth), points.high);
    store(load(first.x), points.x), store(load(first.y), points.y);
    store(select(seen & (depth <= middle), (near + depth) * 0.5f, middle), points.z);
    set_lit(fill, lanes, slice, points);
    if (fill.exact() && !any(active & !seen)) return points;
    for (size_t i = 0; i < 16; ++i)
        if (points.active[i] > 0 && !(fill.exact() && points.first[i] > 0))
            lane_sample(fill, lanes, slice, sample, i, points);
    return points;
}

// Lines of the lanes: origin + z·step at planar depth z.
struct Lines {
    Vec3s origin, step;
};
HWY_INLINE Lines lines_of(const FroxelGrid& grid, const FroxelSamples& points) {
    const Floats x = load(points.x), y = load(points.y);
    return {fma(splat(grid.origin_x), x, fma(splat(grid.origin_y), y, splat(grid.origin))),
            fma(splat(grid.step_x), x, fma(splat(grid.step_y), y, splat(grid.step)))};
}

FroxelLanes froxel_lanes(const FroxelGrid& grid, const FroxelSamples& points) {
    const Lines lines = lines_of(grid, points);
    const Floats slant = sqrt(dot(lines.step, lines.step)), z = load(points.z), low = load(points.low);
    FroxelLanes lanes;
    lanes.point = fma(lines.step, z, lines.origin), lanes.step = lines.step, lanes.z = z;
    lanes.start = fma(lines.step, low, lines.origin);
    lanes.toward = lines.step * (1.0f / slant);
    lanes.length = slant * max(load(points.high) - low, 0.0f);
    lanes.active = load(points.active) > 0.0f;
    const float wide = glm::length(grid.origin_x), wider = glm::length(grid.step_x);
    const Floats side = fma(z, wider, wide) * static_cast<float>(grid.tile);
    lanes.width2 = side * side * (1 / pi);
    return lanes;
}

// Whether some medium is a sheet, its box thinner than the slice.
bool holds_sheet(const Fill& fill, int slice) {
    const size_t k = static_cast<size_t>(slice);
    const float thickness = fill.grid.thickness(k);
    return std::ranges::any_of(fill.scene.snapshot.media, [&](const Medium& medium) {
        const vec3 sides = medium.world_bounds.size();
        return std::min(sides.x, std::min(sides.y, sides.z)) < thickness;
    });
}

// Shortens the lanes' segments to the fog on them, averaged over media by their extinction.
FroxelLanes in_fog(const std::vector<Medium>& media, const FroxelLanes& lanes, const float (*extinction)[16]) {
    Floats low = 0.0f, high = 0.0f, total = 0.0f;
    for (size_t m = 0; m < media.size(); ++m) {
        const Interval<Floats> part = inside_box(media[m], {lanes.start, lanes.toward, lanes.length});
        const Floats weight = zero_unless(part.high > part.low, load(extinction[m]));
        low = fma(weight, part.low, low), high = fma(weight, part.high, high), total = total + weight;
    }
    const Mask16 some = total > 0.0f;
    const Floats inverse = 1.0f / select(some, total, 1.0f);
    low = select(some, low * inverse, 0.0f), high = select(some, high * inverse, lanes.length);
    FroxelLanes cut = lanes;
    cut.start = fma(lanes.toward, low, lanes.start), cut.length = high - low;
    const Floats middle = (low + high) * 0.5f;
    cut.point = fma(lanes.toward, middle, lanes.start);
    cut.z = lanes.z + dot(cut.point - lanes.point, lanes.toward) / sqrt(dot(lanes.step, lanes.step));
    return cut;
}

// Mean extinction along the segments: exact for closed forms, up to four samples for bricks.
Floats mean_extinction(const Medium& medium, const FroxelLanes& lanes, float thickness) {
    if (medium.density.kind != DensityKind::bricks) {
        const Segments16 paths{lanes.start, lanes.toward, lanes.length};
        return zero_unless(lanes.active, analytic_depth16(medium, paths) / max(lanes.length, 1e-20f));
    }
    const float voxels = thickness * glm::length(vec3(medium.density.bricks->world_to_index[0]));
    const int count = static_cast<int>(std::clamp(std::ceil(0.5f * voxels), 1.0f, 4.0f));
    if (count == 1) return zero_unless(lanes.active, density16(medium, lanes.point) * gray_extinction(medium.optics));
    Floats sum = 0.0f;
    for (int i = 0; i < count; ++i) {
        const Floats at = lanes.length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
        sum = sum + density16(medium, fma(lanes.toward, at, lanes.start));
    }
    return zero_unless(lanes.active, sum * (gray_extinction(medium.optics) / static_cast<float>(count)));
}
}
}
HWY_AFTER_NAMESPACE();
#endif
