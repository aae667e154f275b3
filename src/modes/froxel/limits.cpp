// What a froxel cache cannot show of a scene, in words.
#include "modes/limits.h"
#include "modes/froxel/grid.h"
#include "modes/settings.h"
#include "modes/techniques.h"
#include "scene/light.h"
#include "scene/moving_nodes.h"
#include "trace/occlusion/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
std::string metres(float value) { return number_text("%.2g m", static_cast<double>(value)); }

// Size of a froxel in the middle of the scene: across, and in depth.
struct FroxelSize {
    float across = 0, deep = 0;
};
FroxelSize middle_froxel(const View& view, const Snapshot& snapshot, const FroxelSettings& settings) {
    const FroxelGrid grid = make_froxel_grid(view.camera, view.size, settings.tile);
    const Box& box = snapshot.bounds;
    const float depth = std::max(glm::dot(box.center() - view.camera.position, view.camera.forward), view.camera.near);
    const float pixel = glm::length(grid.origin_x) + depth * glm::length(grid.step_x);
    const float extent = box.empty() ? depth : depth + 0.5f * glm::length(box.size());
    return {pixel * static_cast<float>(settings.tile), extent / static_cast<float>(settings.depth_slices)};
}

bool in_fog(const Snapshot& snapshot, vec3 point) {
    return std::ranges::any_of(snapshot.media, [&](const Medium& medium) { return density_at(medium, point) > 0; });
}

// Whether the scene gives a light keys for where it is or shines to.
bool is_moving(const Snapshot& snapshot, const Light& light) {
    const auto moves = [&](const LightSource& source) {
        return source.name == light.name &&
               (!source.position.constant() || !source.direction.constant() || is_moving(*snapshot.scene, source.node));
    };
    return snapshot.scene && std::ranges::any_of(snapshot.scene->lights, moves);
}

// Whether it gives the camera keys for where it is.
bool is_moving(const Snapshot& snapshot, const Camera& camera) {
    const auto moves = [&](const CameraSource& source) {
        return source.name == camera.name && (!source.position.constant() || is_moving(*snapshot.scene, source.node));
    };
    return snapshot.scene && std::ranges::any_of(snapshot.scene->cameras, moves);
}
}

std::vector<Limit> froxel_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Settings terms = settings; // what the march says of light that scatters once holds here too
    terms.march.visibility = Visibility::rays;
    std::vector<Limit> limits = march_limits(view, snapshot, terms);
    if (snapshot.media.empty()) return limits;

    const FroxelSettings& froxel = settings.froxel;
    const FroxelSize size = middle_froxel(view, snapshot, froxel);
    const float coarse = std::max(size.across, size.deep);
    const bool fine = froxel.tile == 1 && froxel.depth_slices >= 256;
    const bool shadows = snapshot.occluders && !snapshot.occluders->empty();
    if (is_moving(snapshot, view.camera))
        limits.push_back({Severity::degraded, view.camera.name.empty() ? "camera" : "camera " + view.camera.name,
                          "moves: with --history shafts close to it are blurred by a third of a froxel"});
    for (const Light& light : snapshot.lights) {
        const std::string where = "light " + light.name;
        if (froxel.visibility == FroxelVisibility::off && light.shadows)
            limits.push_back({Severity::wrong, where, "froxel.visibility is off: no shafts"});
        else if (light.shadows && shadows)
            limits.push_back({fine ? Severity::info : Severity::degraded, where,
                              "shafts are as coarse as froxels, here about " + metres(size.across) + " wide and " +
                                  metres(size.deep) + " deep; walls and gaps thinner than that leak or vanish"});
        if (light.shadows && shadows && is_soft(light) && froxel.shadow_rays == 1)
            limits.push_back({Severity::degraded, where,
                              "seen from one point in a frame without a history: its soft shadows have hard edges in "
                              "the fog (froxel.shadow_rays)"});
        if (is_moving(snapshot, light))
            limits.push_back({Severity::degraded, where, "moves: with --history it leaves a trail of some frames"});
        if (light.kind != LightKind::sun && in_fog(snapshot, light.position))
            limits.push_back({Severity::info, where, "its glow is even within " + metres(coarse) + " of it"});
    }
    for (const Medium& medium : snapshot.media) {
        const std::string where = "medium " + medium.name;
        const vec3 sides = medium.world_bounds.size();
        const float thin = std::min(sides.x, std::min(sides.y, sides.z));
        const float depth = medium.majorant() * std::min(size.deep, thin);
        if (depth > 1)
            limits.push_back({depth > dark_depth ? Severity::wrong : Severity::degraded, where,
                              "froxels are up to " + number_text("%.2g", depth) +
                                  " optical depths deep: light that changes within them is evened out"});
        if (thin < size.deep)
            limits.push_back(
                {Severity::info, where,
                 "is a sheet thinner than froxels, which are " + metres(size.deep) + " deep: light is even within it"});
        if (medium.kind != DensityKind::bricks) continue;
        const float voxel = 1 / glm::length(vec3(medium.bricks->world_to_index[0]));
        if (voxel < 0.5f * coarse)
            limits.push_back(
                {Severity::info, where,
                 "detail finer than a froxel is lost: voxels of " + metres(voxel) + ", froxels of " + metres(coarse)});
    }
    const auto endless = [](const Medium& medium) { return std::isinf(medium.world_bounds.high.x); };
    if (std::ranges::any_of(snapshot.media, endless))
        limits.push_back({Severity::info, "froxel.depth_slices", "fog behind the scene has a few long slices only"});
    if (froxel.visibility == FroxelVisibility::slices && shadows && snapshot.occluders->has_alpha())
        limits.push_back({Severity::info, "froxel.visibility", "rays are used: there are MASK or BLEND surfaces"});
    return limits;
}
}
