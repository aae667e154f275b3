// tyndall explain: what happens along one camera ray.
#include "measure/explain/explain.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/output.h"
#include "common.h"
#include "measuring/explain_json.h"
#include "render/sequence/provenance.h"
#include "rendering/render_options.h"
#include "scene/input_files.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/lights/enclosed_lights.h"
#include "trace/moment.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>
#include <optional>

namespace tyndall {
namespace {
struct Options {
    std::string scene, pixel, frame, camera, resolution, quality = "preview", modes = "all", svg, csv;
    std::vector<std::string> settings;
};

ivec2 pixel_option(const std::string& text) {
    const std::vector<std::string> numbers = comma_list(text);
    if (numbers.size() != 2)
        fail(ExitCode::usage, "--pixel", "expected X,Y, like 320,180; got '" + printable(text, 40) + "'");
    const auto number = [](const std::string& digits) {
        return static_cast<int>(integer_option("--pixel", digits, -largest_side, largest_side));
    };
    return {number(numbers[0]), number(numbers[1])};
}

void check_inside(ivec2 pixel, ivec2 size) {
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y)
        fail(ExitCode::usage, "--pixel",
             formatted("%d,%d lies outside the image of %dx%d pixels: 0,0 is the upper left, %d,%d the lower right",
                       pixel.x, pixel.y, size.x, size.y, size.x - 1, size.y - 1));
}

RenderRequest make_request(const Options& args) {
    RenderRequest request;
    request.scene_file = args.scene;
    request.quality = quality_named(args.quality);
    request.settings = settings_for(request.quality);
    for (const std::string& assignment : args.settings) apply_setting(request.settings, assignment);
    request.camera = args.camera, request.shutter = Shutter{}; // traced at one time, without motion blur
    if (!args.resolution.empty()) request.resolution = resolution_option("--res", args.resolution);
    if (!args.frame.empty()) request.frames = {frame_option(args.frame)};
    return request;
}

void check_outputs(const Options& args, OutputPaths& places) {
    if (!args.svg.empty())
        check_pattern(args.svg, ".svg", false, "--svg"), places.check(std::filesystem::path(args.svg));
    if (!args.csv.empty())
        check_pattern(args.csv, ".csv", false, "--csv"), places.check(std::filesystem::path(args.csv));
}

int run_explain(const Options& args, const Globals& globals) {
    const ivec2 pixel = pixel_option(args.pixel);
    RenderRequest request = make_request(args);
    ExplainOptions options;
    if (args.modes != "none") options.modes = modes_option("--modes", args.modes);
    if (request.resolution.x > 0) check_inside(pixel, request.resolution);
    OutputPaths places;
    check_outputs(args, places);

    const Scene scene = load_scene(args.scene);
    spare_files(scene, places);
    if (request.frames.empty()) request.frames = {scene.first_frame};
    const int frame = request.frames[0];
    find_camera(scene, request.camera);
    const View view = view_of(scene, request, request.settings, frame);
    check_inside(pixel, view.size);
    if (!globals.quiet)
        for (const std::string& warning : scene.warnings) say("warning: " + printable(warning, 460));

    Progress progress(globals.progress, "explain", 1, globals.json);
    const Snapshot snapshot = make_snapshot(scene, moment_of(scene, frame));
    stop_if_cancelled();
    if (!globals.quiet)
        for (const std::string& note : snapshot.notes) say("note: " + printable(note, 460));
    if (!globals.quiet)
        for (const std::string& line : enclosed_lights(snapshot)) say("warning: " + printable(line, 460));
    options.cancel = &cancel_flag();
    options.progress = [&](double done) { progress.set(done); };
    const RayReport report = explain_ray(view, snapshot, request.settings, pixel, options);
    stop_if_cancelled();
    progress.finish();

    const ReportTitle title{std::filesystem::path(args.scene).filename().string(), view.camera.name,
                            std::string(name_of(request.quality)), frame};
    if (!args.svg.empty()) write_file_atomically(args.svg, explain_svg(report, title));
    if (!args.csv.empty()) write_file_atomically(args.csv, explain_csv(report));
    print_report(globals.json ? explain_json(report, title) : explain_text(report, title));
    const auto finite = [](const ModeResult& result) { return result.finite; };
    if (report.reference.finite && std::ranges::all_of(report.results, finite)) return 0;
    fail(ExitCode::non_finite, args.scene, "a result is not a finite number; the report shows which");
}
}

Run add_explain(const Command& program) {
    const Command command = program.command("explain", "show what happens along one camera ray");
    auto args = std::make_shared<Options>();
    command.option("SCENE", args->scene, "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself", "")
        .required();
    command.option("--pixel", args->pixel, "the pixel whose center the ray goes through; 0,0 is the upper left", "X,Y")
        .required();
    command.option("--frame", args->frame, "which frame of the scene (default: its first)", "N");
    command.option("--camera", args->camera, "camera by name (default: the scene's)", "NAME");
    command.option("--res", args->resolution, "image size that --pixel refers to (default: the scene's)", "WxH");
    command.option("--quality", args->quality, "quality of the modes: draft, preview (default), final or reference",
                   "NAME");
    command.options("--set", args->settings,
                    "one setting by name, like froxel.tile=4; may be repeated\n"
                    "(tyndall modes lists them)",
                    "NAME=VALUE");
    command.option("--modes", args->modes, "modes to compare, comma-separated (default: all), or none", "NAMES");
    command.option("--svg", args->svg, "also write a drawing of the ray", "FILE.svg");
    command.option("--csv", args->csv, "also write a table of every step along the ray", "FILE.csv");
    command.footer(
        "Example: why is this pixel of the window so bright, and which modes get it right?\n"
        "  tyndall explain scenes/window.json --pixel 320,180 --svg ray.svg\n"
        "The report: what the ray hits, how much fog lies on it, where each light reaches it and what blocks\n"
        "the light, how much of it arrives at the camera; then the fog light of every mode, at the pixel's center\n"
        "with one sample, beside exact single scattering. --json has all of it.");
    return [args](const Globals& globals) { return run_explain(*args, globals); };
}
}
