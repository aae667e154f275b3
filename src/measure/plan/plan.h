// What a picture of a scene needs at an error or in a time: the terms of its light, and the mode that gets there.
#pragma once
#include "measure/plan/terms.h"
#include "render/adaptive/contest.h"
#include "render/adaptive/orders.h"

namespace tyndall {
// How one mode fared.
struct Standing {
    const Mode* mode = nullptr;
    std::optional<Contender> best{}; // of its candidates; none of a look
    std::string why;                 // it won or lost
};

struct Plan {
    Goal goal;
    std::vector<Term> terms;
    Settings settings; // without the terms that are not needed
    Contender chosen;
    std::optional<OrdersError> orders{}; // of the main mode's grid, where light scatters more than once
    std::vector<Standing> standings{};   // the winner first
    double terms_seconds = 0, contest_seconds = 0;

    double expected_error() const; // of the chosen mode, multiple scattering included

    // One line for headers: mode, candidate, errors and what was left out.
    std::string certificate() const;
};

// One of these modes, which must outlive it; path tracing where light that scatters more than once is to be nearer to
// the truth than the others bring it. Throws Error (internal) when cancelled. `view` is the picture's; settings
// are those of goal.quality but for rows set on purpose, which are kept. A plan may cost as much as it likes, or
// `share` of what the main mode would take or of the seconds there are: then terms are not measured and all are kept.
Plan make_plan(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
               Goal goal, const TermControl& control = {}, double share = infinity);

std::string plan_text(const Plan& plan);
}
