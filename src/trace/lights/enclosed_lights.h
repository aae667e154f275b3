// Lights that can light nothing, as they stand inside a mesh of their own: a bulb as exporters make it.
#pragma once
#include <string>
#include <vector>

namespace tyndall {
struct Scene;
struct Snapshot;

// One line for each point light or spot nearly all of whose light ends in surfaces close by, most of it in one object:
// its name, the object's, and what to do. A lamp shade with openings, a housing that leaves the beam free and a room
// with a camera in it are none.
std::vector<std::string> enclosed_lights(const Snapshot& snapshot);

// The same of a scene's first frame, without making its fog. Throws Error.
std::vector<std::string> enclosed_lights(const Scene& scene);
}
