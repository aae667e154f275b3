// Optical depth toward a light: which media have closed forms, which go into a grid, which are marched.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/transmittance/light_depth.cpp"
#include <hwy/foreach_target.h>

#include "base/random.h"
#include "trace/transmittance/light_froxels.h"
#include "trace/transmittance/light_grid.h"

#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth_simd.h"
#include "trace/view.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void light_depths_kernel(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                         float* optical_depth) {
    const Mask16 wanted = to_floats(load(active)) < 0.0f;
    store(light_depth16(depth, {load(x), load(y), load(z)}, wanted), optical_depth);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(light_depths_kernel);

namespace {
// Mean depth over the fog's bounds, by Roberts' R3 sequence (steps of 1/φ, 1/φ², 1/φ³ with φ⁴ = φ + 1). Unbounded fog
// is limited to the scene's bounds.
float mean_depth(const LightDepth& depth, const Snapshot& snapshot) {
    constexpr uint32_t packets = 256;
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    if (fog.empty()) return 0;
    const Box scene = snapshot.bounds.empty() ? Box{vec3(-1), vec3(1)} : snapshot.bounds;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::isinf(fog.low[axis])) fog.low[axis] = std::min(scene.low[axis], fog.high[axis]);
        if (std::isinf(fog.high[axis])) fog.high[axis] = std::max(scene.high[axis], fog.low[axis]);
    }
    double sum = 0;
    for (uint32_t packet = 0; packet < packets; ++packet) {
        alignas(64) float v[3][16], result[16];
        alignas(64) int32_t active[16];
        for (uint32_t lane = 0; lane < 16; ++lane) {
            const uint32_t i = packet * 16 + lane;
            const vec3 u(to_unit(i * 3518319155u), to_unit(i * 2882110345u), to_unit(i * 2360945575u));
            const vec3 point = fog.low + u * fog.size();
            v[0][lane] = point.x, v[1][lane] = point.y, v[2][lane] = point.z;
            active[lane] = -1;
        }
        light_depths(depth, v[0], v[1], v[2], active, result);
        for (const float value : result) sum += value;
    }
    return static_cast<float>(sum / (packets * 16));
}

// Key of what the brick media's optical depth toward a light depends on, apart from where it is evaluated.
CacheKey depth_key(std::span<const Medium* const> bricks, const Light& light, int resolution) {
    CacheKey key;
    key.add(light).add(resolution);
    for (const Medium* medium : bricks) key.add(medium->density.bricks).add(gray_extinction(medium->optics));
    return key;
}

// Bounds of the fog that may scatter light, as far as it is within the scene's.
Box scattering_bounds(const Snapshot& snapshot) {
    Box fog;
    for (const Medium& medium : snapshot.media)
        if (!only_emits(medium.optics)) fog.grow(medium.world_bounds);
    return {glm::max(fog.low, snapshot.bounds.low), glm::min(fog.high, snapshot.bounds.high)};
}

LightDepthFroxels cached_froxels(const Snapshot& snapshot, std::span<const Medium* const> bricks, const Light& light,
                                 int resolution, const View& view) {
    CacheKey key = depth_key(bricks, light, resolution);
    const Box fog = scattering_bounds(snapshot);
    return *cached(snapshot, "light froxels", std::move(key.add(view).add(fog)), [&] {
        LightDepthFroxels froxels = fitted_froxels(view, fog, resolution);
        if (froxels.size.x > 0) fill_froxels(bricks, light, froxels);
        return froxels;
    });
}

LightDepthGrid cached_grid(const Snapshot& snapshot, std::span<const Medium* const> bricks, const Light& light,
                           int resolution) {
    return *cached(snapshot, "light grid", depth_key(bricks, light, resolution), [&] {
        LightDepthGrid grid = fitted_grid(bricks, light, resolution);
        if (grid.size.x > 0) fill_grid(bricks, grid);
        return grid;
    });
}
}

LightDepth make_light_depth(const Snapshot& snapshot, const Light& light, LightTransmittance method, int resolution,
                            const View* view, bool filled) {
    if (method == LightTransmittance::froxel && (!view || view->camera.lens)) method = LightTransmittance::grid;
    LightDepth depth;
    depth.method = method;
    depth.light = light;
    if (method == LightTransmittance::off) return depth;
    std::vector<const Medium*> bricks;
    for (const Medium& medium : snapshot.media)
        if (medium.density.kind != DensityKind::bricks)
            depth.analytic.push_back(medium);
        else if (!only_emits(medium.optics))
            bricks.push_back(&medium);
    if (method == LightTransmittance::froxel && !bricks.empty())
        depth.froxels = cached_froxels(snapshot, bricks, light, resolution, *view);
    if (method == LightTransmittance::marched || method == LightTransmittance::froxel) {
        for (const Medium* medium : bricks) depth.marched.push_back(*medium);
        return depth;
    }
    if (filled || method != LightTransmittance::grid || snapshot.files)
        depth.grid = cached_grid(snapshot, bricks, light, resolution);
    else
        depth.grid = fitted_grid(bricks, light, resolution);
    if (method == LightTransmittance::average) {
        depth.method = LightTransmittance::grid;
        const float mean = mean_depth(depth, snapshot);
        depth.method = method;
        depth.average = mean;
        depth.grid = {};
    }
    return depth;
}

void light_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                  float* optical_depth) {
    HWY_DYNAMIC_DISPATCH(light_depths_kernel)(depth, x, y, z, active, optical_depth);
}

void marched_depths(const LightDepth& depth, const float* x, const float* y, const float* z, const int32_t* active,
                    float* result) {
    for (int lane = 0; lane < 16; ++lane) {
        result[lane] = 0;
        if (!active[lane]) continue;
        Ray ray{{x[lane], y[lane], z[lane]}, -depth.light.direction};
        if (!is_distant(depth.light)) {
            const vec3 towards = depth.light.position - ray.origin;
            const float distance = glm::length(towards);
            if (!(distance > depth.light.radius)) continue;
            ray.direction = towards / distance, ray.t_max = distance - depth.light.radius;
        }
        double sum = 0;
        for (const Medium& medium : depth.marched) sum += optical_depth(medium, ray);
        result[lane] = static_cast<float>(sum);
    }
}
}
#endif
