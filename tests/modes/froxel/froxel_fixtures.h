// Pictures of tiny scenes by the froxel mode and by the reference.
#pragma once
#include "support/run_mode.h"
#include "support/tiny_scenes.h"

namespace tyndall {
struct History;
}

namespace tyndall::test {
// A box of fog of which a roof shadows half from a slanted sun.
Stage half_shadowed_fog();

View view_of(vec3 position, vec3 target, ivec2 size = {64, 36});

// One ray through the centre of every pixel, up to the first surface or `far`.
std::vector<Ray> picture_rays(const View& view, const Snapshot& snapshot, float far = 1000);

ScatterFunction froxels(const View& view, const Snapshot& snapshot, const Settings& settings,
                        History* history = nullptr);

double mean_radiance(const std::vector<Scatter>& results);

// Root of the mean squared difference, over the mean of `truth`.
double relative_rmse(const std::vector<Scatter>& results, const std::vector<Scatter>& truth);
}
