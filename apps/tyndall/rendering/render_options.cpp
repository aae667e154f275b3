// The options of tyndall render and their help.
#include "rendering/render_options.h"

namespace tyndall {
namespace {
void add_what(const Command& command, RenderOptions& args) {
    command.option("--frames", args.frames,
                   "frames to render: 1-48, 1-48x2 or 1-48:2 (every second), 1,5,9\n"
                   "(default: the scene's range)",
                   "RANGE");
    command.option("--camera", args.camera, "camera by name (default: the scene's)", "NAME");
    command.option("--res", args.resolution, "image size in pixels (default: the scene's)", "WxH");
    command.option("--crop", args.crop, "only the pixels from X0,Y0 (upper left, included) to X1,Y1 (excluded)",
                   "X0,Y0,X1,Y1");
    command.option("--missing", args.missing,
                   "a missing frame of a VDB sequence: error (default), hold the one\n"
                   "before, or skip the fog",
                   "WHAT");
    command.option("--light-units", args.light_units,
                   "what a glTF's light intensities mean: spec (candela, lux;\n"
                   "default), or Blender's unitless or raw (watts) export",
                   "UNITS");
}

void add_mode(const Command& command, RenderOptions& args) {
    command
        .option("--mode", args.mode,
                "rendering technique (default: march), or auto: the quickest that reaches\n"
                "--target-error (default: by quality, 0.05 for preview) or the best for\n"
                "--time-budget, by a short search on the first frame (tyndall plan searches\n"
                "thoroughly). Several (a,b,c) or all: each then writes its own files,\n"
                "out.MODE.####.exr, and a PNG shows them side by side; tyndall modes lists\n"
                "them",
                "NAMES")
        .group("Quality");
}

void add_how(const Command& command, RenderOptions& args) {
    const auto option = [&](const char* name, std::string& text, const char* help, const char* type) {
        command.option(name, text, help, type).group("Quality");
    };
    option("--quality", args.quality, "draft, preview (default), final or reference", "NAME");
    option("--samples", args.samples,
           "camera rays per pixel, instead of the quality's 1, 4, 16 or 64 (16 times\n"
           "as many for path)",
           "N");
    option("--target-error", args.target_error,
           "render until the error (rmse) is below this share of the image's mean,\n"
           "0.01 for instance; not for billboard and radial-blur. A mode's error is\n"
           "measured on a few pixels against exact single scattering, and its steps,\n"
           "maps and grids are chosen by it, except those given by --set; path has no\n"
           "error but noise. Exit code 1 when the error stays larger, and after ten\n"
           "minutes of a frame without --time-budget",
           "E");
    option("--time-budget", args.time_budget,
           "the best image in this many seconds per frame, with at least one ray per\n"
           "pixel; not for billboard and radial-blur. It covers the whole process, loading,\n"
           "measuring and writing included: N frames take at most N times as long, and time\n"
           "that one frame leaves the next may use. Exit code 1 when that is not enough. The\n"
           "image depends on the machine; with --target-error, the first one reached ends it",
           "SECONDS");
    option("--orders", args.orders,
           "how many times light scatters, in fog or on surfaces, or all of them\n"
           "(default: 1; all for path). In march and froxel a grid of multiply\n"
           "scattered light is added to the fog, on top of exact single scattering;\n"
           "surfaces keep direct light",
           "N");
    option("--history", args.history,
           "earlier frames that modes with a history (tyndall modes MODE) use to smooth\n"
           "the noise of each frame (default: 0)",
           "N");
    option("--shutter", args.shutter,
           "when the shutter opens and closes, in frames counted from the frame, instead of the\n"
           "camera's: --shutter=-0.25,0.25 is a 180-degree shutter; 0,0 disables motion blur",
           "OPEN,CLOSE");
    option("--time-samples", args.time_samples,
           "moments of a frame with an open shutter; each is prepared separately.\n"
           "Default: 4 to 512, by how far things move in the image meanwhile",
           "N");
    command
        .options("--set", args.settings,
                 "one setting, for instance march.step_depth=0.1; may be repeated;\n"
                 "tyndall modes lists them",
                 "NAME=VALUE")
        .group("Quality");
    option("--seed", args.seed, "another pattern of noise (default: 0)", "N");
    option("--isa", args.isa,
           "instruction set: auto (default), avx2 or avx512. auto and avx2 give the\n"
           "same bits on every machine, avx512 gives different ones",
           "NAME");
}

void add_layers(const Command& command, RenderOptions& args) {
    const char* group = "Results";
    command
        .option("--aov", args.aov,
                "layers beside the image: Z, inscatter, transmittance (these by default),\n"
                "surface and background, which with inscatter add up to the image; lights\n"
                "(one layer per light), ambient, emission and multiple, which add up to\n"
                "inscatter; validity, variance (of the mean), halves (two independent\n"
                "images); none for the image alone",
                "NAMES")
        .group(group);
    command
        .option("--background", args.background,
                "on (default), or off to exclude the background from color and alpha, for\n"
                "compositing over other images",
                "WHAT")
        .group(group);
    command.flag("--float", args.full_float, "colors as 32-bit floats instead of 16-bit").group(group);
}

void add_results(const Command& command, RenderOptions& args) {
    const char* group = "Results";
    command.flag("--png", args.png, "also write images for viewing (8-bit sRGB)").group(group);
    command
        .option("--exposure", args.exposure,
                "how much brighter (+) or darker (-) than the EXRs the PNGs are, in stops,\n"
                "or auto: measured on the first, middle and last frame of the scene, one for\n"
                "all frames (default: the scene's exposure, or auto if it has none)",
                "EV")
        .group(group);
    command
        .option("--view-transform", args.view_transform,
                "how PNGs show values above display white: filmic (AgX; default) rolls them\n"
                "off, srgb clips them at 1",
                "NAME")
        .group(group);
    command
        .option("--reference", args.sheet_reference,
                "with several modes: a reference EXR to show beside them in the common PNG, with\n"
                "the error and FLIP of each against it; #### stands for the frame number",
                "FILE")
        .group(group);
    command.flag("--resume", args.resume, "skip frames that exist and are up to date").group(group);
    command
        .option("--order", args.order,
                "of frames: listed (default), or spread: the first, the last, then the middle\n"
                "of every gap, to see the whole shot early",
                "WHAT")
        .group(group);
    command
        .option("--stats-json", args.stats,
                "write times and counts of every frame to a file; with several modes each\n"
                "writes its own, FILE with the mode in its name",
                "FILE")
        .group(group);
}

void add_shares(const Command& command, RenderOptions& args) {
    const auto option = [&](const char* name, std::string& text, const char* help, const char* type) {
        command.option(name, text, help, type).group("Many machines");
    };
    option("--plan", args.plan, "a plan that tyndall plan --save made, instead of scene and quality", "FILE");
    option("--part", args.part,
           "part i of N of each frame's samples, into an EXR part beside the frame;\n"
           "tyndall merge puts parts together",
           "i/N");
    option("--more", args.more,
           "M groups of samples beyond those of the plan, as parts; M@G: beyond the first\n"
           "G groups, if some were added before",
           "M[@G]");
    option("--checkpoint", args.checkpoint,
           "with --part: save a checkpoint of the part every this many minutes\n"
           "(default: 10) and when stopped by SIGTERM; --resume continues from it",
           "MINUTES");
    option("--cache-local", args.cache_local,
           "a local folder that files of tyndall prepare are copied to first, unless they\n"
           "are there already; without it they are read in place",
           "DIR");
}
}

void add_render_options(const Command& command, RenderOptions& args) {
    command.option("SCENE", args.scene, "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself", "");
    command.option("-o,--output", args.output, "files to write; #### stands for the frame number", "out.####.exr");
    add_what(command, args);
    add_mode(command, args);
    add_how(command, args);
    add_layers(command, args);
    add_results(command, args);
    add_shares(command, args);
}

void add_planned_options(const Command& command, RenderOptions& args) {
    add_what(command, args);
    add_how(command, args);
    add_layers(command, args);
}

std::vector<std::string> planned_words(const RenderOptions& args) {
    const RenderOptions usual;
    std::vector<std::string> words;
    const auto add = [&](const char* name, std::string RenderOptions::*text) {
        if (args.*text != usual.*text) words.insert(words.end(), {name, args.*text});
    };
    words.insert(words.end(), {"--mode", args.mode});
    add("--camera", &RenderOptions::camera), add("--res", &RenderOptions::resolution);
    add("--crop", &RenderOptions::crop), add("--missing", &RenderOptions::missing);
    add("--light-units", &RenderOptions::light_units), add("--quality", &RenderOptions::quality);
    add("--samples", &RenderOptions::samples), add("--target-error", &RenderOptions::target_error);
    add("--orders", &RenderOptions::orders), add("--seed", &RenderOptions::seed), add("--isa", &RenderOptions::isa);
    add("--shutter", &RenderOptions::shutter), add("--time-samples", &RenderOptions::time_samples);
    add("--aov", &RenderOptions::aov), add("--background", &RenderOptions::background);
    for (const std::string& setting : args.settings) words.insert(words.end(), {"--set", setting});
    if (args.full_float) words.emplace_back("--float");
    return words;
}
}
