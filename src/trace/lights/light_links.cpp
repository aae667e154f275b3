#include "trace/lights/light_links.h"

#include "scene/light.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
// Removes the instances that cast no shadows from a link; empty = all.
std::vector<bool> without_shadowless(const Scene& scene, std::vector<bool> casters, bool all_cast) {
    if (all_cast) return casters;
    if (casters.empty()) casters.assign(scene.instances.size(), true);
    for (size_t i = 0; i < casters.size(); ++i)
        if (!scene.instances[i].casts_shadows) casters[i] = false;
    return casters;
}

// Index of a set among those so far, adding it if it is new; -1 for all instances.
template<class Sets, class Same, class Add>
int number_of(const std::vector<bool>& wanted, Sets& sets, const Same& same, const Add& add) {
    if (std::ranges::find(wanted, false) == wanted.end()) return -1;
    const auto known = std::ranges::find_if(sets, same);
    const auto number = static_cast<int>(known - sets.begin());
    if (known == sets.end()) add();
    return number;
}

// The surfaces of the same set in the previous frame.
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
    const auto linked = [](const auto& light) { return !light.lit.empty() || !light.casters.empty(); };
    LightLinks links;
    const auto sets_of = [&](const auto& light, const std::vector<bool>& casters) {
        const int shadowed = number_of(
            casters, links.casters, [&](const CasterSet& set) { return set.instances == casters; },
            [&] {
                links.casters.push_back({casters, surfaces_of(scene, seconds, casters, previous)});
            });
        const int lit = number_of(
            light.lit, links.lit, [&](const std::vector<bool>& set) { return set == light.lit; },
            [&] { links.lit.push_back(light.lit); });
        return ivec2(shadowed, lit);
    };
    if (!all_cast || std::ranges::any_of(scene.lights, linked))
        for (const LightSource& light : scene.lights)
            links.of_lights.push_back(sets_of(light, without_shadowless(scene, light.casters, all_cast)));
    if (const auto& sky = scene.environment; sky && (!all_cast || linked(*sky)))
        links.of_environment = sets_of(*sky, without_shadowless(scene, sky->casters, all_cast));
    if (std::ranges::any_of(scene.instances, linked))
        for (const Instance& one : scene.instances) links.of_instances.push_back(sets_of(one, one.casters));
    return links;
}

namespace {
const std::shared_ptr<const Occluders>& surfaces_in(int set, bool shadows, const Snapshot& snapshot) {
    static const std::shared_ptr<const Occluders> none;
    if (!shadows) return none;
    const std::shared_ptr<const Occluders>& surfaces =
        set < 0 ? snapshot.occluders : snapshot.casters[static_cast<size_t>(set)].occluders;
    return surfaces && !surfaces->empty() ? surfaces : none;
}

bool is_in(int set, const Snapshot& snapshot, int instance) {
    return set < 0 || instance < 0 || snapshot.lit[static_cast<size_t>(set)][static_cast<size_t>(instance)];
}
}

const std::shared_ptr<const Occluders>& shadow_casters(const Light& light, const Snapshot& snapshot) {
    return surfaces_in(light.casters, light.shadows, snapshot);
}

const std::shared_ptr<const Occluders>& shadow_casters(const Environment& environment, const Snapshot& snapshot) {
    return surfaces_in(environment.casters, environment.shadows, snapshot);
}

bool shadows_light(const Light& light, const Snapshot& snapshot, int instance) {
    if (!light.shadows || light.casters < 0 || instance < 0) return light.shadows;
    return snapshot.casters[static_cast<size_t>(light.casters)].instances[static_cast<size_t>(instance)];
}

bool is_lit(const Light& light, const Snapshot& snapshot, int instance) { return is_in(light.lit, snapshot, instance); }

bool is_lit(const Environment& environment, const Snapshot& snapshot, int instance) {
    return is_in(environment.lit, snapshot, instance);
}

const std::shared_ptr<const Occluders>& caster_surfaces(int set, const Snapshot& snapshot) {
    return surfaces_in(set, true, snapshot);
}

ivec2 emission_links(const Snapshot& snapshot, int instance) {
    return snapshot.emission_links.empty() ? ivec2(-1) : snapshot.emission_links[static_cast<size_t>(instance)];
}

bool is_lit_by_emitter(const Snapshot& snapshot, int emitter, int instance) {
    return is_in(emission_links(snapshot, emitter).y, snapshot, instance);
}

bool has_alpha_shadows(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.lights, [&](const Light& light) {
        const std::shared_ptr<const Occluders>& casters = shadow_casters(light, snapshot);
        return casters && casters->has_alpha();
    });
}
}
