// What a picture is rendered until, and the candidate that gets there.
#pragma once
#include "render/adaptive/candidates.h"
#include "render/adaptive/pilot.h"

namespace tyndall {
struct Choice {
    Candidate candidate;
    Measured measured;
    bool has_integrator = false; // otherwise noise is the only error
    double power = 1;            // of the samples by which their variance falls
    double truth_seconds = 0;    // per sample of the picture, of the light held to be true; 0 = noise is the only error

    // The squared error to expect of so many samples per pixel.
    double expected(double samples) const;
};

struct Goal {
    double error = 0;                       // as a share of the picture's mean; 0 = none is asked for
    double seconds = 0;                     // to measure, prepare and render in; 0 = as many as it takes
    Quality quality = Quality::preview;     // of the settings: rows that depart from it are kept
    Seconds clock{};                        // empty = steady_seconds
    std::shared_ptr<const Choice> choice{}; // made for this very picture beforehand; null = none is
    // What pictures are held against, where terms were left out because another frame did not need them, and rendered
    // where that does not get to the error; null = the settings rendered.
    std::shared_ptr<const Settings> wanted{};
};

// Share of the error wanted that the integrator may use up.
inline constexpr double integrator_share = 0.7;

// With an error asked for, the first candidate whose bound leaves enough for noise, or the finest; what comes before
// the first that gains nothing, where set rows keep candidates from getting finer. With seconds, the one whose picture
// will be best when they are over, `start` being when they began; with both, the first that reaches the error in time.
// Seconds make the choice depend on the machine.
Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options);
}
