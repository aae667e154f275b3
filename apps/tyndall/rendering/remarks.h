// Messages of tyndall render before and after it renders an image.
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

// The mode's limitations on the first frame, with the settings it starts from. `measured` adds the measured error of
// multiple scattering, except for an image rendered to a goal, which accounts for it.
Limitations limitations_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan,
                           const Snapshot& snapshot, bool measured);

void say_rounding(const RenderRequest& request, const Globals& globals);

// Prints options without effect, then warnings and limitations. `settings`: the arguments of --set.
void say_before(const Scene& scene, const Snapshot& first, const Limitations& limitations,
                const std::vector<std::string>& settings, const RenderRequest& request, const Mode& mode,
                const Globals& globals);

// Prints the cache files that were found, and the time they had taken to make.
void say_files_found(const RenderRequest& request, const Globals& globals);

void say_summary(const RenderReport& report, const RenderRequest& request);

// Says where the PNGs are, or recommends --png.
void say_look(const RenderRequest& request);
}
