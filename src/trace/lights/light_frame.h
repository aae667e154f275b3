// Where a light of the scene is and how it is turned.
#pragma once
#include "trace/moment.h"

namespace tyndall {
struct LightSource;

// Like node_frame(), but for any node: `forward` is 0 where the light has no direction or is hidden.
NodeFrame light_frame(const Scene& scene, const LightSource& light, double seconds);
}
