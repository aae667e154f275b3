// The error of a candidate, measured on a few tiles of an image: candidate and ground truth are traced through the same
// surfaces to the same points on soft lights.
//
// With two independent samples per pixel, the product of their differences between candidate and ground truth has the
// squared mean difference as its expected value: the squared error that samples do not remove. Half the squared
// difference of the candidate's two samples estimates the variance of one.
#pragma once
#include "base/clock.h"
#include "render/adaptive/tile_chances.h"
#include "render/frame/frame.h"
#include "trace/view.h"

#include <optional>
#include <span>

namespace tyndall {
inline constexpr int max_drawings = 4, max_passes = 256;
// Per tile: color and inscatter of each of its pixels, for both samples.
inline constexpr size_t pilot_values = 2 * 16 * 2;

using Seconds = std::function<double()>; // a clock

// A squared error relative to the ground truth's squared mean, for color or inscatter, whichever is worse. The bound
// holds with 97.5 % confidence.
struct SquaredError {
    double value = 0, bound = 0;
    bool by_noise = false; // the bound is due to the noise of pixels rather than to few tiles
};

struct Measurement {
    SquaredError integrator;                        // in the limit of infinitely many samples
    SquaredError sample;                            // variance of one sample
    double prepare_seconds = 0, sample_seconds = 0; // per sample of all the image's pixels
    double sample_work = 0;                         // likewise; see Cost
    std::shared_ptr<const Prepared> prepared;       // to render with
};

// Cost of tracing pixels, in seconds and in evaluations. The latter are the same on every machine and at any thread
// count: choices without a time limit go by them.
struct Cost {
    double seconds = 0, work = 0;

    Cost& operator+=(const Cost& other) { return seconds += other.seconds, work += other.work, *this; }
};

// Randomly drawn tiles of an image with ground-truth values: in all pixels of a tile that is certain to be drawn, in a
// quarter of the pixels of others. Grows by independent drawings of tiles and independent passes.
struct Pilot {
    const Mode* mode;
    const Snapshot* snapshot;
    std::atomic<bool>* cancel;
    std::optional<Settings> truth_settings{}; // none = candidates count as unbiased
    View view{};                              // two independent samples per pixel
    uint32_t seed = 0;                        // the image's: modes are prepared with it
    TileChances chances{};
    std::vector<DrawnTile> tiles{};
    int drawings = 0, passes = 1;               // a pass takes two samples per pixel
    std::shared_ptr<const Prepared> prepared{}; // for the ground truth
    std::vector<vec3> truth{};                  // pilot_values per tile; empty = the candidate's own
    Cost cost{};                                // of tracing the ground truth
    std::function<bool()> stop{};               // true when time is up; a few tiles are traced anyway
    double enough_work = infinity;              // ends the first drawing likewise

    double all() const { return static_cast<double>(chances.chances.size()); } // tiles of the image
    bool is_full() const { return drawings >= max_drawings || static_cast<double>(tiles.size()) >= all(); }
    bool can_grow(bool by_noise) const { return by_noise ? passes < max_passes : !is_full(); }
    double samples() const; // pixel samples traced by all passes together
    double pixels() const;  // of the image
    double truth_seconds() const { return cost.seconds / samples() * pixels(); } // per sample of all the image's pixels
};

// A pilot with one drawing, independent of those with another `salt`. `prepared`: for the ground truth, if it exists
// already.
Pilot make_pilot(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings* truth,
                 TileChances chances, uint32_t salt, const FrameOptions& options,
                 std::shared_ptr<const Prepared> prepared = {}, std::function<bool()> stop = {},
                 double enough_work = infinity);

// Draws more tiles and traces the ground truth there; or, `by_noise`, doubles the passes over the tiles drawn so far.
void grow(Pilot& pilot, bool by_noise = false);

// A candidate's values on the tiles of a pilot; grows with it.
struct PilotRun {
    const Mode& mode;
    const Settings& settings;
    std::shared_ptr<const Prepared> prepared{};
    const Snapshot* snapshot = nullptr; // null = the pilot's
    std::vector<vec3> values{};         // pilot_values per tile traced
    int passes = 0;                     // over those tiles
    double prepare_seconds = 0;
    Cost cost{};

    const Snapshot& of(const Pilot& pilot) const { return snapshot ? *snapshot : *pilot.snapshot; }
};

// Measures a candidate: traces the tiles and passes it lacks, and prepares the mode unless that is done already.
Measurement measure(const Pilot& pilot, PilotRun& run, const Seconds& clock);
Measurement measure(const Pilot& pilot, const Mode& mode, const Settings& settings, const Seconds& clock);

// Exponent, 1 to 2, by which the variance of a pixel's mean falls with the number of samples: they are better
// distributed than independent ones. Measured on means of eight.
double variance_power(const Pilot& pilot, const Mode& mode, const Settings& settings, const Prepared& prepared);

enum Product { of_integrator, of_sample, product_count };

// Squared error or variance from values on the pilot's tiles: the worse of color and inscatter.
SquaredError error_of(const Pilot& pilot, const std::vector<vec3>& truth, const std::vector<vec3>& own,
                      Product product);

// Products of differences (see above) of one layer, summed over pixels.
struct Sums {
    double products[product_count] = {};
    double squares[product_count] = {}; // of the pixels' products
    double mean = 0, count = 0;

    void scale(double factor) {
        for (int k = 0; k < product_count; ++k) products[k] *= factor, squares[k] *= factor * factor;
        mean *= factor, count *= factor;
    }
};

// Sums over a tile of the ground truth's and a candidate's pilot values; layer 0 = color, 1 = inscatter.
Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, size_t layer);

// Squared error over the squared mean, from tiles that each stand for several. The bound is that of a sum of equal
// lumps that occur at random, like Wilson's (1927) for counts; with many lumps, 1.96 standard errors (linearized
// ratio). The size of a lump is the third moment over the variance.
SquaredError squared_error(std::span<const Sums> sums, std::span<const DrawnTile> tiles, Product product);
}
