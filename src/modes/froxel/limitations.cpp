#include "modes/froxel/limitations.h"

#include "integrate/lobe_cuts.h"
#include "modes/area_light_limitations.h"
#include "modes/froxel/beams/beam_shadows.h"
#include "modes/froxel/beams/beams.h"
#include "modes/froxel/glow.h"
#include "modes/froxel/grid.h"
#include "modes/froxel/settings.h"
#include "modes/history_limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Size of a froxel at the scene's center: across, and in depth.
struct FroxelSize {
    float across = 0, deep = 0; // meters

    float coarse() const { return std::max(across, deep); }
};
FroxelSize middle_froxel(const View& view, const Snapshot& snapshot, const FroxelSettings& settings) {
    const FroxelGrid grid = make_froxel_grid(view.camera, view.size, settings.tile);
    const Box& box = snapshot.bounds;
    const float depth = std::max(glm::dot(box.center() - view.camera.position, view.camera.forward), view.camera.near);
    const float extent = box.empty() ? depth : depth + 0.5f * glm::length(box.size());
    return {froxel_width(grid, depth), extent / static_cast<float>(settings.depth_slices)};
}

bool in_fog(const Snapshot& snapshot, vec3 point) {
    return std::ranges::any_of(snapshot.media, [&](const Medium& medium) { return density_at(medium, point) > 0; });
}

// Whether all of a light is integrated per camera ray in each frame; `exact`: with its shadows.
struct Followed {
    bool all = false, exact = false;
};
Followed followed(const Light& light, const Snapshot& snapshot, const FroxelSettings& settings, bool views_fit) {
    const bool by_ray = !settings.amortize && !is_distant(light);
    const bool exact = by_ray && has_exact_shadows(light, snapshot, settings, views_fit);
    const auto& casters = shadow_casters(light, snapshot);
    return {by_ray && (has_cone(light) || exact), exact && !(casters && casters->has_alpha())};
}

// Reports a sun whose glow or halo is narrower than a froxel.
void add_glow(const View& view, const Snapshot& snapshot, const Light& light, int tile, Limitations& limitations) {
    if (!is_distant(light)) return;
    const bool seen = shows_sun(view, snapshot, light);
    const float across = tile_angle(view, tile);
    float glow = pi;
    for (const Medium& medium : snapshot.media) {
        if (seen && is_narrow(medium.optics.phase, across)) glow = std::min(glow, glow_angle(medium.optics.phase));
        if (const float halo = narrowest_halo(medium); halo < 3 * across) glow = std::min(glow, halo);
    }
    if (glow < pi)
        limitations.push_back({Severity::degraded,
                               &limitation::coarse_glow,
                               Subject::light,
                               light.name,
                               {glm::degrees(glow), glm::degrees(across)}});
}

// Reports errors in a light's shadows, filter, motion and nearby glow.
void add_light(const View& view, const Light& light, const Snapshot& snapshot, const FroxelSettings& settings,
               FroxelSize size, const Followed& by_rays, Limitations& limitations) {
    const auto add = [&](Severity severity, const LimitationKind& kind, std::array<double, 2> amounts = {}) {
        limitations.push_back({severity, &kind, Subject::light, light.name, amounts});
    };
    const bool fine = settings.tile == 1 && settings.depth_slices >= 256;
    const bool shadows = shadow_casters(light, snapshot) != nullptr;
    if (settings.visibility == FroxelVisibility::off && light.shadows)
        add(Severity::wrong, limitation::visibility_off);
    else if (shadows && !by_rays.exact)
        add(fine ? Severity::info : Severity::degraded, limitation::coarse_shafts, {size.across, size.deep});
    if (shadows && is_soft(light) && settings.shadow_rays == 1 && !by_rays.exact)
        add(Severity::degraded, limitation::hard_shadows);
    if (shadows && is_soft(light) && by_rays.exact)
        add(Severity::info, limitation::few_lamp_points, {static_cast<double>(lamp_points(light))});
    const float away = glm::distance(light.position, snapshot.bounds.center());
    const float across = by_rays.all ? 0 : size.coarse() / std::max(away, size.coarse());
    if (light.filter) add_blurred_filter(light, std::max(filter_point_angle(light), across), limitations);
    if (by_rays.all) return;
    if (view.has_history && is_moving(snapshot, light)) add(Severity::degraded, limitation::moving_light);
    if (settings.amortize && !is_distant(light) && in_fog(snapshot, light.position))
        add(Severity::info, limitation::flat_glow, {size.coarse()});
}

// Reports detail of a medium that is finer than a froxel.
void add_medium(const Medium& medium, FroxelSize size, Limitations& limitations) {
    const auto add = [&](Severity severity, const LimitationKind& kind, std::array<double, 2> amounts) {
        limitations.push_back({severity, &kind, Subject::medium, medium.name, amounts});
    };
    if (only_emits(medium.optics)) return; // integrated per camera ray
    const vec3 sides = medium.world_bounds.size();
    const float thin = std::min(sides.x, std::min(sides.y, sides.z));
    const float depth = medium.majorant() * std::min(size.deep, thin);
    if (depth > 1) add(depth > dark_depth ? Severity::wrong : Severity::degraded, limitation::deep_froxels, {depth});
    if (thin < size.deep) add(Severity::info, limitation::thin_medium, {size.deep});
    if (medium.density.kind != DensityKind::bricks) return;
    const float voxel = 1 / glm::length(vec3(medium.density.bricks->world_to_index[0]));
    if (voxel < 0.5f * size.coarse()) add(Severity::info, limitation::lost_detail, {size.coarse(), voxel});
}
}

Limitations froxel_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Settings terms = settings; // the march's limitations of single scattering apply here too
    terms.march.visibility = Visibility::rays;
    Limitations limitations = main_mode().limitations(view, snapshot, terms);
    std::erase_if(limitations, [](const Limitation& one) { return one.is(limitation::sampled_gobo); });
    if (snapshot.media.empty()) return limitations;
    add_fog_through_middle(view, snapshot, limitations);
    if (settings.terms.ambient) add_mean_environment(view, snapshot, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    if (settings.terms.emission)
        add_lamps_for_fire(snapshot, limitations), add_lamps_for_surfaces(view, snapshot, limitations);

    const FroxelSettings froxel = with_tile(settings.of<FroxelSettings>(), view.size);
    const FroxelSize size = middle_froxel(view, snapshot, froxel);
    const bool views_fit = froxel.visibility != FroxelVisibility::intervals || lamp_views_fit(snapshot);
    for (const Light& light : snapshot.lights) {
        add_light(view, light, snapshot, froxel, size, followed(light, snapshot, froxel, views_fit), limitations);
        add_glow(view, snapshot, light, froxel.tile, limitations);
    }
    if (view.has_history) {
        add_moving_camera(view, snapshot, limitations);
        add_moving_shadows(snapshot, limitations,
                           [&](const Light& light) { return !followed(light, snapshot, froxel, views_fit).exact; });
        add_moving_fog(snapshot, limitations);
    }
    for (const Medium& medium : thickest_media(snapshot)) add_medium(medium, size, limitations);
    const auto unbounded = [](const Medium& medium) { return std::isinf(medium.world_bounds.high.x); };
    if (std::ranges::any_of(snapshot.media, unbounded))
        limitations.push_back({Severity::info, &limitation::few_far_slices, Subject::setting, "froxel.depth_slices"});
    if (froxel.visibility == FroxelVisibility::intervals && has_alpha_shadows(snapshot))
        limitations.push_back(
            {Severity::info, &limitation::coarse_alpha_shadows, Subject::setting, "froxel.visibility"});
    return limitations;
}
}
