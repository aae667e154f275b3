// Shadow and light linking at one moment: which surfaces shadow a light, and which it illuminates.
#pragma once
#include "base/math.h"

#include <vector>

namespace tyndall {
struct CasterSet;
struct Scene;
struct Snapshot;

// Distinct sets of instances, except all of them. For every light of the scene, the index of the set that shadows it
// (x) and of the one it illuminates (y), -1 = all; `of_lights` is empty if there are no sets.
struct LightLinks {
    std::vector<CasterSet> casters;
    std::vector<std::vector<bool>> lit;
    std::vector<ivec2> of_lights;
    ivec2 of_environment{-1};
    std::vector<ivec2> of_instances; // likewise, of the light that each instance emits
};

// Shares surfaces that did not move with `previous` (may be null). Throws Error.
LightLinks light_links(const Scene& scene, double seconds, const Snapshot* previous);
}
