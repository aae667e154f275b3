// Noise of a grid of fluence, taken out where it hides the light.
#pragma once
#include "trace/fluence/fluence.h"

namespace tyndall {
// The values become a mean of themselves and of filters that reach over 3, 7 and 15 cells, each of which takes out a
// detail: a share of it stays that is, in power, as large as that of the light in the details around (Wiener 1949). The
// rest is noise by `difference`: half of what one half of the paths gives more than the other, as many values. What
// leaves at walls and at the borders of the grid comes back.
void smooth(std::vector<float> difference, FluenceGrid& grid);
}
