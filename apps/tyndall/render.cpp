// tyndall render: the frames of a scene to OpenEXR files, and PNGs for looking at.
#include "base/error.h"
#include "base/file.h"
#include "base/frames.h"
#include "common.h"
#include "output.h"
#include "render/to_target.h"
#include "render_options.h"

#include <utility>

namespace tyndall {
namespace {
void choose_frames(const Scene& scene, RenderJob& job) {
    if (job.frames.empty())
        for (int frame = scene.first_frame; frame <= scene.last_frame; ++frame) job.frames.push_back(frame);
    check_pattern(job.output, ".exr", job.frames.size() > 1);
}

// Where the mode fails on this scene, from the first frame.
std::vector<Limit> limits_of(const Scene& scene, const RenderJob& job) {
    const Snapshot snapshot = make_snapshot(scene, moment_of(scene, job.frames[0]), nullptr, job.missing);
    View view;
    view.camera = camera_at(scene, find_camera(scene, job.camera), snapshot.seconds);
    view.size = job.resolution.x > 0 ? job.resolution : scene.resolution;
    return find_mode(job.mode).limits(view, snapshot, job.settings);
}

std::string limit_line(const Limit& limit) {
    return std::string(name_of(limit.severity)) + ": " + printable(limit.where) + ": " + printable(limit.why, 240);
}

// What the picture will not show: warnings of the files, then limits of the mode; mere remarks only when verbose.
void say_limits(const Scene& scene, const std::vector<Limit>& limits, const Globals& globals) {
    if (globals.quiet) return;
    if (globals.verbose)
        for (const auto& input : scene.inputs) say("reads " + printable(input.string(), 460));
    for (const std::string& warning : scene.warnings) say("warning: " + printable(warning, 460));
    for (const Limit& limit : limits)
        if (globals.verbose || limit.severity != Severity::info) say(limit_line(limit));
}

// Takes as many samples as measuring noise needs, and says so; half floats hide the last of it.
void settle_noise(RenderJob& job, const Globals& globals) {
    if (!measures_noise(job)) return;
    int& samples = job.settings.pixel.samples;
    const int asked = std::exchange(samples, batched_samples(samples));
    if (globals.quiet) return;
    if (samples != asked)
        say(formatted("note: %d camera rays per pixel instead of %d: noise is measured in %d equal batches", samples,
                      asked, noise_batches));
    if (job.target_error > 0 && job.target_error < 1e-3 && !job.exr.full_float)
        say("note: 16 bit floats round by up to 0.0005 of a value: add --float");
}

// Settings of a technique that is not asked for. Surfaces that techniques share are lit as march says.
void say_idle_settings(const std::vector<std::string>& settings, const RenderJob& job, const Globals& globals) {
    if (globals.quiet) return;
    for (const std::string& setting : settings) {
        const std::string owner = setting.substr(0, setting.find('.'));
        const bool shared = owner == "march" && find_mode(job.mode).surfaces == Surfaces::shared;
        const auto owns = [&](const Mode& mode) { return mode.name == owner; };
        if (owner != job.mode && !shared && std::ranges::any_of(modes(), owns))
            say("note: " + printable(setting, 60) + " changes nothing: the mode is " + job.mode);
    }
}

void say_summary(const RenderReport& report, const RenderJob& job) {
    int kept = 0;
    for (const FrameReport& frame : report.frames) kept += frame.kept;
    const int rendered = static_cast<int>(report.frames.size()) - kept;
    std::string line = count_text(rendered, "frame") + " rendered in " + seconds_text(report.seconds);
    if (rendered > 0) line += " (" + seconds_text(report.seconds / rendered) + " a frame)";
    if (kept > 0) line += formatted(", %d kept", kept);
    say(line + ", " + printable(job.output));
    const std::string first = job.frames.empty() ? job.output : frame_name(job.output, job.frames[0]);
    if (job.png)
        say("look: " + printable(std::filesystem::path(first).replace_extension(".png").string()));
    else
        say("look: add --png for pictures any program shows; the .exr opens in tev, Blender, Nuke and others");
}

int run_render(const RenderOptions& texts, const Globals& globals) {
    RenderJob job = make_job(texts);
    const LoadOptions options = load_options(texts);
    job.light_units = options.light_units;
    OutputPlaces places;
    if (!job.frames.empty())
        places.check(job.output, job.frames);
    else
        places.check(std::filesystem::path(frame_name(job.output, 1)));
    if (!texts.stats.empty()) places.check(std::filesystem::path(texts.stats));

    const Scene scene = load_scene(job.scene_file, options);
    stop_if_cancelled();
    choose_frames(scene, job);
    places.check(job.output, job.frames);
    find_camera(scene, job.camera);
    check_crop(job, job.resolution.x > 0 ? job.resolution : scene.resolution);
    say_idle_settings(texts.settings, job, globals);
    settle_noise(job, globals);
    const std::vector<Limit> limits = limits_of(scene, job);
    say_limits(scene, limits, globals);

    Progress progress(globals.progress, "render", static_cast<double>(job.frames.size()), globals.json);
    const RenderReport report = render_sequence(scene, job, progress, cancel_flag());
    if (!report.cancelled) progress.finish();
    // For the statistics only: a frame's header must not depend on which frame was the first.
    for (const Limit& limit : limits) job.limits_said.push_back(limit_line(limit));
    if (!texts.stats.empty()) write_file_atomically(texts.stats, stats_json(report, job));
    if (globals.json) print_report(stats_json(report, job) + "\n");
    if (!globals.quiet) {
        for (const std::string& note : report.notes) say("note: " + printable(note, 460));
        say_summary(report, job);
    }
    if (report.non_finite == 0 && report.missed)
        fail(ExitCode::differs, job.scene_file.string(),
             formatted("all frames were written, but %d of them %s noisier than %g after %d camera rays per pixel",
                       report.missed, report.missed == 1 ? "is" : "are", job.target_error, most_target_samples));
    if (report.non_finite == 0) return 0;
    fail(ExitCode::non_finite, job.scene_file.string(),
         "all frames were written, but " + count_text(report.non_finite, "sample") +
             " were not finite numbers and were left out");
}
}

Run add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "light a scene and render its frames to OpenEXR files");
    auto texts = std::make_shared<RenderOptions>();
    add_render_options(*command, *texts);
    command->footer("Example: the first second at full HD, with PNGs to look at\n"
                    "  tyndall render scenes/window.json -o out/window.####.exr --frames 1-24 --res 1920x1080 --png\n"
                    "A quick look first: --quality draft --res 480x270 --frames 1\n"
                    "Light is in candela and lux, lengths in metres, colours linear Rec.709.");
    return [texts](const Globals& globals) { return run_render(*texts, globals); };
}
}
