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
struct Texts {
    std::string scene, mode = main_mode_name(), stand_in = interactive_mode_name(), quality = "preview", camera,
                       resolution, samples, script, window;
    std::string rate, threads, seed, units = "spec", missing = "error", exposure, view_transform;
    std::vector<std::string> settings;
    bool stats = false;
};

void add_options(const CommandLine& program, Texts& texts) {
    const auto option = [&](const char* name, std::string& text, const char* type, const char* help) {
        return program.option(name, text, help, type);
    };
    option("SCENE", texts.scene, "", "scene file (.json), or a .gltf, .glb or .vdb by itself").required();
    const auto quality = [&](const char* name, std::string& text, const char* type, const char* help) {
        program.option(name, text, help, type).group("Quality");
    };
    quality("--mode", texts.mode, "NAME", "technique (default: march); tyndall modes lists them");
    quality("--stand-in", texts.stand_in, "NAME",
            "technique of quick images while the view changes in march and path\n(default: froxel), or none: the same");
    quality("--quality", texts.quality, "NAME", "draft, preview (default), final or reference");
    program
        .options("--set", texts.settings, "one setting, for instance march.step_depth=0.1; may be repeated",
                 "NAME=VALUE")
        .group("Quality");
    option("--camera", texts.camera, "NAME", "camera by name (default: the scene's)");
    option("--res", texts.resolution, "WxH", "image size in pixels (default: the scene's)");
    option("--exposure", texts.exposure, "EV",
           "exposure of the displayed image, in stops, or auto: measured\n"
           "(default: the scene's, auto where it states none)");
    option("--view-transform", texts.view_transform, "NAME",
           "how values brighter than the display are shown: filmic (AgX;\ndefault) or srgb");
    quality("--samples", texts.samples, "N", "samples per pixel of a finished image (default: 64)");
    quality("--seed", texts.seed, "N", "another pattern of noise (default: 0)");
    option("--light-units", texts.units, "UNITS", "units of a glTF's light intensities: spec (default), unitless, raw");
    option("--missing", texts.missing, "WHAT", "a missing frame of a VDB sequence: error (default), hold, skip");
    option("--fps", texts.rate, "N", "target images per second while things move (default: 30)");
    option("--window", texts.window, "WxH", "size of the window (default: 1280x800)");
    option("--threads", texts.threads, "N", "threads to use, 1 to 1024 (default: every core)");
    option("--script", texts.script, "FILE",
           "file of actions, one per line; the window stays open unless the last\nis quit");
    program.flag("--stats", texts.stats, "print times of the interface and the images on stdout at the end");
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

ViewerOptions read_options(const Texts& texts) {
    ViewerOptions options;
    ViewState& state = options.state;
    state.mode = find_mode(texts.mode).name;
    state.stand_in = texts.stand_in == "none" ? "" : std::string(find_mode(texts.stand_in).name);
    state.quality = quality_named(texts.quality);
    state.settings = settings_for(state.quality);
    for (const std::string& assignment : texts.settings) apply_setting(state.settings, assignment);
    state.camera = texts.camera;
    if (!texts.resolution.empty()) state.size = resolution_option("--res", texts.resolution);
    if (!texts.window.empty()) options.window = resolution_option("--window", texts.window);
    if (!texts.exposure.empty()) apply(state, {Verb::exposure, {texts.exposure}, {}, {}});
    if (!texts.view_transform.empty()) apply(state, {Verb::view_transform, {texts.view_transform}, {}, {}});
    if (!texts.samples.empty())
        state.max_samples = static_cast<int>(integer_option("--samples", texts.samples, 1, 1 << 20));
    if (!texts.seed.empty()) state.seed = static_cast<uint32_t>(integer_option("--seed", texts.seed, 0, UINT32_MAX));
    if (!texts.rate.empty()) state.wanted_rate = number_option("--fps", texts.rate, 1, 1000);
    constexpr LightUnits units[] = {LightUnits::spec, LightUnits::unitless, LightUnits::raw};
    options.load.light_units = units[choice_among("--light-units", texts.units, {"spec", "unitless", "raw"})];
    constexpr MissingFrame missing[] = {MissingFrame::error, MissingFrame::hold, MissingFrame::skip};
    state.missing = missing[choice_among("--missing", texts.missing, {"error", "hold", "skip"})];
    options.stats = texts.stats;
    set_thread_count(texts.threads.empty() ? 0 : static_cast<int>(integer_option("--threads", texts.threads, 1, 1024)));
    options.isa = chosen_isa("auto");

    check_readable(texts.scene);
    if (!texts.script.empty()) options.script = parse_script(read_file(texts.script), texts.script);
    apply(state, {Verb::open, {texts.scene}, {}, {}});
    return options;
}

int run(int argc, char** argv) {
    const CommandLine program("tyndall view", "view a scene while lighting it, with every technique and setting",
                              "tyndall-view " TYNDALL_VERSION, "Options");
    Texts texts;
    add_options(program, texts);
    program.footer(footer());
    if (!program.read(argc, argv)) return 0;
    run_viewer(read_options(texts));
    return 0;
}
}
}

int main(int argc, char** argv) {
    using namespace tyndall;
    flush_denormals();
    return exit_code_of([&] { return run(argc, argv); });
}
