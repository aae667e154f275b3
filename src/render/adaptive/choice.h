// The candidate chosen for an image, and predictions of the work it takes to reach an error.
#pragma once
#include "render/adaptive/allotment.h"
#include "render/adaptive/scout.h"

namespace tyndall {
struct Choice {
    Candidate candidate;
    Measurement measured;
    bool has_integrator = false;             // otherwise noise is the only error
    bool is_truth = false;                   // the candidate is itself the ground truth
    double power = 1;                        // the variance of a mean of n samples falls as n^-power
    double noise_ratio = 1;                  // variance of one sample, relative to the scout's
    double pace = 1;                         // measured time of the whole image over the pilot's prediction
    std::shared_ptr<const Scout> scout = {}; // null = there was no time for one
    bool from_contest = false;               // another mode's, measured beside the main one, whose scout it has
    std::shared_ptr<Pilot> pilot = {};       // the ground truth it was measured against
    double scout_variance = 0;               // of one sample of the scout, on the pilot's tiles

    // The best allotment for an error or a number of rays. Requires a scout.
    Allotment spread(const AllotLimits& limits, int unit) const;

    // Work to reach an error if the integrator's squared error is `squared_integrator`, by default its bound. Infinite
    // if the error is out of reach.
    double work_to(double error, double squared_integrator) const;
    double work_to(double error) const { return work_to(error, measured.integrator.bound); }

    // Factor by which the samples that left `noise` have to grow to reach the error.
    double times_to(double error, double squared_integrator, const Noise& noise) const;

    // Expected squared error with `samples` per pixel on average.
    double expected(double samples) const;
};

// Largest share of the target error that the integrator may take up.
inline constexpr double integrator_share = 0.7;

// Noise that may remain beside the integrator's error. If that alone exceeds the target: the larger of integrator_share
// of the target and a tenth of the integrator's error.
double noise_target(const Choice& choice, double error);

// Whether the integrator's error leaves enough of the target error for noise.
bool leaves_room(const Choice& choice, double error);

// Predicted seconds to check the integrator on a finished image (render/adaptive/check.h).
double check_seconds(const Choice& choice);
}
