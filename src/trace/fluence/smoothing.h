// Denoising of fluence grids.
#pragma once
#include "trace/fluence/fluence.h"

namespace tyndall {
// A local Wiener filter (Wiener 1949). The grid is split into details by filters of 3, 7 and 15 cells; of each detail,
// the fraction that is signal is kept, by the power of signal and noise nearby. `difference` is the noise, with as many
// values: half the difference between the estimates of the two halves of the paths. Reflects at walls and at the grid's
// borders.
void smooth(std::vector<float> difference, FluenceGrid& grid);
}
