// The goal of a rendering, a target error or a time limit, and the choice of a candidate that reaches it.
#pragma once
#include "render/adaptive/choice.h"

namespace tyndall {
struct Goal {
    double error = 0;                       // target, relative to the image's mean; 0 = none
    double seconds = 0;                     // time limit, including measuring and preparing; 0 = none
    Quality quality = Quality::preview;     // of the settings; rows that differ from its defaults are kept
    Seconds clock{};                        // empty = steady_seconds
    std::shared_ptr<const Choice> choice{}; // already made for this image; null = not yet
    // The settings before terms were dropped that another frame does not need: they define the ground truth, and are
    // rendered if the error cannot be reached without those terms. Null = none were dropped.
    std::shared_ptr<const Settings> wanted{};
    std::optional<OrdersError> orders{}; // already measured for this image; none = not yet
    // Of the mode that renders the image again if this one misses the error.
    double other_work = infinity, other_seconds = infinity;
    int moment_limit = 0; // that the frame may have if it is loaded again; 0 = no more than it has
};

// orders_error() for a goal, within a share of its time limit.
OrdersError orders_error_for(const Goal& goal, const Mode& mode, const View& view, const Snapshot& snapshot,
                             const Settings& settings, const FrameOptions& options);

// Error of multiple scattering from a grid, if it is part of the image; reduces goal.error to what that leaves.
std::optional<OrdersError> measure_orders(const Mode& mode, const View& view, const Snapshot& snapshot,
                                          const Settings& settings, Goal& goal, const FrameOptions& options);

// With a target error: the candidate that is likely to reach it with the least work, up to the first whose bound leaves
// enough for noise; or the finest; if the settings keep candidates from getting finer, only those before the first that
// gains nothing. With a time limit: the one whose image will be most accurate when the time is up, counted from
// `start`; with both, the first that reaches the error in time. A time limit makes the choice depend on the machine.
Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options);
}
