// tyndall bake: a fog recipe to a sequence of VDB files.
#include "volume/recipe/bake.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "common.h"

namespace tyndall {
namespace {
struct Options {
    std::string recipe, output, frames = "1", voxel_size, compression = "blosc";
    bool full_float = false, velocity = false, resume = false;
};

BakeOptions bake_options(const Options& args) {
    BakeOptions options;
    options.write.half = !args.full_float;
    options.write.blosc = choice_among("--compression", args.compression, {"blosc", "zip"}) == 0;
    options.velocity = args.velocity;
    options.resume = args.resume;
    options.cancel = &cancel_flag();
    return options;
}

std::string report_json(const Options& args, const std::vector<int>& frames, const BakeReport& report) {
    return json_line({{"recipe", args.recipe},
                      {"output", args.output},
                      {"frames", format_frames(frames)},
                      {"written", report.written},
                      {"kept", report.kept},
                      {"seconds", report.seconds},
                      {"voxels", report.voxels},
                      {"bytes", report.bytes}});
}

int run_bake(const Options& args, const Globals& globals) {
    const std::vector<int> frames = parse_frames(args.frames);
    check_pattern(args.output, ".vdb", frames.size() > 1);
    const BakeOptions options = bake_options(args);
    const double voxel_size = args.voxel_size.empty() ? 0 : number_option("--voxel-size", args.voxel_size, 1e-6, 1e6);

    set_stop_remark("; finished frames are kept, --resume continues");
    OutputPaths places;
    places.check(args.output, frames);
    FogRecipe recipe = read_recipe(args.recipe);
    if (voxel_size > 0) recipe.voxel_size = voxel_size;

    Progress progress(globals.progress, "bake", static_cast<double>(frames.size()), globals.json);
    const BakeReport report = bake(recipe, args.output, frames, options, progress);
    stop_if_cancelled();
    progress.finish();
    if (globals.json) print_report(report_json(args, frames, report));
    if (globals.quiet) return 0;
    say(formatted("%s baked%s in %s: %s voxels, %s, %s", count_text(report.written, "frame").c_str(),
                  report.kept ? formatted(", %d kept,", report.kept).c_str() : "", seconds_text(report.seconds).c_str(),
                  std::to_string(report.voxels).c_str(), bytes_text(static_cast<double>(report.bytes)).c_str(),
                  printable(args.output).c_str()));
    return 0;
}
}

Run add_bake(const Command& program) {
    const Command command = program.command("bake", "make fog from a recipe: a sequence of OpenVDB files");
    auto args = std::make_shared<Options>();
    command.option("RECIPE", args->recipe, "fog recipe (.json), for instance volumes/drifting_dust.json", "")
        .required();
    command.option("-o,--output", args->output, "files to write; #### stands for the frame number", "out.####.vdb")
        .required();
    command.option("--frames", args->frames, "frames to bake: 1-48, 1-48x2 (every second), 1,5,9 (default: 1)",
                   "RANGE");
    command.option("--voxel-size", args->voxel_size, "edge of a voxel in meters, instead of the recipe's", "METERS");
    command.flag("--float", args->full_float, "store 32-bit floats; 16 bits otherwise, enough for fog");
    command.option("--compression", args->compression, "blosc (default) or zip, for readers without Blosc", "NAME");
    command.flag("--velocity", args->velocity,
                 "also write a grid \"vel\": the velocity that advects the fog, in meters per second");
    command.flag("--resume", args->resume, "skip frames that exist and are up to date");
    command.footer("Example: two seconds of drifting dust with 4 cm voxels\n"
                   "  tyndall bake volumes/drifting_dust.json -o fog/dust.####.vdb --frames 1-48 --voxel-size 0.04\n"
                   "Then look at a frame with tyndall info, or name the files in a scene's media.");
    return [args](const Globals& globals) { return run_bake(*args, globals); };
}
}
