// The program `tyndall-view`: reads the command line, opens the viewer, turns every outcome into an exit code.
#include "../tyndall/common.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/mode.h"
#include "viewer.h"

#include <cstdio>

namespace tyndall {
namespace {
struct Args {
    std::string scene, mode = main_mode_name(), stand_in = interactive_mode_name(), quality = "preview", camera,
                       resolution, samples, script, window;
    std::string rate, threads, seed, units = "spec", missing = "error", exposure, view_transform;
    std::vector<std::string> settings;
    bool stats = false;
};

void add_options(const CommandLine& program, Args& args) {
    const auto option = [&](const char* name, std::string& text, const char* type, const char* help) {
        return program.option(name, text, help, type);
    };
    option("SCENE", args.scene, "", "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself").required();
    const auto quality = [&](const char* name, std::string& text, const char* type, const char* help) {
        program.option(name, text, help, type).group("Quality");
    };
    quality("--mode", args.mode, "NAME", "technique (default: march); tyndall modes lists them");
    quality("--stand-in", args.stand_in, "NAME",
            "technique of quick images while the view changes in march and path\n(default: froxel), or none: the same");
    quality("--quality", args.quality, "NAME", "draft, preview (default), final or reference");
    program
        .options("--set", args.settings, "one setting, for instance march.step_depth=0.1; may be repeated",
                 "NAME=VALUE")
        .group("Quality");
    option("--camera", args.camera, "NAME", "camera by name (default: the scene's)");
    option("--res", args.resolution, "WxH", "image size in pixels (default: the scene's)");
    option("--exposure", args.exposure, "EV",
           "exposure of the displayed image, in stops, or auto: measured\n"
           "(default: the scene's, auto where it states none)");
    option("--view-transform", args.view_transform, "NAME",
           "how values brighter than the display are shown: filmic (AgX;\ndefault) or srgb");
    quality("--samples", args.samples, "N", "samples per pixel of a finished image (default: 64)");
    quality("--seed", args.seed, "N", "another pattern of noise (default: 0)");
    option("--light-units", args.units, "UNITS", "units of a glTF's light intensities: spec (default), unitless, raw");
    option("--missing", args.missing, "WHAT", "a missing frame of a VDB sequence: error (default), hold, skip");
    option("--fps", args.rate, "N", "target images per second while things move (default: 30)");
    option("--window", args.window, "WxH", "size of the window (default: 1280x800)");
    option("--threads", args.threads, "N", "threads to use, 1 to 1024 (default: every core)");
    option("--script", args.script, "FILE",
           "file of actions, one per line; the window stays open unless the last\nis quit");
    program.flag("--stats", args.stats, "print times of the interface and the images on stdout at the end");
}

std::string footer() {
    std::string text = "Example: light a scene with quick images; P writes one as tyndall render does\n"
                       "  tyndall view scenes/window.json --mode froxel\n"
                       "Without a display: xvfb-run -a tyndall view SCENE --script FILE\n"
                       "Actions of a script:\n";
    for (const VerbInfo& info : verbs()) {
        const std::string name = std::string(info.name) + " " + std::string(info.parameters);
        text += formatted("  %-26s %s\n", name.c_str(), wrapped(info.doc, 76, 29).c_str());
    }
    return text + "Exit codes: those of tyndall (tyndall --help), 69 when there is no display.";
}

ViewerOptions read_options(const Args& args) {
    ViewerOptions options;
    ViewState& state = options.state;
    state.mode = find_mode(args.mode).name;
    state.stand_in = args.stand_in == "none" ? "" : std::string(find_mode(args.stand_in).name);
    state.quality = quality_named(args.quality);
    state.settings = settings_for(state.quality);
    for (const std::string& assignment : args.settings) apply_setting(state.settings, assignment);
    state.camera = args.camera;
    if (!args.resolution.empty()) state.size = resolution_option("--res", args.resolution);
    if (!args.window.empty()) options.window = resolution_option("--window", args.window);
    if (!args.exposure.empty()) apply(state, {Verb::exposure, {args.exposure}, {}, {}});
    if (!args.view_transform.empty()) apply(state, {Verb::view_transform, {args.view_transform}, {}, {}});
    if (!args.samples.empty())
        state.max_samples = static_cast<int>(integer_option("--samples", args.samples, 1, 1 << 20));
    if (!args.seed.empty()) state.seed = static_cast<uint32_t>(integer_option("--seed", args.seed, 0, UINT32_MAX));
    if (!args.rate.empty()) state.wanted_rate = number_option("--fps", args.rate, 1, 1000);
    options.load.light_units = static_cast<LightUnits>(choice_among("--light-units", args.units, light_unit_names));
    state.missing = static_cast<MissingFrame>(choice_among("--missing", args.missing, missing_frame_names));
    options.stats = args.stats;
    set_thread_count(args.threads.empty() ? 0 : static_cast<int>(integer_option("--threads", args.threads, 1, 1024)));
    options.isa = select_isa("auto");

    check_readable(args.scene);
    if (!args.script.empty()) options.script = parse_script(read_file(args.script), args.script);
    apply(state, {Verb::open, {args.scene}, {}, {}});
    return options;
}

int run(int argc, char** argv) {
    const CommandLine program("tyndall view", "view a scene while lighting it, with every technique and setting",
                              "tyndall-view " TYNDALL_VERSION, "Options");
    Args args;
    add_options(program, args);
    program.footer(footer());
    if (!program.read(argc, argv)) return 0;
    run_viewer(read_options(args));
    return 0;
}
}
}

int main(int argc, char** argv) {
    using namespace tyndall;
    flush_denormals();
    return run_program([&] { return run(argc, argv); });
}
