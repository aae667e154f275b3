// Tests whether a noisy, unbiased image agrees with an exact one, by standard scores of their tiles.
#pragma once
#include "base/image.h"

namespace tyndall {
// Over lit tiles of 8×8 pixels, channel by channel: those brighter than 1 % of the reference's mean.
struct TileScores {
    int scores = 0;                 // three per tile, except dark ones
    double mean = 0, deviation = 0; // of the scores z = difference / standard error: 0 and 1 when the images agree
    double within_3 = 0;            // share of tiles with |z| <= 3: 0.9973 when the errors are normal
    double precise = 0;             // share of tiles whose standard error is at most 1 % of the reference
    double dark = 0; // largest score over channels of all dark tiles together: light where there should be none
};

// `variance`: of the difference at each pixel and channel; pixels are independent. Float rounding counts as a relative
// error of 1e-5 per tile.
TileScores tile_scores(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference);
}
