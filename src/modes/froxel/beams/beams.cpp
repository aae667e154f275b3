#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/beams/beams.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/beams/beams.h"

#include "base/parallel.h"
#include "base/simd/simd.h"
#include "modes/froxel/beams/beam_shadows.h"
#include "modes/froxel/fill/fill.h"
#include "modes/froxel/settings.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Slices of up to 16 tiles of a row whose froxels lie in a spot's cone or near another lamp, or within `margin` froxel
// widths of that.
void find_reaches(const FroxelGrid& grid, const Light& light, float radius, float margin, ivec2 first,
                  FroxelBeams::Reach (&reaches)[16]) {
    alignas(64) float x[16], inside[16];
    for (int i = 0; i < 16; ++i) x[i] = grid.pixel_of(vec2(first + ivec2(i, 0))).x, reaches[i] = {};
    const float y = grid.pixel_of(vec2(first)).y;
    const Vec3s step = fma(splat(grid.step_x), load(x), splat(grid.step + y * grid.step_y));
    const Vec3s start = fma(splat(grid.origin_x), load(x), splat(grid.origin + y * grid.origin_y - light.position));
    const Floats slant = sqrt(dot(step, step));
    const float cosine = std::cos(light.outer_cone), sine = std::sin(light.outer_cone);
    for (int k = 0; k < grid.slices(); ++k) {
        const float low = grid.faces[static_cast<size_t>(k)], high = grid.faces[static_cast<size_t>(k) + 1];
        const float width = froxel_width(grid, high);
        // Tested from the midpoint of the froxel's line: no point of the line is farther away than half its length.
        const Vec3s offset = fma(step, 0.5f * (low + high), start);
        const Floats near = fma(slant, 0.5f * (high - low), margin * width);
        const Floats squared = dot(offset, offset), along = dot(offset, splat(light.direction));
        const Floats across = sqrt(max(squared - along * along, 0.0f));
        Mask16 reached = sqrt(squared) <= near + std::min(light.range, radius);
        if (has_cone(light)) reached = reached & (across * cosine - along * sine <= near) & (along >= -near);
        if (!any(reached)) continue;
        store(select(reached, 1.0f, 0.0f), inside);
        for (size_t i = 0; i < 16; ++i) {
            if (!(inside[i] > 0)) continue;
            if (reaches[i].end == 0) reaches[i].first = k;
            reaches[i].end = k + 1;
        }
    }
}

void reaches_kernel(const FroxelScene& scene, const FroxelGrid& grid, FroxelBeams& beams) {
    // Look-ups use froxels up to one tile away, wider ones two; diagonally, that is √2 times as far.
    const float margin = scene.settings.lookup == FroxelLookup::trilinear ? 1.5f : 3.0f;
    const size_t count = beams.lights.size();
    parallel_for(grid.size.y, [&](int64_t row) {
        FroxelBeams::Reach found[16];
        for (int x = 0; x < grid.size.x; x += 16)
            for (size_t beam = 0; beam < count; ++beam) {
                const ivec2 first(x, static_cast<int>(row));
                find_reaches(grid, scene.snapshot.lights[beams.lights[beam]], scene.near(beams.lights[beam]).radius,
                             margin, first, found);
                for (int i = 0; i < std::min(16, grid.size.x - x); ++i)
                    beams.reaches[grid.tile_index(first + ivec2(i, 0)) * count + beam] = found[i];
            }
    });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
bool lamp_views_fit(const Snapshot& snapshot) {
    return has_room_for_views(snapshot, [](const Light& light) { return is_distant(light) ? 0 : lamp_points(light); });
}

bool has_exact_shadows(const Light& light, const Snapshot& snapshot, const FroxelSettings& settings, bool views_fit) {
    if (!shadow_casters(light, snapshot) || settings.visibility == FroxelVisibility::off) return true;
    return settings.visibility == FroxelVisibility::intervals && views_fit;
}

namespace {
bool is_grid(const Medium& medium) { return medium.density.kind == DensityKind::bricks; }
bool has_alpha(const FroxelScene& scene, size_t index) {
    const auto& casters = shadow_casters(scene.snapshot.lights[index], scene.snapshot);
    return casters && casters->has_alpha();
}
bool is_closed(const FroxelScene& scene) { return std::ranges::none_of(scene.snapshot.media, is_grid); }
}

NearLight near_light(const FroxelScene& scene, const FroxelGrid& grid, size_t index) {
    const Light& light = scene.snapshot.lights[index];
    if (is_distant(light)) return {};
    if (has_cone(light) || scene.has_exact_shadows(light)) return {infinity};
    return near_to(grid, light);
}

NearLight near_to(const FroxelGrid& grid, const Light& light) {
    constexpr float widths = 14, slices = 20, heights = 1.4f;
    const float z = glm::dot(light.position - grid.camera.position, grid.camera.forward);
    if (!(z > 0)) return {0};
    const auto slice = static_cast<size_t>(slice_of(grid, z));
    return {std::max(
        {widths * froxel_width(grid, z), slices * grid.thickness(slice), heights * view_height(grid.camera, z)})};
}

float light_depth_scale(const LightDepth& depth) {
    return depth.method == LightTransmittance::off || depth.method == LightTransmittance::average ? 0 : depth.scale;
}

namespace {
FroxelBeams::LampFog fog_at_lamp(const FroxelScene& scene, const FroxelGrid& grid, size_t index) {
    constexpr float froxels = 4;
    const Light& light = scene.snapshot.lights[index];
    float extinction = 0;
    for (const Medium& medium : scene.snapshot.media)
        if (is_grid(medium)) extinction += density_at(medium, light.position) * gray_extinction(medium.optics);
    const float z = std::max(glm::dot(light.position - grid.camera.position, grid.camera.forward), grid.faces.front());
    const float width = froxel_width(grid, z);
    return {extinction * light_depth_scale(scene.depths[index]), froxels * width};
}
}

namespace {
// Steps of two thirds of the size of the finest detail of the fog at that depth, at most four to a slice.
void cut_slices(const FroxelGrid& grid, std::span<const Medium> media, FroxelBeams& beams) {
    constexpr float per_detail = 1.5f, most = 4;
    std::vector<float> steps(static_cast<size_t>(grid.slices()), 1.0f);
    for (const Medium& medium : media) {
        if (!is_grid(medium)) continue;
        const float step = fog_detail({&medium, 1}) / per_detail;
        const Interval<float> depths = planar_depths(grid.camera, medium.world_bounds);
        for (size_t k = 0; k < steps.size(); ++k)
            if (grid.faces[k] < depths.high && grid.faces[k + 1] > depths.low)
                steps[k] = std::max(steps[k], std::min(std::ceil(grid.thickness(k) / step), most));
    }
    for (size_t k = 0; k < steps.size(); ++k) {
        beams.first_step.push_back(static_cast<int32_t>(beams.step_faces.size()));
        for (float i = 0; i < steps[k]; ++i)
            beams.step_faces.push_back(grid.faces[k] + grid.thickness(k) * (i / steps[k]));
    }
    beams.first_step.push_back(static_cast<int32_t>(beams.step_faces.size()));
    beams.step_faces.push_back(grid.faces.back());
}
}

HWY_EXPORT(reaches_kernel);
FroxelBeams make_froxel_beams(const FroxelScene& scene, const FroxelGrid& grid) {
    FroxelBeams beams;
    beams.lights = scene.beams;
    if (beams.lights.empty()) return beams;
    beams.lobe = lobe_cuts(scene.snapshot.media);
    for (const size_t index : beams.lights) {
        beams.fog.push_back(fog_at_lamp(scene, grid, index));
        beams.grids.push_back(scene.depths[index]), beams.grids.back().analytic.clear();
        beams.exact_shadows.push_back(scene.has_exact_shadows(scene.snapshot.lights[index]) &&
                                      !has_alpha(scene, index));
        beams.by_rays_alone.push_back(is_closed(scene) && beams.exact_shadows.back());
    }
    beams.reaches.resize(grid.tiles() * beams.lights.size());
    HWY_DYNAMIC_DISPATCH(reaches_kernel)(scene, grid, beams);
    cut_slices(grid, scene.snapshot.media, beams);
    size_t index = 0;
    for (FroxelBeams::Reach& reach : beams.reaches)
        reach.index = std::exchange(index, index + static_cast<size_t>(reach.end - reach.first));
    beams.shares.resize(index);
    const size_t media = scene.snapshot.media.size();
    beams.media = media > 1 && !is_closed(scene) ? media : 0;
    beams.extinctions.resize(grid.tiles() * beams.media * static_cast<size_t>(grid.slices()));
    return beams;
}
}
#endif
