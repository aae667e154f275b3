// How many samples each part of a picture needs: the tiles that spread most take most. Found from the variances of a
// picture that is then thrown away, so that what was found does not bias what counts.
#pragma once
#include "render/frame/frame.h"

namespace tyndall {
struct TileFactors;

inline constexpr int max_tile_samples = 1 << 16; // of a pixel

struct Allotment {
    ivec2 low{0};             // the first tile's place
    Image<float> samples;     // of each pixel of a tile
    double rays = 0;          // of all pixels, counted in those of the mean cost
    double squared_error = 0; // to expect, as a share of the squared mean
    double squared_bound = 0; // below which it is with a confidence of 99.5 %
    double pixels = 0;        // that hold the error: as many of equal variance would spread it as much
};

// Least cost with no more error than both, or the best that so many rays of the mean cost give.
struct Enough {
    double squared_error = 0, rays = 0, squared_bound = infinity;
};

// Where variances of means fall with the number of samples to the `power`, samples go as (variance / cost)^(1 /
// (1 + power)) (Neyman 1934 for power 1), more where few pixels make most of the error, `least` or more of each pixel.
// `layers` hold the variances of means of `taken` samples, and the work of one.
Allotment allot(const Layers& layers, double taken, const Enough& enough, double power, int least);

// Likewise, of so many samples of a pixel of each tile.
Allotment allot(const Layers& layers, const Image<float>& taken, const Enough& enough, double power, int least);

// Samples of a pixel of each tile: as many in all; or in a picture of `scale` times as many as allotted, in multiples
// of `unit`. Batches that go on from part to part stay as few in tiles of many samples.
Image<float> samples_alike(const Layers& layers, double samples);
Image<float> samples_in(const Allotment& allotment, double scale, int unit, bool goes_on);

// What a picture of `to` times as many samples as allotted adds to one of `from` times as many: in multiples of `unit`,
// one at least, but none where `from` is above 0 and rounding up has given them already.
struct AllottedPart {
    std::shared_ptr<const TileFactors> factors; // units added
    std::shared_ptr<const TileFactors> before;  // samples that its batches go on after; null = they are new
    TileShares shares;                          // of the two together
};
AllottedPart part_of(const Allotment& allotment, double from, double to, int unit, bool goes_on);
}
