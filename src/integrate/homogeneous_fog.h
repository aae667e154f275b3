// Fog that only dims: for looks that add their light by other means.
#pragma once
#include "base/math.h"
#include "integrate/ray_batch.h"

namespace tyndall {
struct Medium;

// Transmittance of homogeneous and height fog in closed form, and no light of its own.
ScatterFunction dimming_only(std::vector<Medium> media);
}
