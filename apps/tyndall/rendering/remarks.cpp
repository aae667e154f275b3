#include "rendering/remarks.h"

#include "base/error.h"
#include "base/io/frames.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/adaptive/errors/orders.h"
#include "render/adaptive/goal.h"
#include "render/parts/manifest.h"
#include "render/sequence/sequence.h"
#include "scene/scene.h"
#include "trace/lights/enclosed_lights.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
namespace {
// Adds the measured error of multiple scattering, except for an image rendered to a goal, which accounts for it.
void add_orders(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, const Snapshot& snapshot,
                Limitations& limitations) {
    if (has_goal(request) || is_part(request.grouping) || !takes_fluence(*plan.mode, plan.settings)) return;
    const View view = view_of(scene, request, plan.settings, request.frames[0]);
    const FrameOptions options{false, nullptr, &cancel_flag(), {}, {}};
    limitations.push_back(limitation_of(orders_error(*plan.mode, view, snapshot, plan.settings, 0, options)));
}
}

Limitations limitations_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan,
                           const Snapshot& snapshot, bool measured) {
    const View view = view_of(scene, request, plan.settings, snapshot.frame);
    Limitations limitations =
        plan.mode->limitations(view, snapshot, plan.choice ? plan.choice->candidate.settings : plan.settings);
    if (measured) add_orders(scene, request, plan, snapshot, limitations);
    return limitations;
}

void say_rounding(const RenderRequest& request, const Globals& globals) {
    if (!globals.quiet && request.target_error > 0 && request.target_error < 1e-3 && !request.exr.full_float)
        say("note: 16-bit floats round by up to 0.0005 of a value: add --float");
}

namespace {
// Prints warnings about the files, then the mode's limitations; those of severity info only when verbose.
void say_limitations(const Scene& scene, const Snapshot& first, const Limitations& limitations,
                     const Globals& globals) {
    if (globals.quiet) return;
    if (globals.verbose)
        for (const auto& input : scene.inputs) say("reads " + printable(input.path.string(), 460));
    for (const std::string& warning : scene.warnings) say("warning: " + printable(warning, 460));
    for (const std::string& line : enclosed_lights(first)) say("warning: " + printable(line, 460));
    for (const LimitationGroup& group : groups_of(limitations))
        if (globals.verbose || group.worst.severity != Severity::info) say(line_of(group));
}

// Settings that the mode does not read.
void say_idle_settings(const std::vector<std::string>& settings, const Mode& mode, const Globals& globals) {
    if (globals.quiet) return;
    for (const std::string& setting : settings)
        if (!reads(mode, setting.substr(0, setting.find('='))))
            say("note: " + printable(setting, 60) + " has no effect in mode " + std::string(mode.name));
}
}

void say_before(const Scene& scene, const Snapshot& first, const Limitations& limitations,
                const std::vector<std::string>& settings, const RenderRequest& request, const Mode& mode,
                const Globals& globals) {
    say_idle_settings(settings, mode, globals);
    if (request.history > 0 && !mode.uses_history && !globals.quiet)
        say("note: --history has no effect: " + std::string(mode.name) + " does not use earlier frames");
    if (request.time_samples > 0 && !first.moments && !globals.quiet)
        say("note: --time-samples has no effect: the shutter is closed, or nothing moves while it is open");
    say_limitations(scene, first, limitations, globals);
}

void say_files_found(const RenderRequest& request, const Globals& globals) {
    if (!request.files || !globals.verbose || globals.quiet) return;
    for (const CacheCost& cost : request.files->costs)
        if (cost.kind == CostKind::found)
            say("found " + printable(cost.file, 200) + formatted(", which took %.3f s to compute", cost.seconds));
}

void say_summary(const RenderReport& report, const RenderRequest& request) {
    int kept = 0;
    for (const FrameReport& frame : report.frames) kept += frame.kept;
    const int rendered = static_cast<int>(report.frames.size()) - kept;
    const double seconds = report.loading + report.seconds;
    std::string line = count_text(rendered, "frame") + " rendered in " + seconds_text(seconds);
    if (rendered > 1) line += " (" + seconds_text(seconds / rendered) + " per frame)";
    if (kept > 0) line += formatted(", %d kept", kept);
    say(line + ", " + printable(request.output));
}

void say_look(const RenderRequest& request) {
    const std::string first = request.frames.empty() ? request.output : frame_name(request.output, request.frames[0]);
    if (request.png)
        say("to view: " + printable(std::filesystem::path(first).replace_extension(".png").string()));
    else
        say("hint: add --png for images that any program shows; the .exr opens in tev, Blender, Nuke and others");
}
}
