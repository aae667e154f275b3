// Where sixteen froxels are looked at, and the fog there (see base/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_LOOK_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_LOOK_SIMD_H
#undef TYNDALL_MODES_FROXEL_LOOK_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_LOOK_SIMD_H
#endif

#include "base/random.h"
#include "modes/froxel_fill.h"
#include "modes/froxel_light_simd.h"
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

    bool exact() const { return scene.settings.visibility == FroxelVisibility::slices; }
    bool wants(size_t part) const { return pass.only < 0 || static_cast<size_t>(pass.only) == part; }
    // One look at a soft light is at its centre: other points would be noise that nothing averages.
    bool spreads() const { return scene.settings.shadow_rays > 1 || pass.frame > 0; }
    int samples() const { return scene.settings.shadow_rays; }
};

// 4×4 tiles of one slice. Lanes beyond the grid's edge are not there.
struct Lanes {
    ivec2 at[16];
    size_t tile[16];
    bool there[16];
};

// Where the lanes look: a ray of the tile that still sees this slice, and a depth.
struct Looks {
    alignas(64) float x[16], y[16], z[16], active[16], lit[16], low[16], high[16];
    int ray[16];
};

// Numbers that spread over 4×4 neighbouring tiles, samples and frames; other ones for each slice and use.
uint32_t spread_index(const Fill& fill, ivec2 at, int sample) {
    const auto cell = static_cast<uint32_t>((at.y & 3) * 4 + (at.x & 3));
    const auto samples = static_cast<uint32_t>(fill.samples());
    return (static_cast<uint32_t>(fill.pass.frame) * 16 + cell) * samples + static_cast<uint32_t>(sample);
}

// Radical inverse of base 2, from ½ on: ½, ¼, ¾, …
float halton(int index) { return to_unit(reverse_bits(static_cast<uint32_t>(index) + 1)); }

// The ray of every tile that a sample looks along, where it is not stopped.
size_t first_ray(const Fill& fill, int sample) {
    return static_cast<size_t>(fill.pass.frame + sample) % fill.tiles.rays();
}

Looks look(const Fill& fill, const Lanes& lanes, int slice, int sample) {
    const FroxelTiles& tiles = fill.tiles;
    const size_t rays = tiles.rays(), k = static_cast<size_t>(slice);
    const float near = fill.grid.faces[k], far = fill.grid.faces[k + 1];
    const int samples = fill.samples(), frame = fill.pass.frame;
    Looks looks{};
    for (size_t i = 0; i < 16; ++i) {
        looks.low[i] = near, looks.high[i] = far, looks.z[i] = 0.5f * (near + far);
        if (!lanes.there[i] || is_hidden(fill.grid, tiles, lanes.tile[i], slice)) continue;
        float u = fill.exact() ? 0.5f : halton(frame);
        const size_t first = first_ray(fill, sample);
        if (samples > 1 && !fill.exact()) {
            const uint32_t index = spread_index(fill, lanes.at[i], sample);
            u = (static_cast<float>(sample) + to_unit(hash(index, k))) / static_cast<float>(samples);
        }
        // The first ray in turn that is not yet stopped at that depth; or the deepest, just before it is.
        const float* depth = tiles.depth.data() + lanes.tile[i] * rays;
        float z = near + u * (far - near);
        size_t ray = static_cast<size_t>(tiles.deepest[lanes.tile[i]]);
        if (fill.exact() && depth[first] > near) ray = first;
        if (depth[ray] <= z) z = 0.5f * (near + depth[ray]);
        for (size_t j = 0; j < rays && ray != first; ++j)
            if (const size_t next = (first + j) % rays; depth[next] > z) {
                ray = next;
                break;
            }
        const vec2 pixel = fill.grid.pixel_of(vec2(lanes.at[i]) + tiles.offsets[ray]);
        looks.x[i] = pixel.x, looks.y[i] = pixel.y, looks.z[i] = z, looks.ray[i] = static_cast<int>(ray);
        looks.high[i] = std::min(far, depth[ray]);
        const size_t froxel = lanes.tile[i] * static_cast<size_t>(fill.grid.slices()) + k;
        looks.active[i] = 1, looks.lit[i] = fill.pass.stale && fill.pass.stale[froxel] ? 0.0f : 1.0f;
    }
    return looks;
}

// Points of the lanes' lines at planar depths.
struct Lines {
    Vec3s origin, step;
};
HWY_INLINE Lines lines_of(const FroxelGrid& grid, const Looks& looks) {
    const Floats x = load(looks.x), y = load(looks.y);
    return {fused(splat(grid.origin_x), x, fused(splat(grid.origin_y), y, splat(grid.origin))),
            fused(splat(grid.step_x), x, fused(splat(grid.step_y), y, splat(grid.step)))};
}

FroxelLanes froxel_lanes(const FroxelGrid& grid, const Looks& looks) {
    const Lines lines = lines_of(grid, looks);
    const Floats slant = sqrt(dot(lines.step, lines.step)), z = load(looks.z), low = load(looks.low);
    FroxelLanes lanes;
    lanes.point = fused(lines.step, z, lines.origin);
    lanes.start = fused(lines.step, low, lines.origin);
    lanes.toward = lines.step * (1.0f / slant);
    lanes.length = slant * max(load(looks.high) - low, 0.0f);
    lanes.active = load(looks.active) > 0.0f;
    const float wide = glm::length(grid.origin_x), wider = glm::length(grid.step_x);
    const Floats side = fused(z, wider, wide) * static_cast<float>(grid.tile);
    lanes.width2 = side * side * (1 / pi);
    return lanes;
}

// Mean extinction along the stretches: exact for formulas, up to four samples for bricks.
Floats mean_extinction(const Medium& medium, const FroxelLanes& lanes, float thickness) {
    if (medium.kind != DensityKind::bricks) {
        const LightPaths paths{lanes.start, lanes.toward, lanes.length};
        return zero_unless(lanes.active, analytic_depth16(medium, paths) / max(lanes.length, 1e-20f));
    }
    const float voxels = thickness * glm::length(vec3(medium.bricks->world_to_index[0]));
    const int count = static_cast<int>(std::clamp(std::ceil(0.5f * voxels), 1.0f, 4.0f));
    if (count == 1) return zero_unless(lanes.active, density16(medium, lanes.point) * medium.optics.extinction);
    Floats sum = 0.0f;
    for (int i = 0; i < count; ++i) {
        const Floats at = lanes.length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
        sum = sum + density16(medium, fused(lanes.toward, at, lanes.start));
    }
    return zero_unless(lanes.active, sum * (medium.optics.extinction / static_cast<float>(count)));
}
}
}
HWY_AFTER_NAMESPACE();
#endif
