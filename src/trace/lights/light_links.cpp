#include "trace/lights/light_links.h"

#include "scene/light.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
// The instances of a link that are left when those without shadows are taken away; empty = all.
std::vector<bool> casters_of(const Scene& scene, const LightSource& light, bool all_cast) {
    if (all_cast) return light.casters;
    std::vector<bool> casters = light.casters;
    if (casters.empty()) casters.assign(scene.instances.size(), true);
    for (size_t i = 0; i < casters.size(); ++i)
        if (!scene.instances[i].casts_shadows) casters[i] = false;
    return casters;
}

// The number of a set among those so far; -1 for all instances.
template<class Sets, class Same, class Add>
int number_of(const std::vector<bool>& wanted, Sets& sets, const Same& same, const Add& add) {
    if (std::ranges::find(wanted, false) == wanted.end()) return -1;
    const auto known = std::ranges::find_if(sets, same);
    const auto number = static_cast<int>(known - sets.begin());
    if (known == sets.end()) add();
    return number;
}

// The surfaces of the same set a frame before.
const Occluders* before(const std::vector<bool>& instances, const Snapshot* previous) {
    if (!previous) return nullptr;
    const auto known = std::ranges::find(previous->casters, instances, &CasterSet::instances);
    return known == previous->casters.end() ? nullptr : known->occluders.get();
}

std::shared_ptr<const Occluders> surfaces_of(const Scene& scene, double seconds, const std::vector<bool>& instances,
                                             const Snapshot* previous) {
    const Occluders* earlier = before(instances, previous);
    std::shared_ptr<const Occluders> made = Occluders::make(scene, seconds, earlier, &instances);
    if (!earlier || !made->shares_with(*earlier)) return made;
    return std::ranges::find(previous->casters, instances, &CasterSet::instances)->occluders;
}
}

LightLinks light_links(const Scene& scene, double seconds, const Snapshot* previous) {
    const bool all_cast = std::ranges::all_of(scene.instances, &Instance::casts_shadows);
    const auto linked = [](const LightSource& light) { return !light.lit.empty() || !light.casters.empty(); };
    LightLinks links;
    if (all_cast && !std::ranges::any_of(scene.lights, linked)) return links;
    for (const LightSource& light : scene.lights) {
        ivec2 of_light;
        const std::vector<bool> casters = casters_of(scene, light, all_cast);
        of_light.x = number_of(
            casters, links.casters, [&](const CasterSet& set) { return set.instances == casters; },
            [&] {
                links.casters.push_back({casters, surfaces_of(scene, seconds, casters, previous)});
            });
        of_light.y = number_of(
            light.lit, links.lit, [&](const std::vector<bool>& set) { return set == light.lit; },
            [&] { links.lit.push_back(light.lit); });
        links.of_lights.push_back(of_light);
    }
    return links;
}

const std::shared_ptr<const Occluders>& shadow_casters(const Light& light, const Snapshot& snapshot) {
    static const std::shared_ptr<const Occluders> none;
    if (!light.shadows) return none;
    const std::shared_ptr<const Occluders>& surfaces =
        light.casters < 0 ? snapshot.occluders : snapshot.casters[static_cast<size_t>(light.casters)].occluders;
    return surfaces && !surfaces->empty() ? surfaces : none;
}

bool shadows_light(const Light& light, const Snapshot& snapshot, int instance) {
    if (!light.shadows || light.casters < 0 || instance < 0) return light.shadows;
    return snapshot.casters[static_cast<size_t>(light.casters)].instances[static_cast<size_t>(instance)];
}

bool is_lit(const Light& light, const Snapshot& snapshot, int instance) {
    return light.lit < 0 || instance < 0 || snapshot.lit[static_cast<size_t>(light.lit)][static_cast<size_t>(instance)];
}

bool has_alpha_shadows(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.lights, [&](const Light& light) {
        const std::shared_ptr<const Occluders>& casters = shadow_casters(light, snapshot);
        return casters && casters->has_alpha();
    });
}
}
