// Adaptive sampling: how many samples each tile needs; tiles with the most variance get the most. The variances come
// from an image that is then discarded, so that the allotment does not bias the result.
#pragma once
#include "render/frame/frame.h"

namespace tyndall {
struct TileFactors;

inline constexpr int max_tile_samples = 1 << 16; // per pixel

struct Allotment {
    ivec2 low{0};             // coordinates of the first tile, in tiles
    Image<float> samples;     // per pixel of each tile
    double rays = 0;          // over all pixels, in rays of mean cost
    double squared_error = 0; // expected, relative to the squared mean
    double squared_bound = 0; // upper bound with 99.5 % confidence
    double pixels = 0;        // effective number of pixels that cause the error, as if of equal variance; no more than
                              // hold the squared light: few samples may miss the variance of a bright pixel
};

// What to allot for: both error limits at the least cost, or, if that takes more, the least error with `rays` rays of
// mean cost; or less than either where tiles that can have no more samples hold most of the error.
struct AllotLimits {
    double squared_error = 0, rays = 0, squared_bound = infinity;
};

// Allots samples in proportion to (variance / cost)^(1 / (1 + power)), where the variance of a mean of n samples falls
// as n^-power (Neyman 1934 for power 1); more where few pixels cause most of the error, and at least `least` per pixel.
// `layers` hold the variances of means of `taken` samples and the work per sample.
Allotment allot(const Layers& layers, double taken, const AllotLimits& limits, double power, int least);

// The same, with `taken` samples per pixel of each tile.
Allotment allot(const Layers& layers, const Image<float>& taken, const AllotLimits& limits, double power, int least);

// Samples per pixel of each tile: the same number everywhere; or `scale` times the allotment, rounded up to multiples
// of `unit`. Tiles with many samples are rounded up further, to hold more batches, unless batches continue from part to
// part (`continues`).
Image<float> uniform_samples(const Layers& layers, double samples);
Image<float> samples_in(const Allotment& allotment, double scale, int unit, bool continues);

// What an image with `to` times the allotted samples adds to one with `from` times: in multiples of `unit`. At least
// one, or none if `from` is above 0 and rounding up has already added them.
struct AllottedPart {
    std::shared_ptr<const TileFactors> factors; // units added
    std::shared_ptr<const TileFactors> before;  // samples per batch that earlier parts took; null = the batches are new
    TileShares shares;                          // of the total
};
AllottedPart allotted_part(const Allotment& allotment, double from, double to, int unit, bool continues);
}
