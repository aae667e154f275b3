// What a picture is rendered until, and which candidate gets there.
#pragma once
#include "render/adaptive/choice.h"

namespace tyndall {
struct Goal {
    double error = 0;                       // as a share of the picture's mean; 0 = none is asked for
    double seconds = 0;                     // to measure, prepare and render in; 0 = as many as it takes
    Quality quality = Quality::preview;     // of the settings: rows that depart from it are kept
    Seconds clock{};                        // empty = steady_seconds
    std::shared_ptr<const Choice> choice{}; // made for this very picture beforehand; null = none is
    // What pictures are held against, where terms were left out because another frame did not need them, and rendered
    // where that does not get to the error; null = the settings rendered.
    std::shared_ptr<const Settings> wanted{};
    std::optional<OrdersError> orders{}; // measured for this very picture beforehand; none = it is not
    double other_work = infinity;        // of another mode to the error, which follows where this one misses it
};

// Of what a candidate rendered; each but the last may ask for a finer one.
inline constexpr uint32_t max_checks = 3;

// A picture to check, or a pilot of one that is to come.
struct CheckedPicture {
    const Layers& layers;       // show where errors may be
    const Noise& noise;         // of the picture
    double samples = 0;         // per pixel, for that noise
    double done = 0;            // so far
    bool may_begin_anew = true; // with a finer candidate
};

// How far light of several orders is off, where it is part of the image; the goal is left what that leaves of it.
std::optional<OrdersError> orders_beside(const Mode& mode, const View& view, const Snapshot& snapshot,
                                         const Settings& settings, Goal& goal, const FrameOptions& options);

// With an error asked for, the candidate that is likely to get there with least work, up to the first whose bound
// leaves enough for noise; or the finest; what comes before the first that gains nothing, where set rows keep
// candidates from getting finer. With seconds, the one whose picture will be best when they are over, `start` being
// when they began; with both, the first that reaches the error in time. Seconds make the choice depend on the machine.
Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options);

// What a finished picture's integrator leaves, on tiles that it says errors may be in, independent of those that the
// candidate was chosen by. Where that and the picture's noise are too much for the goal, a finer candidate may take its
// place: one that takes less work than more samples do. By the goal's clock, few tiles are looked at after `until`,
// where the goal has seconds.
Choice checked(const Choice& choice, const CheckedPicture& picture, double until, const Mode& mode, const View& view,
               const Snapshot& snapshot, const Settings& settings, const Goal& goal, uint32_t salt,
               const FrameOptions& options);
}
