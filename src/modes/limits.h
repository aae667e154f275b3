// Limits that several modes share.
#pragma once
#include "base/math.h"
#include "modes/promise.h"
#include "trace/fluence/settings.h"

#include <vector>

namespace tyndall {
struct Snapshot;
struct View;

// Where a medium is so thick that light scattered more than once shows, ambient light that nothing shadows, and places
// so far from the origin that floats do not resolve them.
void add_single_scattering_limits(const View& view, const Snapshot& snapshot, std::vector<Limit>& limits);

// Where fog dims the light to it within a cell of a light grid that has so many cells across the fog.
void add_light_grid_limits(const Snapshot& snapshot, int cells, std::vector<Limit>& limits);

// Rays through the middle and towards the corners of the picture, to the end of fog and scene.
std::vector<Ray> probing_rays(const View& view, const Snapshot& snapshot);

// Where so many steps along a ray are too few for the detail of a grid; with `fixed`, for its light in thick fog too.
// `row` names the setting.
void add_step_limits(const View& view, const Snapshot& snapshot, int steps, const char* row, bool fixed,
                     std::vector<Limit>& limits);

// Optical depths of a step or a froxel that take most of the light that falls on them: what is seen is by chance.
inline constexpr float dark_depth = 2;

std::string number_text(const char* format, double value);

// What a grid of light that has been scattered before cannot show; ambient light too.
void add_fluence_limits(const View& view, const Snapshot& snapshot, const FluenceSettings& settings,
                        std::vector<Limit>& limits);
}
