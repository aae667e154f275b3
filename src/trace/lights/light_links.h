// Which surfaces shadow a light, and which it shines on: flags of objects and links of lights at one moment.
#pragma once
#include "base/math.h"

#include <vector>

namespace tyndall {
struct CasterSet;
struct Scene;
struct Snapshot;

// Sets that differ from all instances, each once; of every light of the scene, which one shadows it (x) and which it
// shines on (y), -1 = all. `of_lights` is empty when there are no sets.
struct LightLinks {
    std::vector<CasterSet> casters;
    std::vector<std::vector<bool>> lit;
    std::vector<ivec2> of_lights;
    ivec2 of_environment{-1};
};

// Shares the surfaces that did not move with `previous`. Throws Error.
LightLinks light_links(const Scene& scene, double seconds, const Snapshot* previous);
}
