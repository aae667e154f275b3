// tyndall chart: every mode's error against its time on the user's scene, as CSV, JSON and a page.
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/output.h"
#include "base/simd/isa.h"
#include "base/text.h"
#include "common.h"
#include "measure/chart/report.h"
#include "modes/mode.h"
#include "rendering/render_options.h"
#include "scene/input_files.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <algorithm>

namespace tyndall {
namespace {
struct Options {
    std::string scene, output, modes = "all", camera, frame, resolution, samples, noise, reference_seconds, runs,
                               longest;
    std::vector<std::string> settings;
    bool quick = false;
};

constexpr int usual_width = 320, quick_width = 128;

// The scene's aspect ratio at a width small enough to render many times.
ivec2 chart_size(const Scene& scene, bool quick) {
    const int width = std::min(quick ? quick_width : usual_width, scene.resolution.x);
    const double shape = static_cast<double>(scene.resolution.y) / scene.resolution.x;
    return {width, std::max(1, static_cast<int>(std::lround(width * shape)))};
}

ChartJob make_job(const Options& args) {
    ChartJob job;
    job.render.scene_file = args.scene;
    job.render.settings = settings_for(Quality::preview);
    for (const std::string& assignment : args.settings) apply_setting(job.render.settings, assignment);
    job.render.camera = args.camera, job.render.shutter = Shutter{}; // measured without motion blur
    job.render.isa = isa_name();
    job.modes = modes_option("--modes", args.modes);
    job.directory = args.output;
    if (args.quick) job.reference.noise = 0.05, job.reference.seconds = 4, job.runs = 2, job.longest = 0.7;
    if (!args.noise.empty()) job.reference.noise = number_option("--reference-noise", args.noise, 1e-5, 1);
    if (!args.samples.empty())
        job.reference.count = static_cast<int>(integer_option("--samples", args.samples, 4, 4096) + 1) / 2 * 2;
    if (!args.runs.empty()) job.runs = static_cast<int>(integer_option("--runs", args.runs, 1, 100));
    if (!args.longest.empty()) job.longest = number_option("--longest", args.longest, 1e-3, 1e6);
    if (!args.reference_seconds.empty())
        job.reference.seconds = number_option("--reference-seconds", args.reference_seconds, 0.1, 1e6);
    if (!args.resolution.empty()) job.render.resolution = resolution_option("--res", args.resolution);
    if (!args.frame.empty()) job.frame = frame_option(args.frame);
    return job;
}

// Checks every file that will be written, so that an unwritable one is reported before the work.
void check_places(const ChartJob& job, OutputPaths& places) {
    for (const char* name : {"chart.csv", "chart.json", "chart.html", "chart.svg", "chart_fog.svg",
                             "chart_sequence.svg", "points/a.json", "pictures/a.png", "reference/a.exr"})
        places.check(job.directory / name);
}

void write_reports(const Chart& chart) {
    const std::filesystem::path& directory = chart.job.directory;
    write_file_atomically(directory / "chart.csv", chart_csv(chart));
    write_file_atomically(directory / "chart.json", chart_json(chart));
    write_file_atomically(directory / "chart.svg", chart_svg_file(chart, FrameTime::single, ErrorOf::worse));
    write_file_atomically(directory / "chart_fog.svg", chart_svg_file(chart, FrameTime::single, ErrorOf::fog));
    write_file_atomically(directory / "chart_sequence.svg", chart_svg_file(chart, FrameTime::sequence, ErrorOf::worse));
    write_file_atomically(directory / "chart.html", chart_html(chart));
}

void say_end(const Chart& chart) {
    std::string line = count_text(chart.points.size(), "point") + " in " + seconds_text(chart.seconds);
    if (chart.kept > 0) line += formatted(", %d kept from an earlier run", chart.kept);
    if (!chart.skipped.empty()) line += formatted(", %zu skipped", chart.skipped.size());
    say(line);
    if (was_loaded(chart))
        say(formatted("note: other processes were running (load %.1f on %d threads), so times are too long",
                      chart.load_before, chart.threads));
    say("to view: " + printable((chart.job.directory / "chart.html").string()));
}

int run_chart(const Options& args, const Globals& globals) {
    ChartJob job = make_job(args);
    set_stop_remark("; measured points are kept, the same command continues");
    OutputPaths places;
    check_places(job, places);
    const Scene scene = load_scene(job.render.scene_file);
    spare_files(scene, places);
    if (scene.media.empty()) refuse(scene.file.string(), "has no fog to chart");
    find_camera(scene, job.render.camera);
    if (args.frame.empty()) job.frame = scene.first_frame;
    if (args.resolution.empty()) job.render.resolution = chart_size(scene, args.quick);

    Progress progress(globals.progress, "chart", 1, globals.json);
    ChartControl control{&cancel_flag(), [&](double done) { progress.set(done); }, {}};
    if (!globals.quiet) control.remark = [&](const std::string& line) { progress.line(line); };
    const Chart chart = make_chart(scene, job, control);
    stop_if_cancelled();
    write_reports(chart);
    progress.finish();
    print_report(globals.json ? chart_json(chart) : chart_text(chart));
    if (!globals.quiet) say_end(chart);
    const auto broken = std::ranges::find_if(chart.points, [](const ChartPoint& p) { return p.non_finite > 0; });
    if (broken != chart.points.end())
        fail(ExitCode::non_finite, scene.file.string(),
             point_name(*broken) + " had samples that were not finite numbers");
    return 0;
}
}

Run add_chart(const Command& program) {
    const Command command = program.command("chart", "every mode's error against its time on a scene");
    auto args = std::make_shared<Options>();
    command.option("SCENE", args->scene, "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself", "")
        .required();
    command
        .option("-o,--output", args->output, "directory for chart.csv, chart.json, chart.html, drawings and\nimages",
                "DIR")
        .required();
    command.option("--modes", args->modes, "modes by name, comma-separated (default: all)", "NAMES");
    command.flag("--quick", args->quick, "small images, without the settings that take longest: under a minute");
    command.option("--camera", args->camera, "camera by name (default: the scene's)", "NAME");
    command.option("--frame", args->frame, "which frame of the scene (default: its first)", "N");
    command.option("--res", args->resolution,
                   "image size in pixels (default: the scene's shape, 320 wide;\n128 with --quick)", "WxH");
    command.option("--reference-noise", args->noise,
                   "render the reference until its noise is this share of the mean\n(default: 0.02; 0.05 with --quick)",
                   "SHARE");
    command.option("--reference-seconds", args->reference_seconds,
                   "time limit for each of its two halves (default: 60; 4 with\n--quick)", "SECONDS");
    command.option("--samples", args->samples, "rays per pixel of the reference instead, 4 or more", "N");
    command.option("--runs", args->runs, "how many times each image is rendered, at least (default: 3; 2 with --quick)",
                   "N");
    command.option("--longest", args->longest,
                   "skip settings whose image would take more seconds than this\n"
                   "(default: 60; 0.7 with --quick)",
                   "SECONDS");
    command.options("--set", args->settings,
                    "one setting for all modes, for instance terms.ambient=off; may be\n"
                    "repeated. Those that trade speed for accuracy are set by the chart itself",
                    "NAME=VALUE");
    command.footer("Example: a quick look, then the full chart\n"
                   "  tyndall chart scenes/window.json -o out/chart --quick\n"
                   "  tyndall chart scenes/window.json -o out/chart\n"
                   "Each mode is rendered at six settings or more, each several times, and compared with exact single\n"
                   "scattering. Points are saved as they are measured: a stopped run resumes where it was.");
    return [args](const Globals& globals) { return run_chart(*args, globals); };
}
}
