// Fog that only dims: for looks that add their light by other means.
#pragma once
#include "modes/mode.h"
#include "volume/medium.h"

namespace tyndall {
// Transmittance of homogeneous and height fog in closed form, and no light of its own.
ScatterFunction dimming_only(std::vector<Medium> media);
}
