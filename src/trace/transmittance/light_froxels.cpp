// The optical depth to a light at the corners of froxels, sixteen corners at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/transmittance/light_froxels.cpp"
#include <hwy/foreach_target.h>

#include "base/parallel.h"
#include "trace/transmittance/light_froxels.h"

#include "trace/transmittance/light_depth_simd.h"
#include "trace/view.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr float voxels_per_sample = 1.5f;

// Optical depth of one medium along the paths, by the midpoint rule inside its bricks' box.
Floats depth_along(const Medium& medium, const Segments16& paths) {
    if (medium.density.bricks->empty()) return 0.0f;
    const Box& box = medium.density.bricks->bounds;
    Interval<Floats> range{0.0f, paths.length};
    clip_axis(paths.origin.x, paths.direction.x, box.low.x, box.high.x, range);
    clip_axis(paths.origin.y, paths.direction.y, box.low.y, box.high.y, range);
    clip_axis(paths.origin.z, paths.direction.z, box.low.z, box.high.z, range);
    const Floats length = max(range.high - range.low, 0.0f);
    alignas(64) float lengths[16];
    store(length, lengths);
    const float longest = *std::max_element(lengths, lengths + 16);
    if (!(longest > 0)) return 0.0f;
    const vec3 voxel = medium.density.bricks->voxel_size;
    const float finest = std::min(voxel.x, std::min(voxel.y, voxel.z));
    const int samples = std::max(1, static_cast<int>(std::ceil(longest / (voxels_per_sample * finest))));
    const Floats step = length * (1 / static_cast<float>(samples));
    Floats sum = 0.0f;
    for (int i = 0; i < samples; ++i) {
        const Floats at = fma(step, static_cast<float>(i) + 0.5f, range.low);
        sum = sum + density16(medium, fma(paths.direction, at, paths.origin));
    }
    return zero_unless(length > 0.0f, sum * step * gray_extinction(medium.optics));
}

void fill_corners(std::span<const Medium* const> media, const Light& light, int64_t row,
                  const LightDepthFroxels& froxels, float* depths) {
    const Camera& camera = froxels.camera;
    const float z = froxels.planar_depth(static_cast<int>(row / froxels.size.y));
    const float spread = camera.ortho_height > 0 ? 1 : z;
    const float up = (static_cast<float>(row % froxels.size.y) - froxels.offset.y) / froxels.scale.y * spread;
    float* depth = depths + row * froxels.size.x;
    for (int first = 0; first < froxels.size.x; first += 16) {
        alignas(64) float column[16], found[16];
        for (int i = 0; i < 16; ++i) column[i] = static_cast<float>(std::min(first + i, froxels.size.x - 1));
        const Floats right = (load(column) - froxels.offset.x) * (spread / froxels.scale.x);
        const vec3 middle = camera.position + z * camera.forward + up * camera.up;
        const Segments16 paths = light_segments(light, fma(splat(camera.right), right, splat(middle)));
        Floats sum = 0.0f;
        for (const Medium* medium : media) sum = sum + depth_along(*medium, paths);
        store(sum, found);
        std::copy_n(found, std::min(16, froxels.size.x - first), depth + first);
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_corners);

namespace {
constexpr float max_growth = 8; // thickness of the last slice over that of the first

// Planar depths between which the view's rays cross the bounds.
Interval<float> seen_depths(const View& view, const Box& bounds) {
    constexpr int rays = 32; // from edge to edge
    Interval<float> seen{infinity, 0};
    for (int y = 0; y <= rays; ++y)
        for (int x = 0; x <= rays; ++x) {
            const Ray ray = camera_ray(view.camera, view.size, vec2(x, y) / float(rays) * vec2(view.size));
            const Interval<float> inside = clip(bounds, ray.origin, ray.direction, {0, ray.t_max});
            if (inside.empty()) continue;
            seen.low = std::min(seen.low, planar_depth(view.camera, ray, inside.low));
            seen.high = std::max(seen.high, planar_depth(view.camera, ray, inside.high));
        }
    return seen;
}
}

LightDepthFroxels fitted_froxels(const View& view, const Box& bounds, int resolution) {
    LightDepthFroxels froxels;
    const Interval<float> seen = seen_depths(view, bounds);
    if (!(seen.high > seen.low)) return froxels;
    const Camera& camera = froxels.camera = view.camera;
    froxels.near = seen.low, froxels.far = seen.high;
    const bool ortho = camera.ortho_height > 0;
    const float growth = ortho ? 1 : std::clamp(seen.high / std::max(seen.low, 1e-6f * seen.high), 1.0f, max_growth);
    froxels.first = 2 / (1 + growth);

    // Square cells, `resolution` along the longer side, and one more beyond each edge.
    const vec2 image(view.size);
    const float pixels = std::max(image.x, image.y) / static_cast<float>(resolution);
    const ivec2 cells = glm::max(ivec2(glm::ceil(image / pixels - 1e-3f)), ivec2(1));
    froxels.scale = vec2(image.y / (pixels * view_height(camera)));
    froxels.offset = 0.5f * vec2(cells) + 1.0f;
    froxels.size = ivec3(cells + 3, resolution + 1);
    return froxels;
}

void fill_froxels(std::span<const Medium* const> media, const Light& light, LightDepthFroxels& froxels) {
    std::vector<float> depths(static_cast<size_t>(froxels.size.x) * froxels.size.y * froxels.size.z, 0.0f);
    parallel_for(int64_t{froxels.size.y} * froxels.size.z, [&](int64_t row) {
        HWY_DYNAMIC_DISPATCH(fill_corners)(media, light, row, froxels, depths.data());
    });
    froxels.depth = std::make_shared<const std::vector<float>>(std::move(depths));
}
}
#endif
