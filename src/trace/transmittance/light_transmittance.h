// How the light's way through the fog to a point is found: left out, one average, or its optical depth from froxels, a
// grid along the light, or a march.
#pragma once

namespace tyndall {
enum class LightTransmittance { off, average, froxel, grid, marched };
}
