// Pictures of tiny scenes by the froxel mode and by the reference.
#pragma once
#include "support/run_mode.h"
#include "support/tiny_scenes.h"

namespace tyndall {
struct History;
}

namespace tyndall::test {
// A box of fog of which a roof shadows half from a slanted sun.
TestScene half_shadowed_fog();

// With froxels as many pixels wide as the settings say, also in small images.
Settings as_wide(Settings settings, ivec2 size);

ScatterFunction froxels(const View& view, const Snapshot& snapshot, const Settings& settings,
                        History* history = nullptr);
}
