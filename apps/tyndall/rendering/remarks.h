// What `tyndall render` says of a picture before it is rendered, and after.
#pragma once
#include "common.h"
#include "modes/limitation.h"

#include <string>
#include <vector>

namespace tyndall {
struct Mode;
struct RenderPlan;
struct RenderReport;
struct RenderRequest;
struct Scene;
struct Snapshot;

// Where the mode fails on this scene, from the first frame, with the settings it begins with. `measured`: with how far
// multiple scattering is off, where an image is not rendered to a goal, which counts it.
Limitations limitations_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan,
                           const Snapshot& snapshot, bool measured);

void say_rounding(const RenderRequest& request, const Globals& globals);

// What is asked for in vain, then what the picture will not show. `settings`: as the command line has them.
void say_before(const Scene& scene, const Snapshot& first, const Limitations& limitations,
                const std::vector<std::string>& settings, const RenderRequest& request, const Mode& mode,
                const Globals& globals);

// Files of the cache that were found, and what they saved.
void say_files_found(const RenderRequest& request, const Globals& globals);

void say_summary(const RenderReport& report, const RenderRequest& request);

// Where the pictures are, or how to get some that any program shows.
void say_look(const RenderRequest& request);
}
