// Whether a noisy, unbiased picture and an exact one show the same: standard scores of their tiles.
#pragma once
#include "base/image.h"

namespace tyndall {
// Over tiles of 8×8 pixels, channel by channel, that are lit: no darker than 1 % of the reference's mean.
struct TileScores {
    int scores = 0;                 // three a tile, less what is dark
    double mean = 0, deviation = 0; // of the scores z = difference / standard error: 0 and 1 when both show the same
    double within_3 = 0;            // share of tiles with |z| <= 3: 0.9973 when the errors are normal
    double precise = 0;             // share of tiles whose standard error is at most 1 % of the reference
    double dark = 0;                // score of all dark tiles together: light where there should be none
};

// `variance`: of the difference of each pixel and channel; pixels are independent. Rounding of floats counts as an
// error of 1e-5 of the tile.
TileScores tile_scores(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference);
}
