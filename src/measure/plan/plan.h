// Plans an image for a target error or a time budget: the lighting terms it needs, and the mode to render it.
#pragma once
#include "measure/plan/terms.h"
#include "render/adaptive/contest.h"
#include "render/adaptive/errors/orders.h"

namespace tyndall {
// How one mode did in the contest.
struct Standing {
    const Mode* mode = nullptr;
    std::optional<Contender> best{}; // of its candidates; none for artistic modes
    std::string why;                 // it lost; empty for the winner
};

struct Plan {
    Goal goal;
    std::vector<Term> terms;
    Settings settings; // without the terms that are not needed
    Contender chosen;
    std::optional<OrdersError> orders{}; // of the main mode's grid, with multiple scattering
    std::vector<Standing> standings{};   // the winner first
    double terms_seconds = 0, contest_seconds = 0;

    double expected_error() const; // of the chosen mode, multiple scattering included

    // One line for headers: mode, candidate, errors and what was left out.
    std::string certificate() const;
};

// Chooses one of `modes`, which must outlive the plan; path tracing if multiple scattering has to be more accurate than
// the other modes can be. `view` is the image's; `settings` are those of goal.quality, except for rows set on purpose,
// which are kept. Planning may take `share` times the time limit or, without one, the main mode's predicted time; with
// a finite `share`, terms are not measured and all are kept. Throws Error (internal) when cancelled.
Plan make_plan(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
               Goal goal, const TermControl& control = {}, double share = infinity);

std::string plan_text(const Plan& plan);
}
