// What is asked of the grid of light that has been scattered before (trace/fluence/fluence.h).
#pragma once

namespace tyndall {
struct FluenceSettings {
    int orders = 1;      // most scatterings of light, in fog or on surfaces; 1 = no grid
    int resolution = 64; // cells along the longest side of the fog
    int paths = 200'000; // of light
};
}
