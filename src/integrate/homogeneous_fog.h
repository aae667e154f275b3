// Fog that only attenuates, for techniques that add their light by other means.
#pragma once
#include "base/math.h"
#include "integrate/ray_batch.h"

namespace tyndall {
struct Medium;

// Analytic transmittance of homogeneous and height fog; no in-scattering or emission.
ScatterFunction dimming_only(std::vector<Medium> media);
}
