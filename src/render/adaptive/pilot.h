// How far a way of integrating fog is from the truth, on a few tiles of a picture: both are followed through the same
// surfaces to the same points of soft lights.
//
// With two independent samples of a pixel, the differences between candidate and truth multiply to the square of the
// mean difference, on average: to what samples do not remove. Half the squared difference of the candidate's own
// samples is the variance of one.
#pragma once
#include "base/clock.h"
#include "render/adaptive/tile_chances.h"
#include "render/frame/frame.h"
#include "trace/view.h"

#include <optional>
#include <span>

namespace tyndall {
inline constexpr int max_drawings = 4, max_passes = 256;
// Of a tile: for both samples, for each of its pixels, colour and fog light.
inline constexpr size_t pilot_values = 2 * 16 * 2;

using Seconds = std::function<double()>; // a clock

// Squared errors as shares of the squared mean of the truth: for colour or fog light, whichever is worse. The bound
// holds with a confidence of 97.5 %.
struct SquaredError {
    double value = 0, bound = 0;
    bool by_noise = false; // the bound is as large as it is for the noise of pixels rather than for few tiles
};

struct Measured {
    SquaredError integrator;                        // of the mean of endless samples
    SquaredError sample;                            // variance of one sample
    double prepare_seconds = 0, sample_seconds = 0; // per sample of all the picture's pixels
    double sample_work = 0;                         // likewise; see Cost
    std::shared_ptr<const Prepared> prepared;       // to render with
};

// What following pixels cost: in seconds, and in evaluations, which are the same on every machine and for any number of
// threads. Choices that no limit of time asks for go by the latter.
struct Cost {
    double seconds = 0, work = 0;

    Cost& operator+=(const Cost& other) { return seconds += other.seconds, work += other.work, *this; }
};

// Tiles of a picture, and what is known of the truth there: in all pixels of a tile that was drawn for certain, in a
// quarter of those of others. It grows by drawings and by passes that are independent of each other.
struct Pilot {
    const Mode* mode;
    const Snapshot* snapshot;
    std::atomic<bool>* cancel;
    std::optional<Settings> truth_settings{}; // none: candidates are taken to be right on the average
    View view{};                              // two samples per pixel, independent of each other
    uint32_t seed = 0;                        // of the picture: modes are prepared with it
    TileChances chances{};
    std::vector<DrawnTile> tiles{};
    int drawings = 0, passes = 1;               // passes: of two samples each
    std::shared_ptr<const Prepared> prepared{}; // for the truth
    std::vector<vec3> truth{};                  // pilot_values of each tile; empty = the candidate's
    Cost cost{};                                // of following it
    std::function<bool()> stop{};               // says when time is up; a few tiles are followed anyway
    double enough_work = infinity;              // likewise, of the first drawing

    double all() const { return static_cast<double>(chances.chances.size()); } // tiles of the picture
    bool is_full() const { return drawings >= max_drawings || static_cast<double>(tiles.size()) >= all(); }
    bool can_grow(bool by_noise) const { return by_noise ? passes < max_passes : !is_full(); }
    double samples() const; // of pixels, that all passes together took
    double pixels() const;  // of the picture
    double truth_seconds() const { return cost.seconds / samples() * pixels(); } // per sample of the picture
};

// With one drawing; those of another `salt` are independent of it. `prepared` for the truth, where it is already.
Pilot make_pilot(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings* truth,
                 TileChances chances, uint32_t salt, const FrameOptions& options,
                 std::shared_ptr<const Prepared> prepared = {}, std::function<bool()> stop = {},
                 double enough_work = infinity);

// Draws tiles once more and follows the truth there; or follows it as often again on those there are.
void grow(Pilot& pilot, bool by_noise = false);

// A candidate on the tiles of a pilot; grows with it.
struct Look {
    const Mode& mode;
    const Settings& settings;
    std::shared_ptr<const Prepared> prepared{};
    const Snapshot* snapshot = nullptr; // null = the pilot's
    std::vector<vec3> values{};         // pilot_values of each tile seen
    int passes = 0;                     // their number
    double prepare_seconds = 0;
    Cost cost{};

    const Snapshot& of(const Pilot& pilot) const { return snapshot ? *snapshot : *pilot.snapshot; }
};

// With what is prepared already, where it is given. Follows the tiles not yet seen.
Measured measure(const Pilot& pilot, Look& look, const Seconds& clock);
Measured measure(const Pilot& pilot, const Mode& mode, const Settings& settings, const Seconds& clock);

// Samples of a pixel are spread better than independent ones: the variance of their mean falls as that of one, divided
// by n to this power, 1 to 2. Measured on means of eight.
double spread_power(const Pilot& pilot, const Mode& mode, const Settings& settings, const Prepared& prepared);

enum Product { of_integrator, of_sample, product_count };

// Of values on the pilot's tiles: the worse of colour and fog light.
SquaredError error_of(const Pilot& pilot, const std::vector<vec3>& truth, const std::vector<vec3>& own,
                      Product product);

// Of one layer: products of differences, as said above, summed over pixels.
struct Sums {
    double products[product_count] = {};
    double squares[product_count] = {}; // of the pixels' products
    double mean = 0, count = 0;

    void scale(double factor) {
        for (int k = 0; k < product_count; ++k) products[k] *= factor, squares[k] *= factor * factor;
        mean *= factor, count *= factor;
    }
};

// Of a tile. Pilot values of the truth and of a candidate; layer 0 = colour, 1 = fog light.
Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, size_t layer);

// Over the squared mean, from tiles that each stand for several. The bound is that of a sum of equal lumps that come by
// chance, as Wilson's (1927) for counts; with many lumps, a standard error (linearised ratio) times 1.96. A lump is the
// third moment over the variance.
SquaredError squared_error(std::span<const Sums> sums, std::span<const DrawnTile> tiles, Product product);
}
