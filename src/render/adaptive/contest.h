// A contest of modes on one image: which reaches a target error soonest, or is most accurate within a time limit.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
// A mode's candidate and the image it is predicted to render.
struct Contender {
    const Mode* mode = nullptr;
    Choice choice;
    double samples = 0; // per pixel, to reach the target error; infinite = out of reach
    double seconds = 0; // to prepare and render that image
    double done = 0;    // of these: what is prepared
    double risk = 0;    // expected extra seconds for the main mode's image, in case this one misses the target error
    double error = 0;   // predicted; if the target error is out of reach, the lowest possible

    bool reaches_goal() const { return samples < infinity; }
    double seconds_ahead() const { return std::max(seconds - done, 0.0) + risk; }
    // The error that samples do not remove.
    SquaredError integrator() const { return choice.has_integrator ? choice.measured.integrator : SquaredError{}; }
};

struct Contest {
    std::vector<Contender> contenders; // all that were measured, from coarse to fine for each mode
    size_t winner = 0;
    double seconds = 0; // taken by the contest

    const Contender& best() const { return contenders[winner]; }
};

// A mode's own choice, without a contest.
Contender sole_contender(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         const Goal& goal, const FrameOptions& options);

// Whether `a` is better for the goal: only `a` reaches it, or `a` does so sooner (including risk), or has the lower
// error.
bool beats(const Contender& a, const Contender& b, const Goal& goal);

// Measures the modes' candidates from coarse to fine against the main mode's ground truth, until finer ones of a mode
// can only lose. Artistic modes take no part. With a target error, the winner is the fastest that reaches it, or else
// the most accurate one; with a time limit only, the most accurate one within it. Times are predicted from a few
// pixels; without a time limit, also from a quick image by each candidate that may win. `view` is the image's;
// candidates are based on `settings`. Measuring the other modes may take `share` times the time limit or, without one,
// the main mode's predicted time (at most twenty times what measuring it took); each mode's coarsest candidate may take
// as much again, and so may the quick images. If measuring is predicted to take longer, no other mode is measured; if
// `share` is below a quarter, only those that are often fastest, unless the main mode misses the goal.
Contest hold_contest(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
                     const Goal& goal, double share, const FrameOptions& options);
}
