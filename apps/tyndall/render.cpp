// tyndall render: the frames of a scene to OpenEXR files, and PNGs for looking at.
#include "base/error.h"
#include "base/file.h"
#include "base/frames.h"
#include "base/isa.h"
#include "common.h"
#include "output.h"
#include "render/sequence.h"

namespace tyndall {
namespace {
struct Options {
    std::string scene, output, frames, mode = "march", quality = "preview", camera, resolution, crop, samples;
    std::string exposure, light_units = "spec", missing = "error", aov, seed, isa = "auto", stats;
    std::vector<std::string> settings;
    bool png = false, resume = false;
};

constexpr int largest_side = 16384; // pixels; what EXR readers take

ivec2 parsed_resolution(const std::string& text) {
    const size_t cross = text.find('x');
    if (cross == text.npos)
        fail(ExitCode::usage, "--res", "expected WIDTHxHEIGHT, like 1280x720; got '" + printable(text, 40) + "'");
    return {integer_option("--res", text.substr(0, cross), 1, largest_side),
            integer_option("--res", text.substr(cross + 1), 1, largest_side)};
}

void read_crop(const std::string& text, RenderJob& job) {
    const std::vector<std::string> edges = comma_list(text);
    if (edges.size() != 4)
        fail(ExitCode::usage, "--crop", "expected X0,Y0,X1,Y1 in pixels; got '" + printable(text, 40) + "'");
    int values[4];
    for (int i = 0; i < 4; ++i) values[i] = static_cast<int>(integer_option("--crop", edges[i], 0, largest_side));
    job.crop_low = {values[0], values[1]}, job.crop_high = {values[2], values[3]};
    if (job.crop_low.x >= job.crop_high.x || job.crop_low.y >= job.crop_high.y)
        fail(ExitCode::usage, "--crop",
             "X1,Y1 have to lie right of and below X0,Y0; got '" + printable(text, 40) + "'");
}

void check_crop(const RenderJob& job, ivec2 picture) {
    if (job.crop_high.x > picture.x || job.crop_high.y > picture.y)
        fail(ExitCode::usage, "--crop", formatted("reaches beyond the picture of %dx%d pixels", picture.x, picture.y));
}

// Layers beside RGBA, from --aov.
std::vector<std::string> parsed_layers(const std::string& text) {
    if (text == "none") return {};
    const std::vector<std::string> known{"Z", "inscatter", "transmittance", "validity", "lights"};
    std::vector<std::string> layers;
    for (const std::string& name : comma_list(text)) layers.push_back(known[choice_option("--aov", name, known)]);
    return layers;
}

// Sets the instruction set of all kernels. Returns the one the bits depend on: avx2 unless another was asked for, since
// the vector kernels round alike on avx2 and avx512 and the ray tracer takes avx2 by itself.
std::string chosen_isa(const std::string& text) {
    const std::string_view kernels = set_isa(text);
    set_embree_isa(text);
    return text == "avx512" || kernels == "baseline" ? std::string(kernels) : "avx2";
}

// Everything the command line alone decides; throws Error (usage) before any file is touched.
RenderJob make_job(const Options& texts) {
    RenderJob job;
    job.scene_file = texts.scene;
    job.output = texts.output;
    if (!texts.frames.empty()) job.frames = parse_frames(texts.frames);
    check_pattern(texts.output, ".exr", job.frames.size() > 1);
    job.mode = find_mode(texts.mode).name;
    job.quality = quality_named(texts.quality);
    job.settings = settings_for(job.quality);
    if (!texts.samples.empty())
        job.settings.pixel.samples = static_cast<int>(integer_option("--samples", texts.samples, 1, 4096));
    for (const std::string& assignment : texts.settings) apply_setting(job.settings, assignment);
    job.camera = texts.camera;
    if (!texts.resolution.empty()) job.resolution = parsed_resolution(texts.resolution);
    if (!texts.crop.empty()) read_crop(texts.crop, job);
    if (!texts.crop.empty() && !texts.resolution.empty()) check_crop(job, job.resolution);
    if (!texts.seed.empty()) job.seed = static_cast<uint32_t>(integer_option("--seed", texts.seed, 0, UINT32_MAX));
    constexpr MissingFrame missing[] = {MissingFrame::error, MissingFrame::hold, MissingFrame::skip};
    job.missing = missing[choice_option("--missing", texts.missing, {"error", "hold", "skip"})];
    if (!texts.exposure.empty() && !texts.png)
        fail(ExitCode::usage, "--exposure", "brightens PNGs only, EXR files hold light as it is: add --png");
    if (!texts.exposure.empty())
        job.exposure = static_cast<float>(number_option("--exposure", texts.exposure, -100, 100));
    if (!texts.aov.empty()) job.exr.layers = parsed_layers(texts.aov);
    job.png = texts.png, job.resume = texts.resume;
    job.isa = chosen_isa(texts.isa);
    return job;
}

LoadOptions load_options(const Options& texts) {
    constexpr LightUnits units[] = {LightUnits::spec, LightUnits::unitless, LightUnits::raw};
    return {units[choice_option("--light-units", texts.light_units, {"spec", "unitless", "raw"})]};
}

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

int run_render(const Options& texts, const Globals& globals) {
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
    if (report.non_finite == 0) return 0;
    fail(ExitCode::non_finite, job.scene_file.string(),
         "all frames were written, but " + count_text(report.non_finite, "sample") +
             " were not finite numbers and were left out");
}

void add_what(CLI::App& command, Options& texts) {
    command.add_option("SCENE", texts.scene, "scene file (.json), or a .gltf/.glb by itself")
        ->type_name("")
        ->required();
    command.add_option("-o,--output", texts.output, "files to write; #### stands for the frame number")
        ->type_name("out.####.exr")
        ->required();
    command
        .add_option("--frames", texts.frames,
                    "frames to render: 1-48, 1-48x2 (every second), 1,5,9\n"
                    "(default: the scene's range)")
        ->type_name("RANGE");
    command.add_option("--camera", texts.camera, "camera by name (default: the scene's)")->type_name("NAME");
    command.add_option("--res", texts.resolution, "picture size in pixels (default: the scene's)")->type_name("WxH");
    command.add_option("--crop", texts.crop, "only the pixels from X0,Y0 (upper left, included) to X1,Y1 (excluded)")
        ->type_name("X0,Y0,X1,Y1");
    command
        .add_option("--missing", texts.missing,
                    "a missing frame of a VDB sequence: error (default), hold the one\n"
                    "before, or skip the fog")
        ->type_name("WHAT");
    command
        .add_option("--light-units", texts.light_units,
                    "what a glTF's light intensities mean: spec (candela, lux;\n"
                    "default), or Blender's unitless or raw (watts) export")
        ->type_name("UNITS");
}

void add_how(CLI::App& command, Options& texts) {
    const auto option = [&](const char* name, std::string& text, const char* help, const char* type) {
        command.add_option(name, text, help)->type_name(type)->group("Quality");
    };
    option("--quality", texts.quality, "draft, preview (default), final or reference", "NAME");
    option("--samples", texts.samples, "camera rays per pixel, instead of the quality's", "N");
    option("--mode", texts.mode, "rendering technique (default: march); tyndall modes lists them", "NAME");
    command
        .add_option("--set", texts.settings,
                    "one setting, for instance march.step_depth=0.1; may be repeated;\n"
                    "tyndall modes lists them")
        ->type_name("ROW=VALUE")
        ->allow_extra_args(false)
        ->group("Quality");
    option("--seed", texts.seed, "another pattern of noise (default: 0)", "N");
    option("--isa", texts.isa,
           "instruction set: auto (default), avx2 or avx512. Pictures are equal bit\n"
           "for bit only with the same one",
           "NAME");
}

void add_results(CLI::App& command, Options& texts) {
    const auto group = [](CLI::Option* option) { return option->group("Results"); };
    group(command.add_option("--aov", texts.aov,
                             "layers beside the picture: Z, inscatter, transmittance (these by default),\n"
                             "validity, lights (one layer per light); none for the picture alone"))
        ->type_name("NAMES");
    group(command.add_flag("--png", texts.png, "also write pictures for looking at (8-bit sRGB)"));
    group(command.add_option("--exposure", texts.exposure, "brighten (+) or darken (-) the PNGs, in stops"))
        ->type_name("EV");
    group(command.add_flag("--resume", texts.resume, "keep frames that are already there and still right"));
    group(command.add_option("--stats-json", texts.stats, "write times and counts of every frame to a file"))
        ->type_name("FILE");
}
}

Run add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "light a scene and render its frames to OpenEXR files");
    auto texts = std::make_shared<Options>();
    add_what(*command, *texts);
    add_how(*command, *texts);
    add_results(*command, *texts);
    command->footer("Example: the first second at full HD, with PNGs to look at\n"
                    "  tyndall render scenes/window.json -o out/window.####.exr --frames 1-24 --res 1920x1080 --png\n"
                    "A quick look first: --quality draft --res 480x270 --frames 1\n"
                    "Light is in candela and lux, lengths in metres, colours linear Rec.709.");
    return [texts](const Globals& globals) { return run_render(*texts, globals); };
}
}
