// Settings of the fluence grid for multiple scattering (trace/fluence/fluence.h).
#pragma once

namespace tyndall {
struct FluenceSettings {
    int orders = 1;      // maximum scattering order, in fog and on surfaces; 1 = no grid
    int resolution = 64; // cells along the longest side of the fog
    int paths = 200'000; // light paths
};
}
