#include "measure/plan/plan.h"

#include "base/text.h"
#include "modes/mode.h"
#include "modes/shared_limitations.h"
#include "render/adaptive/to_target.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
// Noise at pixel centers, which excludes that of edges: what a history of earlier frames could smooth.
Term history_term(const View& view, const Snapshot& snapshot, const Contender& chosen, double error,
                  const TermControl& control) {
    Term term{"earlier frames", "", "left out"};
    View centers = view;
    centers.filter = PixelFilter::center;
    const Settings& settings = chosen.choice.candidate.settings;
    const FrameOptions options{false, nullptr, control.cancel, {}, {}};
    const Pilot pilot =
        make_pilot(*chosen.mode, centers, snapshot, nullptr, uniform_chances(centers, snapshot), 0, options);
    const Measurement measured = measure(pilot, *chosen.mode, settings, steady_seconds);
    const double samples = std::max(1.0, std::min(chosen.samples, 1.0 * max_target_samples));
    term.error = std::sqrt(measured.sample.value / samples), term.bound = std::sqrt(measured.sample.bound / samples);
    term.needed = term.bound > error;
    term.why = percent_text(term.error) + " noise in the fog with " + formatted("%.0f", samples) +
               (samples < 2 ? " sample" : " samples") + " per pixel";
    return term;
}

// The worst limitations that may explain a mode's error; single scattering does not, since the reference has it too.
std::optional<LimitationGroup> worst_of(const Limitations& limitations) {
    std::optional<LimitationGroup> worst;
    for (const LimitationGroup& group : groups_of(limitations))
        if (!group.worst.is(limitation::single_scattering_only) && group.worst.severity != Severity::info &&
            (!worst || group.worst.severity > worst->worst.severity))
            worst = group;
    return worst;
}

// Why a mode that was measured lost, given its best candidate and the winner.
std::string loss(const Contender& best, const Contender& winner, const Goal& goal, const Limitations& limitations) {
    if (best.reaches_goal() && goal.error > 0) {
        const double ratio = best.seconds / winner.seconds;
        if (ratio < 1 && best.risk == 0)
            return "reaches the target in " + seconds_text(best.seconds) +
                   "; part of the chosen image is rendered already";
        if (ratio < 1 && best.risk > 0) return "may reach the target in " + seconds_text(best.seconds) + ", or miss it";
        return "reaches the target in " + seconds_text(best.seconds) +
               (ratio < 1.1 ? ", about as long" : formatted(", %.*f times as long", ratio < 10 ? 1 : 0, ratio));
    }
    std::string text =
        goal.error > 0 ? "error stays at " + percent_text(best.error) : percent_text(best.error) + " error";
    if (goal.error > 0 && !best.reaches_goal() && best.error < goal.error)
        text = "too noisy: needs more than " + formatted("%.0f", 1.0 * max_target_samples) + " samples per pixel";
    if (!best.reaches_goal() && goal.seconds > 0 && best.seconds > goal.seconds)
        text += ", in " + seconds_text(best.seconds) + " at least";
    if (const auto worst = worst_of(limitations)) text += "; " + where_of(*worst) + ": " + sentence_of(worst->worst);
    return text;
}

// Each mode with its best contender, from best to worst.
std::vector<Standing> standings_of(std::span<const Mode> modes, const Contest& contest, const View& view,
                                   const Snapshot& snapshot, const Goal& goal, bool many_orders) {
    std::vector<Standing> standings;
    const Contender& winner = contest.best();
    for (const Mode& mode : modes) {
        Standing standing{&mode, {}, "artistic: no error bound"};
        if (mode.accuracy == Accuracy::multiple_scattering && !many_orders && max_component(snapshot.ambient) > 0)
            standing.why = "not tried: it shadows ambient light, which the reference does not";
        else if (mode.accuracy == Accuracy::multiple_scattering)
            standing.why =
                many_orders ? "not tried: multiple scattering from a grid is close enough"
                            : "not tried: errors here are of single scattering, and it traces all orders (--mode path)";
        else if (mode.accuracy != Accuracy::artistic)
            standing.why = contest.best().mode->accuracy == Accuracy::multiple_scattering
                               ? "not tried: its multiple scattering misses the target error"
                           : many_orders && !mode.adds_fluence
                               ? "not tried: it has no multiple scattering, which was requested"
                               : "not tried: the search was short";
        for (const Contender& contender : contest.contenders)
            if (contender.mode == &mode && (!standing.best || beats(contender, *standing.best, goal)))
                standing.best = contender;
        if (standing.best) {
            const Limitations limitations = mode.limitations(view, snapshot, standing.best->choice.candidate.settings);
            standing.why = &mode == winner.mode ? "" : loss(*standing.best, winner, goal, limitations);
        }
        standings.push_back(std::move(standing));
    }
    std::ranges::stable_sort(standings, [&](const Standing& a, const Standing& b) {
        if (!a.best || !b.best) return a.best.has_value() > b.best.has_value();
        return beats(*a.best, *b.best, goal);
    });
    return standings;
}
}

namespace {
// A contest of the modes that take multiple scattering from a grid and, if that is too inaccurate, path tracing.
Contest contest_of_orders(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, Plan& plan,
                          const Goal& goal, double share, const FrameOptions& options) {
    const double start = goal.clock();
    plan.orders = orders_error_for(goal, main_mode(), view, snapshot, plan.settings, options);
    Settings traced = plan.settings;
    traced.path.orders = plan.settings.fluence.orders;
    const auto path = [&] { return sole_contender(mode_of_all_orders(), view, snapshot, traced, goal, options); };
    Contest contest;
    Goal beside = goal;
    if (goal.error > 0) {
        const std::optional<double> left = remaining_error(plan.orders->pixels, goal.error);
        if (!left) contest.contenders.push_back(path());
        beside.error = left.value_or(goal.error);
    }
    if (contest.contenders.empty())
        contest = hold_contest(modes, view, snapshot, plan.settings, beside, share, options);
    if (goal.error == 0) {
        contest.contenders.push_back(path());
        // The uncertainty of the grid's error counts against it.
        const double grid = std::max(plan.orders->pixels.error, 0.5 * plan.orders->pixels.bound);
        if (contest.contenders.back().error < std::hypot(contest.best().error, grid))
            contest.winner = contest.contenders.size() - 1;
    }
    contest.seconds = goal.clock() - start;
    if (contest.best().mode == &mode_of_all_orders()) plan.settings = traced;
    return contest;
}
}

Plan make_plan(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
               Goal goal, const TermControl& control, double share) {
    if (!goal.clock) goal.clock = steady_seconds;
    Plan plan{goal, {}, settings, {}, {}};
    const auto part = [&](double from, double to) {
        return [&control, from, to](double done) {
            if (control.progress) control.progress(from + (to - from) * done);
        };
    };
    const double start = goal.clock();
    const double wanted = goal.error > 0 ? goal.error : 0.02; // target error for terms when only time is limited
    if (share == infinity) plan.terms = terms_of(view, snapshot, settings, wanted, {control.cancel, part(0, 0.4)});
    plan.settings = drop_unneeded(plan.terms, settings);
    const bool path_is_free = settings.path.orders == settings_for(goal.quality).path.orders;
    if (plan.settings.fluence.orders < 2 && path_is_free)
        plan.settings.path.orders = 1; // single scattering, as in all others
    plan.terms_seconds = goal.clock() - start;

    const FrameOptions options{false, nullptr, control.cancel, part(0.4, 0.9), {}};
    if (share == infinity) goal.wanted = std::make_shared<const Settings>(settings);
    const bool many_orders = plan.settings.fluence.orders > 1;
    Contest contest = many_orders ? contest_of_orders(modes, view, snapshot, plan, goal, share, options)
                                  : hold_contest(modes, view, snapshot, plan.settings, goal, share, options);
    plan.chosen = contest.best(), plan.contest_seconds = contest.seconds;
    plan.standings = standings_of(modes, contest, view, snapshot, goal, many_orders);
    if (share == infinity && !snapshot.media.empty())
        plan.terms.push_back(history_term(view, snapshot, plan.chosen, wanted, control));
    part(0.9, 1)(1);
    return plan;
}

double Plan::expected_error() const {
    return orders && takes_fluence(*chosen.mode, settings) ? std::hypot(chosen.error, orders->pixels.error)
                                                           : chosen.error;
}

std::string Plan::certificate() const {
    std::string text = std::string(chosen.mode->name);
    if (!chosen.choice.candidate.name.empty()) text += " (" + chosen.choice.candidate.name + ")";
    text += ": error " + percent_text(expected_error()) + (chosen.reaches_goal() ? " expected" : " at best");
    if (goal.error > 0) text += ", target " + percent_text(goal.error);
    if (goal.seconds > 0) text += ", in " + seconds_text(goal.seconds);
    std::string left_out;
    for (const Term& term : terms)
        if (!term.needed && term.bound > 0)
            left_out += (left_out.empty() ? "" : ", ") + term.name + (term.where.empty() ? "" : " of " + term.where) +
                        " (" + term.simpler + ": at most " + percent_text(term.bound) +
                        (term.rigorous ? " for certain)" : ")");
    if (orders)
        text += "; multiple scattering from a grid differs by " + percent_text(orders->pixels.error) + " (at most " +
                percent_text(orders->pixels.bound) + ") from path tracing";
    return text + (left_out.empty() ? "" : "; not needed: " + left_out);
}

std::string plan_text(const Plan& plan) {
    std::string text = "terms of the light                                without it\n";
    for (const Term& term : plan.terms) {
        const std::string name = term.name + (term.where.empty() ? "" : " of " + term.where);
        text += formatted("  %-6s  %-38.38s  %-10s  %s\n", term.needed ? "needed" : "-", name.c_str(),
                          term.simpler.c_str(), term.why.c_str());
    }
    text += "\nmodes\n";
    for (const Standing& standing : plan.standings) {
        const std::string name(standing.mode->name);
        if (standing.mode == plan.chosen.mode) {
            const Contender& best = plan.chosen;
            text += formatted("  %-14s %s: %s in %s", name.c_str(), best.reaches_goal() ? "chosen" : "comes closest",
                              percent_text(plan.expected_error()).c_str(), seconds_text(best.seconds).c_str());
            if (best.reaches_goal())
                text += formatted(", %.0f %s per pixel", best.samples, best.samples < 2 ? "sample" : "samples");
            text += (best.choice.candidate.name.empty() ? "" : ", " + best.choice.candidate.name) + "\n";
        } else {
            text += "  " + name + std::string(15 - std::min<size_t>(14, name.size()), ' ') + standing.why + "\n";
        }
    }
    return text;
}
}
