// How transmittance from a light to a point is found: ignored, one average, or from optical depth in froxels, in a grid
// along the light, or by marching.
#pragma once

namespace tyndall {
enum class LightTransmittance { off, average, froxel, grid, marched };
}
