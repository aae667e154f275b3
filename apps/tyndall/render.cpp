// tyndall render: the frames of a scene to OpenEXR files, and PNGs for looking at.
#include "automatic.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "common.h"
#include "modes/limitation.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/image/contact_sheet.h"
#include "render/sequence/loaded_frame.h"
#include "render/sequence/sequence.h"
#include "render_options.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
void choose_frames(const Scene& scene, RenderJob& job) {
    if (job.frames.empty()) job.frames = frames_between(scene.first_frame, scene.last_frame);
    check_pattern(job.output, ".exr", job.frames.size() > 1);
}

// Where the mode fails on this scene, from the first frame, with the settings it begins with.
Limitations limitations_of(const Scene& scene, const RenderJob& job, const Snapshot& snapshot) {
    View view;
    view.camera = camera_at(scene, find_camera(scene, job.camera), snapshot.seconds);
    view.size = job.resolution.x > 0 ? job.resolution : scene.resolution;
    return find_mode(job.mode).limitations(view, snapshot, job.choice ? job.choice->candidate.settings : job.settings);
}

// What the picture will not show: warnings of the files, then limitations of the mode; mere remarks only when verbose.
void say_limitations(const Scene& scene, const Limitations& limitations, const Globals& globals) {
    if (globals.quiet) return;
    if (globals.verbose)
        for (const auto& input : scene.inputs) say("reads " + printable(input.string(), 460));
    for (const std::string& warning : scene.warnings) say("warning: " + printable(warning, 460));
    for (const LimitationGroup& group : groups_of(limitations))
        if (globals.verbose || group.worst.severity != Severity::info) say(line_of(group));
}

void say_rounding(const RenderJob& job, const Globals& globals) {
    if (!globals.quiet && job.target_error > 0 && job.target_error < 1e-3 && !job.exr.full_float)
        say("note: 16 bit floats round by up to 0.0005 of a value: add --float");
}

// Takes as many samples as measuring noise needs, and says so; half floats hide the last of it.
void settle_noise(RenderJob& job, const Globals& globals) {
    const bool first_round = job.target_error > 0 && job.time_budget == 0 && error_is_noise(find_mode(job.mode));
    if (!(has_goal(job) ? first_round : measures_noise(job))) return say_rounding(job, globals);
    int& samples = job.settings.pixel.samples;
    const int asked = std::exchange(samples, batched_samples(samples));
    if (globals.quiet) return;
    if (samples != asked)
        say(formatted("note: %d camera rays per pixel instead of %d: noise is measured in %d equal batches", samples,
                      asked, noise_batches));
    say_rounding(job, globals);
}

// Settings that the mode does not read.
void say_idle_settings(const std::vector<std::string>& settings, const RenderJob& job, const Globals& globals) {
    if (globals.quiet) return;
    for (const std::string& setting : settings)
        if (!reads(find_mode(job.mode), setting.substr(0, setting.find('='))))
            say("note: " + printable(setting, 60) + " changes nothing: the mode is " + job.mode);
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

// What a job needs before its frames, and what is known of it afterwards.
struct Rendered {
    RenderJob job;
    RenderReport report;
};

void say_before(const Scene& scene, const Limitations& limitations, const RenderOptions& texts, const RenderJob& job,
                const Globals& globals) {
    say_idle_settings(texts.settings, job, globals);
    if (job.history > 0 && !find_mode(job.mode).remembers && !globals.quiet)
        say("note: --history changes nothing: " + job.mode + " has no memory");
    say_limitations(scene, limitations, globals);
}

// Renders a job's frames and reports on them; json is the statistics file's name, empty for none. The first frame of a
// job before shares its fog and surfaces, and is replaced by this job's when that is all there is to render.
Rendered render_job(const Scene& scene, RenderJob job, const RenderOptions& texts, const std::string& json,
                    const std::string& label, Snapshot& shared, const Globals& globals) {
    LoadedFrame first = load_first_frame(scene, job, &shared);
    if (texts.mode == automatic) choose_mode(scene, job, first.snapshot, globals);
    settle_noise(job, globals);
    shared = job.frames.size() == 1 ? first.snapshot : Snapshot{};
    shared.kept = nullptr; // the time that a mode takes must not depend on the one before it
    const Limitations limitations = limitations_of(scene, job, first.snapshot);
    say_before(scene, limitations, texts, job, globals);

    Progress progress(globals.progress, label, static_cast<double>(job.frames.size()), globals.json);
    RenderReport report = render_sequence(scene, job, progress, cancel_flag(), &first);
    if (!report.cancelled) progress.finish();
    // For the statistics only: a frame's header must not depend on which frame was the first.
    job.limitations = limitations;
    if (!json.empty()) write_file_atomically(json, stats_json(report, job));
    if (!globals.quiet) {
        for (const std::string& note : report.notes) say("note: " + printable(note, 460));
        say_summary(report, job);
    }
    return {std::move(job), std::move(report)};
}

int outcome(const std::vector<Rendered>& all, const std::string& scene) {
    uint64_t non_finite = 0;
    for (const Rendered& one : all) non_finite += one.report.non_finite;
    for (const Rendered& one : all)
        if (non_finite == 0 && one.report.missed)
            fail(ExitCode::differs, scene,
                 formatted("all frames were written, but the error of %d of them may be larger than %g",
                           one.report.missed, one.job.target_error));
    if (non_finite == 0) return 0;
    fail(ExitCode::non_finite, scene,
         "all frames were written, but " + count_text(non_finite, "sample") +
             " were not finite numbers and were left out");
}

std::string sheet_name(const RenderOptions& texts, int frame) {
    return std::filesystem::path(frame_name(with_word(texts.output, "modes"), frame))
        .replace_extension(".png")
        .string();
}

// One PNG per frame with the pictures of all modes and the time each took.
void write_sheets(const Scene& scene, const std::vector<Rendered>& all, const RenderOptions& texts,
                  const Globals& globals) {
    for (const int frame : all[0].job.frames) {
        std::vector<SheetPicture> pictures;
        for (const Rendered& one : all) {
            const auto found = std::ranges::find(one.report.frames, frame, &FrameReport::frame);
            if (found == one.report.frames.end()) return; // cancelled
            const FrameStats& stats = found->stats;
            std::string remark = "kept";
            if (!found->kept)
                remark = seconds_text(stats.prepare_seconds + stats.render_seconds) + ", fog " +
                         seconds_text(stats.fog_seconds);
            pictures.push_back({color_of(read_exr(found->file)), one.job.mode, remark});
        }
        const float exposure = all[0].job.exposure + scene.exposure.at(moment_of(scene, frame).seconds);
        write_contact_sheet(sheet_name(texts, frame), pictures, exposure);
    }
    if (!globals.quiet) say("look: " + printable(sheet_name(texts, all[0].job.frames[0])));
}

// The jobs of all modes asked for, each with files of its own when there are several.
std::vector<RenderJob> make_jobs(const RenderOptions& texts) {
    std::vector<RenderJob> jobs;
    // Until the scene is known, what is to be chosen is the main renderer.
    const std::vector<const Mode*> asked =
        asked_modes(texts.mode == automatic ? std::string(main_mode().name) : texts.mode);
    for (const Mode* mode : asked) {
        jobs.push_back(make_job(texts, *mode));
        if (asked.size() > 1) jobs.back().output = with_word(texts.output, mode->name);
    }
    return jobs;
}

std::string stats_name(const RenderOptions& texts, const RenderJob& job, bool several) {
    return texts.stats.empty() || !several ? texts.stats : with_word(texts.stats, job.mode);
}

int run_render(const RenderOptions& texts, const Globals& globals) {
    std::vector<RenderJob> jobs = make_jobs(texts);
    const bool several = jobs.size() > 1;
    const LoadOptions options = load_options(texts);
    OutputPlaces places;
    for (RenderJob& job : jobs) {
        job.light_units = options.light_units;
        if (!job.frames.empty())
            places.check(job.output, job.frames);
        else
            places.check(std::filesystem::path(frame_name(job.output, 1)));
        if (!texts.stats.empty()) places.check(std::filesystem::path(stats_name(texts, job, several)));
    }

    const Scene scene = load_scene(jobs[0].scene_file, options);
    stop_if_cancelled();
    for (RenderJob& job : jobs) {
        choose_frames(scene, job);
        places.check(job.output, job.frames);
        find_camera(scene, job.camera);
        check_crop(job, job.resolution.x > 0 ? job.resolution : scene.resolution);
    }
    if (several)
        for (const int frame : jobs[0].frames) places.check(std::filesystem::path(sheet_name(texts, frame)));

    std::vector<Rendered> all;
    std::string reports;
    Snapshot shared;
    for (const RenderJob& job : jobs) {
        all.push_back(render_job(scene, job, texts, stats_name(texts, job, several), several ? job.mode : "render",
                                 shared, globals));
        reports += (reports.empty() ? "" : ",\n") + stats_json(all.back().report, all.back().job);
        stop_if_cancelled();
    }
    if (several) write_sheets(scene, all, texts, globals);
    if (globals.json) print_report((several ? "[" + reports + "]" : reports) + "\n");
    return outcome(all, jobs[0].scene_file.string());
}
}

Run add_render(const Command& program) {
    const Command command = program.command("render", "light a scene and render its frames to OpenEXR files");
    auto texts = std::make_shared<RenderOptions>();
    add_render_options(command, *texts);
    command.footer("Example: the first second at full HD, with PNGs to look at\n"
                   "  tyndall render scenes/window.json -o out/window.####.exr --frames 1-24 --res 1920x1080 --png\n"
                   "A quick look first: --quality draft --res 480x270 --frames 1\n"
                   "Light is in candela and lux, lengths in metres, colours linear Rec.709.");
    return [texts](const Globals& globals) { return run_render(*texts, globals); };
}
}
