// Noise of a grid of fluence, taken out where it hides the light.
#pragma once
#include "trace/fluence/fluence.h"

namespace tyndall {
// A local Wiener filter (Wiener 1949). The grid is split into details by filters of 3, 7 and 15 cells; of each detail
// the share is kept that is light, by the power of light and noise nearby. The noise is `difference`: half of what one
// half of the paths gives more than the other, as many values. Light that reaches walls or the grid's borders comes
// back.
void smooth(std::vector<float> difference, FluenceGrid& grid);
}
