// tyndall plan: finds which lighting terms a scene needs, and which mode reaches a target error or makes the best of a
// time budget.
#include "measure/plan/plan.h"

#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/adaptive/errors/orders.h"
#include "render/adaptive/planned.h"
#include "render/parts/plan_file.h"
#include "render/sequence/provenance.h"
#include "render/sequence/sequence.h"
#include "rendering/automatic.h"
#include "rendering/plan_as_asked.h"
#include "rendering/render_options.h"
#include "scene/input_files.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
struct Options {
    RenderOptions render; // those shared with tyndall render
    std::string frame, save, groups;
};

Json term_json(const Term& term) {
    return json_object({{"name", term.name},
                        {"where", term.where},
                        {"simpler", term.simpler},
                        {"needed", term.needed},
                        {"error", term.error},
                        {"bound", term.bound},
                        {"rigorous", term.rigorous},
                        {"why", term.why}});
}

Json standing_json(const Standing& standing) {
    JsonMembers members{{"mode", standing.mode->name}, {"why", standing.why}};
    if (const auto& best = standing.best) {
        const Measurement& measured = best->choice.measured;
        members.emplace_back("candidate", std::string_view(best->choice.candidate.name));
        members.emplace_back("gets_there", best->reaches_goal());
        members.emplace_back("samples", best->samples);
        members.emplace_back("seconds", best->seconds);
        members.emplace_back("error", best->error);
        members.emplace_back("integrator_error", std::sqrt(measured.integrator.value));
        members.emplace_back("integrator_bound", std::sqrt(measured.integrator.bound));
        members.emplace_back("prepare_seconds", measured.prepare_seconds);
        members.emplace_back("sample_seconds", measured.sample_seconds);
    }
    return json_object(std::move(members));
}

std::string plan_json(const Plan& plan, const RenderRequest& request) {
    return json_line({{"version", TYNDALL_VERSION},
                      {"scene", request.scene_file.string()},
                      {"frame", request.frames[0]},
                      {"target_error", plan.goal.error},
                      {"time_budget", plan.goal.seconds},
                      {"mode", plan.chosen.mode->name},
                      {"certificate", plan.certificate()},
                      {"terms", json_list(plan.terms, term_json)},
                      {"modes", json_list(plan.standings, standing_json)},
                      {"terms_seconds", plan.terms_seconds},
                      {"contest_seconds", plan.contest_seconds}});
}

// How to render what was planned: all frames of the scene unless one was asked for.
std::string command_of(const Plan& plan, const RenderRequest& request, bool one_frame) {
    const bool again = plan.settings.fluence.orders > 1;
    std::string text = "tyndall render " + quoted_for_shell(request.scene_file.string()) + " -o out.####.exr --mode " +
                       std::string(again ? automatic : plan.chosen.mode->name);
    if (plan.goal.quality != Quality::preview) text += " --quality " + std::string(name_of(plan.goal.quality));
    if (one_frame) text += formatted(" --frames %d", request.frames[0]);
    if (!request.camera.empty()) text += " --camera " + quoted_for_shell(request.camera);
    if (request.resolution.x > 0) text += formatted(" --res %dx%d", request.resolution.x, request.resolution.y);
    if (plan.goal.error > 0) text += formatted(" --target-error %g", plan.goal.error);
    if (plan.goal.seconds > 0) text += formatted(" --time-budget %g", plan.goal.seconds);
    const int orders = plan.settings.fluence.orders;
    if (again) text += " --orders " + (orders == all_orders ? "all" : std::to_string(orders));
    const bool path = plan.chosen.mode->accuracy == Accuracy::multiple_scattering;
    for (const SettingRow& row : setting_rows())
        if (row.name != "fluence.orders" && (path || row.name != "path.orders") &&
            row.get(plan.settings) != row.get(settings_for(plan.goal.quality)))
            text += " --set " + row.name + "=" + row.get(plan.settings);
    return text;
}

// The sample counts that the target error takes, measured on the first frame; and in the request the number of moments,
// if the first frame has too few for it.
PlannedSamples counted(const Scene& scene, RenderRequest& request, const RenderPlan& plan, int groups,
                       const Globals& globals) {
    Goal goal{request.target_error, 0, request.quality, {}, plan.choice};
    goal.moment_limit = moment_limit(scene, request, request.frames[0]);
    const FrameOptions options{false, nullptr, &cancel_flag(), {}, {}};
    while (true) {
        const Snapshot snapshot = load_first_frame(scene, request).snapshot;
        View view = view_of(scene, request, plan.settings, request.frames[0]);
        view.batches = groups;
        PlannedSamples planned = plan_samples(*plan.mode, view, snapshot, plan.settings, goal, options);
        if (planned.wanted_moments == 0) return planned;
        request.time_samples = planned.wanted_moments, goal.choice = nullptr; // prepared for fewer
        if (!globals.quiet)
            say(formatted("frame %d needs %d time samples for the target error; all frames get as many",
                          request.frames[0], request.time_samples));
    }
}

// The error in the first frame that more samples do not reduce.
PlannedError first_frame_error(const Scene& scene, const RenderRequest& request, const RenderPlan& plan) {
    const Snapshot snapshot = load_first_frame(scene, request).snapshot;
    const View view = view_of(scene, request, plan.settings, request.frames[0]);
    return systematic_error(*plan.mode, view, snapshot, plan.settings, {false, nullptr, &cancel_flag(), {}, {}});
}

// Saves the plan as a file for tyndall render --plan.
int save(const std::string& file, const Scene& scene, const RenderRequest& asked, RenderPlan plan, int groups,
         const Globals& globals) {
    RenderRequest request = asked;
    if (request.frames.empty()) request.frames = frames_between(scene.first_frame, scene.last_frame);
    int& samples = plan.settings.pixel.samples;
    const int wanted = samples;
    if (request.target_error > 0) {
        const PlannedSamples planned = counted(scene, request, plan, groups, globals);
        plan.settings = planned.settings, samples = groups;
        request.grouping.groups = groups, request.grouping.leaves = leaves_for(groups, planned.samples);
        request.grouping.counts = planned.counts;
        request.grouping.error = planned.error;
        if (!globals.quiet)
            say(formatted("frame %d needs %.3g samples per pixel, in one run about ", request.frames[0],
                          planned.samples) +
                seconds_text(planned.seconds) + " on this machine");
    } else {
        request.grouping = grouping_of(samples, groups);
        request.grouping.error = first_frame_error(scene, request, plan);
    }
    drop_absent_layers(scene, plan, request);
    const int most = request.grouping.groups * (wants_layer(request, "halves") ? 1 : request.grouping.sections);
    if (measures_noise(request) && most < 2)
        fail(ExitCode::usage, "--aov", "variance and halves need at least two samples per pixel");
    check_crop(request, request.resolution.x > 0 ? request.resolution : scene.resolution);
    save_plan(file, scene, {request, plan, {}, build_name()});
    const std::optional<Integrator>& integrator = request.grouping.error.integrator;
    if (request.target_error > 0 && integrator && integrator->error.bound >= request.target_error)
        fail(ExitCode::differs, request.scene_file.string(),
             formatted("%s was written, but the mode's own error is %.3g, at most %.3g: more samples do not help",
                       printable(file, 100).c_str(), integrator->error.error, integrator->error.bound));
    if (globals.quiet) return 0;
    if (samples != wanted && !request.grouping.counts)
        say(formatted("note: %d camera rays per pixel instead of %d: they come in %d equal %s", samples, wanted,
                      request.grouping.groups * request.grouping.sections,
                      request.grouping.groups > 1 ? "groups" : "sections"));
    say(printable(file) + ": " + count_text(request.frames.size(), "frame") + " by " + std::string(plan.mode->name) +
        ", samples in " + count_text(static_cast<uint64_t>(request.grouping.groups), "group") +
        formatted(" of %d leaves", request.grouping.sections * request.grouping.leaves));
    return 0;
}

// Throws Error (usage) for options that would make a saved plan's images depend on anything but the plan.
void check_saved(const Options& args) {
    if (!args.frame.empty())
        fail(ExitCode::usage, "--frame", "cannot be combined with --save, which measures the first of --frames");
    if (!args.render.time_budget.empty())
        fail(ExitCode::usage, "--time-budget", "a saved plan cannot depend on time: use --samples");
    if (!args.render.history.empty())
        fail(ExitCode::usage, "--history", "planned frames are rendered independently, without earlier frames");
}

int groups_option(const Options& args) {
    const bool target = !args.render.target_error.empty() || args.render.mode == automatic;
    const bool halves = std::ranges::count(comma_list(args.render.aov), "halves") > 0;
    const int fewest = target || halves ? 2 : 1;
    if (args.groups.empty()) return target ? groups_for_target : halves ? fewest : default_groups;
    const int groups = static_cast<int>(integer_option("--groups", args.groups, 1, max_groups));
    if (groups < fewest)
        fail(ExitCode::usage, "--groups",
             std::string(target ? "--target-error and --mode auto need" : "halves need") +
                 " at least two independent groups");
    return groups;
}

// The scene, once it is certain that the plan can be written and overwrites none of the scene's files.
Scene load_to_plan(const Options& args, const RenderRequest& request, OutputPaths& places) {
    if (!args.save.empty()) places.check(std::filesystem::path(args.save));
    Scene scene = load_scene(request.scene_file, load_options(args.render));
    spare_files(scene, places);
    find_camera(scene, request.camera);
    return scene;
}

int save_as_asked(const Options& args, const Globals& globals) {
    const Mode& mode = find_mode(args.render.mode, "--mode");
    const RenderRequest request = make_request(args.render, mode);
    OutputPaths places;
    const Scene scene = load_to_plan(args, request, places);
    return save(args.save, scene, request, requested_plan(request), groups_option(args), globals);
}

int run_plan(const Options& args, const Globals& globals) {
    if (args.render.mode != automatic && args.save.empty())
        fail(ExitCode::usage, "--mode", "needs --save: otherwise the plan chooses the mode");
    if (!args.save.empty()) check_saved(args);
    if (args.render.mode != automatic) return save_as_asked(args, globals);
    RenderRequest request = make_request(args.render, main_mode());
    request.mode_open = true;
    OutputPaths places;
    const Scene scene = load_to_plan(args, request, places);
    request.frames = {request.frames.empty() ? scene.first_frame : request.frames[0]};
    if (!args.frame.empty()) request.frames = {frame_option(args.frame)};
    if (scene.media.empty()) refuse(scene.file.string(), "has no fog to plan for");
    const Snapshot snapshot = load_first_frame(scene, request).snapshot;

    Progress progress(globals.progress, "plan", 1, globals.json);
    const TermControl control{&cancel_flag(), [&](double share) { progress.set(share); }};
    const View view = view_of(scene, request, request.settings, request.frames[0]);
    const Plan plan = make_plan(modes(), view, snapshot, request.settings,
                                {request.target_error, request.time_budget, request.quality, {}, {}}, control);
    progress.finish();
    if (!args.save.empty()) {
        RenderRequest asked = make_request(args.render, *plan.chosen.mode);
        asked.mode = plan.chosen.mode->name;
        RenderPlan chosen = requested_plan(asked);
        chosen.settings = plan.settings, chosen.certificate = plan.certificate();
        Choice choice = plan.chosen.choice;
        const auto moments = [&](const RenderRequest& one) {
            return moments_of(scene, one, view.frame).moments.size();
        };
        if (moments(asked) != moments(request)) choice.measured.prepared = nullptr;
        chosen.choice = std::make_shared<const Choice>(std::move(choice));
        save(args.save, scene, asked, chosen, groups_option(args), globals);
    }
    if (globals.json) {
        print_report(plan_json(plan, request));
    } else {
        const std::string goal = plan.goal.error > 0 ? formatted("error at most %g of the mean", plan.goal.error)
                                                     : formatted("lowest error in %g s", plan.goal.seconds);
        print_report(formatted("%s, frame %d, %dx%d: %s\n\n", printable(request.scene_file.string(), 200).c_str(),
                               request.frames[0], view.size.x, view.size.y, goal.c_str()) +
                     plan_text(plan) + "\n" + command_of(plan, request, !args.frame.empty()) + "\n");
    }
    if (!globals.quiet)
        say("measured in " + seconds_text(plan.terms_seconds + plan.contest_seconds) + " on a few pixels");
    if (plan.chosen.reaches_goal()) return 0;
    fail(ExitCode::differs, request.scene_file.string(), "no mode reaches the goal; the one shown comes closest");
}
}

void check_for_plan(const RenderOptions& render, const std::string& groups) {
    const Options args{render, {}, {}, groups};
    check_saved(args);
    groups_option(args);
    make_request(render, render.mode == automatic ? main_mode() : find_mode(render.mode, "--mode"));
}

int save_plan_as_asked(const RenderOptions& render, const std::string& groups, const std::string& file,
                       const Globals& globals) {
    return save_as_asked({render, {}, file, groups}, globals);
}

void add_groups_option(const Command& command, std::string& groups) {
    command.option("--groups", groups,
                   "how many groups of samples, each scrambled independently: more groups measure\n"
                   "noise better, fewer have less of it (default: 8 with --target-error or\n"
                   "--mode auto, 2 for halves, else 1: noise is then estimated from its sections,\n"
                   "and overestimated)",
                   "K");
}

Run add_plan(const Command& program) {
    const Command command = program.command("plan", "which mode a scene needs for an error or a time, and why");
    auto args = std::make_shared<Options>();
    RenderOptions& render = args->render;
    render.mode = automatic, render.output = "out.####.exr";
    command.option("SCENE", render.scene, "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself", "")
        .required();
    command.option("--save", args->save, "write the plan to a file, for tyndall render --plan", "FILE");
    add_groups_option(command, args->groups);
    command.option("--frame", args->frame, "which frame of the scene to measure (default: its first)", "N");
    command.option("--mode", render.mode, "with --save: a mode, instead of the one the plan chooses", "NAME");
    add_planned_options(command, render);
    command.footer(
        "Example: tyndall plan scenes/window.json --target-error 0.02\n"
        "Each term of the light is switched off in turn, on a few pixels, and the difference measured; where\n"
        "a closed form bounds it closely enough, that is used instead. Modes are then measured from coarse\n"
        "to fine against exact single scattering. tyndall render --mode auto makes a shorter search, without\n"
        "testing terms, and renders.\n"
        "Exit code 0: a mode reaches the goal; 1: none does.");
    return [args](const Globals& globals) { return run_plan(*args, globals); };
}
}
