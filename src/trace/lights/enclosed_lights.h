// Finds lights that illuminate nothing because they are inside their own mesh, like a bulb as exporters make it.
#pragma once
#include <string>
#include <vector>

namespace tyndall {
struct Scene;
struct Snapshot;

// One message per point light or spot nearly all of whose light is blocked by surfaces close by, mostly of one object:
// its name, the object's, and what to do. Leaves out lamp shades with openings, housings that leave the beam free, and
// rooms with a camera in them.
std::vector<std::string> enclosed_lights(const Snapshot& snapshot);

// The same for a scene's first frame, without building its fog. Throws Error.
std::vector<std::string> enclosed_lights(const Scene& scene);
}
