// A candidate chosen for a picture, and how it is rendered to an error.
#pragma once
#include "render/adaptive/allotment.h"
#include "render/adaptive/scout.h"

namespace tyndall {
struct Choice {
    Candidate candidate;
    Measured measured;
    bool has_integrator = false;             // otherwise noise is the only error
    bool is_truth = false;                   // the candidate is what pictures are held against
    double power = 1;                        // of the samples by which their variance falls
    double noise_ratio = 1;                  // its variance of one sample over that of the scout
    double pace = 1;                         // time of the whole picture over what the pilot made expect
    std::shared_ptr<const Scout> scout = {}; // null = there was no time for one
    std::shared_ptr<Pilot> pilot = {};       // the truth it was held against
    double scout_variance = 0;               // of one sample of the scout, on the pilot's tiles

    // How samples are best spread for an error or a number of rays; by the scout, which there must be.
    Allotment spread(const Enough& enough, int unit) const;

    // To render as many samples as get to an error, were the integrator's squared one as large as that: by default its
    // bound. Infinite where the error is out of reach.
    double work_to(double error, double squared_integrator) const;
    double work_to(double error) const { return work_to(error, measured.integrator.bound); }

    // How many times as many samples as have left so much noise get there.
    double times_to(double error, double squared_integrator, const Noise& noise) const;

    // The squared error to expect of so many samples per pixel, on the average.
    double expected(double samples) const;
};

// Share of the error wanted that the integrator may use up.
inline constexpr double integrator_share = 0.7;

// Whether a mode's choice was made beside other modes, by what the first image of the main one shows.
bool has_rivals(const Choice& choice, const Mode& mode);

// What a choice's integrator leaves of an error for noise; where it leaves nothing, noise need not be smaller than a
// tenth of it.
double noise_target(const Choice& choice, double error);

// Whether what samples do not remove leaves enough of the error wanted for noise.
bool leaves_room(const Choice& choice, double error);

// What a check of its integrator on a finished picture is likely to take (render/adaptive/goal.h: checked).
double check_seconds(const Choice& choice);
}
