// Measures a mode's candidates for an image against the ground truth.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
// Inputs for choosing among a mode's candidates.
struct Chooser {
    const Mode& mode;
    const View& view;
    const Snapshot& snapshot;
    const Settings& settings;
    const Goal& goal;
    const FrameOptions& options;
    std::vector<Candidate> candidates = candidates_of(mode, settings, goal.quality);
    bool systematic = has_integrator(mode);
    Settings truth = systematic ? truth_settings(goal.wanted ? *goal.wanted : settings) : settings;

    // `work`: of the image that the pilot is for.
    std::shared_ptr<Pilot> pilot(TileChances chances, uint32_t salt, std::shared_ptr<const Prepared> ready,
                                 std::function<bool()> stop, double work) const;

    // Predicted work to reach the error with the scout's candidate if that had no integration error.
    double work_ahead(const Scout& scout) const;

    PilotRun start_run(const Candidate& candidate, const Scout* scout) const;

    // Measures a candidate. `before` is one already measured, if any: its variance power and pace are reused.
    Choice choice(const Candidate& candidate, PilotRun& run, std::shared_ptr<Pilot> pilot, const Choice* before,
                  std::shared_ptr<const Scout> scout) const;
};

// Whether measuring an integrator's error further is likely to cost less than it saves of `least`, the work otherwise
// needed. Repeating the measurement so far costs `again`; `to_goal` is the remaining work for a given squared error. If
// the uncertainty is due to noise, bound - value falls as 1 / passes, since means over passes are multiplied; if it is
// due to few tiles, it falls like a standard error. The value itself may turn out smaller: a measurement that could
// save many times its cost is worthwhile.
bool worth_seeing(const SquaredError& integrator, const Pilot& pilot, double least, double again,
                  const std::function<double(double)>& to_goal);
}
