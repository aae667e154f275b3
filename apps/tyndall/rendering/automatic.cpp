#include "rendering/automatic.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "modes/mode.h"
#include "render/sequence/provenance.h"

namespace tyndall {
namespace {
// Time for planning: a share of what all frames would take without a plan, or of their time budget; without a budget,
// at least a share of what one frame would take.
constexpr double planning_share = 0.05, planning_share_of_one = 0.2;

// The mode of an existing first frame that --mode auto has rendered to the same goal; null if there is none.
const Mode* mode_before(const RenderRequest& request) {
    const std::string file = frame_name(request.output, request.frames[0]);
    if (!request.resume || !std::filesystem::exists(file)) return nullptr;
    std::map<std::string, std::string> attributes;
    try {
        attributes = read_exr(file).attributes;
    } catch (const Error&) {
        return nullptr; // it will be rendered again
    }
    const auto number = [&](const char* name) { return std::strtod(attributes[name].c_str(), nullptr); };
    if (attributes["tyndall:plan"].empty()) return nullptr;
    if (std::abs(number("tyndall:targetError") - request.target_error) > 1e-9) return nullptr;
    if (std::abs(number("tyndall:timeBudget") - request.time_budget) > 1e-9) return nullptr;
    const bool missed = attributes.contains("tyndall:plannedMode");
    const auto found =
        std::ranges::find(modes(), attributes[missed ? "tyndall:plannedMode" : "tyndall:mode"], &Mode::name);
    return found == modes().end() ? nullptr : &*found;
}
}

double default_error(Quality quality) {
    constexpr double errors[] = {0.1, 0.05, 0.02, 0.005};
    return errors[static_cast<size_t>(quality)];
}

RenderPlan chosen_plan(const Scene& scene, const RenderRequest& request, const Snapshot& first,
                       const Globals& globals) {
    const Mode* before = mode_before(request);
    Progress progress(globals.progress, "plan", 1, globals.json);
    const TermControl control{&cancel_flag(), [&](double share) { progress.set(share); }};
    const View view = view_of(scene, request, request.settings, request.frames[0]);
    double seconds = request.time_budget;
    if (seconds > 0) seconds = std::max(request.started + seconds - steady_seconds(), 1e-3);
    const Goal goal{request.target_error, seconds, request.quality};
    double share = planning_share * static_cast<double>(request.frames.size());
    if (seconds == 0) share = std::max(share, planning_share_of_one);
    const auto plan_with = [&](std::span<const Mode> candidates) {
        return make_plan(candidates, view, first, request.settings, goal, control, share);
    };
    Plan plan = plan_with(before ? std::span(before, 1) : modes());
    if (before && !plan.chosen.reaches_goal()) plan = plan_with(modes()); // the scene has changed since
    progress.finish();
    RenderPlan result{plan.chosen.mode,
                      plan.settings,
                      plan.certificate(),
                      std::make_shared<const Choice>(plan.chosen.choice),
                      std::make_shared<const Settings>(request.settings),
                      plan.chosen.mode == &main_mode() ? plan.orders : std::nullopt};
    for (const Standing& standing : plan.standings)
        if (standing.mode == &main_mode() && standing.mode != plan.chosen.mode && standing.best) {
            result.main = std::make_shared<const Choice>(standing.best->choice);
            result.main_seconds = standing.best->seconds;
        }
    if (globals.quiet) return result;
    say("plan: " + printable(result.certificate, 460));
    if (globals.verbose) say(plan_text(plan));
    return result;
}
}
