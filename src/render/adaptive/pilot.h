// How wrong pictures will be, before they are rendered: a few pixels, evenly spread, and those that show a lamp are
// followed by a candidate and by the truth, through the same surfaces to the same points of soft lights.
//
// With two independent samples of a pixel, the differences between candidate and truth multiply to the square of the
// mean difference, on average: to what samples do not remove. Half the squared difference of the candidate's own
// samples is the variance of one. One sample alone lies at the pixel's centre; its differences from both samples of the
// truth multiply to its squared error, whatever the reason.
#pragma once
#include "base/clock.h"
#include "render/frame/frame.h"
#include "trace/view.h"

#include <cmath>
#include <span>

namespace tyndall {
inline constexpr int max_pilot_tiles = 128; // of sixteen pixels
inline constexpr int fewest_pilot_tiles = 32;
inline constexpr int max_lamp_tiles = 16;
// Of a tile: for both samples, for each of its pixels, colour and fog light.
inline constexpr size_t pilot_values = 2 * 16 * 2;

using Seconds = std::function<double()>; // a clock

// Squared errors as shares of the squared mean of the truth: for colour or fog light, whichever is worse. The bound
// holds with a confidence of 97.5 % (jackknife over tiles).
struct SquaredError {
    double value = 0, bound = 0;
};

struct Measured {
    SquaredError integrator;                        // of the mean of endless samples
    SquaredError sample;                            // variance of one sample, but where lamps show: those pixels
                                                    // take as many more as they need
    SquaredError single;                            // of a picture of one sample per pixel
    double prepare_seconds = 0, sample_seconds = 0; // per sample of all the picture's pixels
    std::shared_ptr<const Prepared> prepared;       // to render with
};

// What is known of the truth.
struct Pilot {
    View view;                  // two samples per pixel, independent of each other
    std::vector<ivec2> corners; // of the tiles, in an order of which any beginning is spread evenly
    double tiles = 0;           // of the whole picture
    size_t lamp_tiles = 0;      // the first corners: tiles that show a lamp stand for no other tile
    double truth_seconds = 0;   // per sample of all the picture's pixels
    std::vector<vec3> truth;    // pilot_values of each tile; empty = the candidate's
};

// How many tiles of the picture a tile of the pilot stands for, itself too.
double tiles_stood_for(const Pilot& pilot, size_t tile);

// Follows the truth until `enough` says so, but on fewest_pilot_tiles at least. Without `truth` candidates are taken
// to be right on the average.
Pilot make_pilot(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings* truth,
                 const FrameOptions& options, const std::function<bool()>& enough);

Measured measure(const Pilot& pilot, const Mode& mode, const Snapshot& snapshot, const Settings& settings,
                 const FrameOptions& options, const Seconds& clock);

// Samples of a pixel are spread better than independent ones: the variance of their mean falls as that of one, divided
// by n to this power, 1 to 2. Measured on means of eight.
double spread_power(const Pilot& pilot, const Mode& mode, const Snapshot& snapshot, const Settings& settings,
                    const Prepared& prepared, double sample_variance, const FrameOptions& options);

enum Product { of_integrator, of_sample, of_single, product_count };

// Of one layer: products of differences, as render/adaptive/pilot.h has them, summed over pixels.
struct Sums {
    double products[product_count] = {};
    double squares[product_count] = {}; // of the pixels' products
    double mean = 0, count = 0;

    void add(const Sums& other, double factor) {
        for (int k = 0; k < product_count; ++k)
            products[k] += factor * other.products[k], squares[k] += factor * factor * other.squares[k];
        mean += factor * other.mean, count += factor * other.count;
    }
    double square(Product k) const { // as a share of the squared mean
        if (std::abs(products[k]) == 0) return 0;
        return mean > 0 ? products[k] * count / (mean * mean) : infinity;
    }
};

// Of a tile. Pilot values of the truth, of a candidate, and of its single samples; layer 0 = colour, 1 = fog light.
Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, std::span<const vec3> center, size_t layer);

struct TileSums {
    std::vector<Sums> tiles; // those with a lamp come first
    size_t lamp_tiles = 0;
    double all = 0; // tiles of the picture
};

// Its bound is by jackknife over the tiles without a lamp: how far the ratio moves when one is left out. A pixel of a
// tile with one may be off by as much as it says.
SquaredError squared_error(const TileSums& sums, Product product);
}
