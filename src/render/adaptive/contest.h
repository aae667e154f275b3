// All modes against each other on one picture: which gets to an error soonest, or closest to the truth in a time.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
// A candidate of a mode, and the picture it would make.
struct Contender {
    const Mode* mode = nullptr;
    Choice choice;
    double samples = 0; // per pixel, to get to the error asked for; infinite where it cannot get there
    double seconds = 0; // to prepare and render that picture
    double risk = 0;    // expected seconds of the main mode's picture, should this one miss the error after all
    double error = 0;   // of it; where the error asked for is out of reach, what endless samples leave

    bool gets_there() const { return samples < infinity; }
    // What samples do not remove.
    SquaredError integrator() const { return choice.has_integrator ? choice.measured.integrator : SquaredError{}; }
};

struct Contest {
    std::vector<Contender> contenders; // all that were measured, of each mode from coarse to fine
    size_t winner = 0;
    double seconds = 0; // it took

    const Contender& best() const { return contenders[winner]; }
};

// A mode's own choice, with nothing beside it.
Contender measured_alone(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         const Goal& goal, const FrameOptions& options);

// Whether a is the better way to a goal: it gets there, sooner (risk included), or comes closer.
bool beats(const Contender& a, const Contender& b, const Goal& goal);

// Measures candidates of modes from coarse to fine, until finer ones of a mode can only lose, against the truth that
// the main mode's choice is held against. Artistic modes take no part. With an error asked for, the winner is the
// quickest that gets there, else the most accurate one; with seconds only, the most accurate in that time. Seconds are
// predicted from a few pixels. `view` is the picture's; candidates are made from `settings`. What the main mode would
// take, or the seconds there are, times `share` is the time that the others may take to be measured; the coarsest of
// each mode may take as much again. No other mode is measured where that is likely to take longer.
Contest hold_contest(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
                     const Goal& goal, double share, const FrameOptions& options);
}
