// Dither patterns that offset the steps of neighboring pixels, so that too few steps show as fine grain instead of
// banding.
#pragma once
#include "base/math.h"

#include <cstdint>

namespace tyndall {
// none            every pixel takes the middle
// ordered         a 4×4 matrix (Bayer 1973)
// white           random numbers
// blue            a 64×64 tile of blue noise (void and cluster)
// interleaved     interleaved gradient noise (Jimenez 2014)
// spatiotemporal  16 such tiles that are also blue from frame to frame (Wolfe et al. 2022)
enum class Jitter { none, ordered, white, blue, interleaved, spatiotemporal };

// A pixel's offset in [0,1), in units of 2^-32. From frame to frame, ordered, blue and interleaved shift by the golden
// ratio, white is randomized again, and spatiotemporal takes its next slice.
uint32_t jitter_bits(Jitter jitter, ivec2 pixel, int frame, uint32_t seed);
}
