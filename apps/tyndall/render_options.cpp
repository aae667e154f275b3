// The options of tyndall render: how they read, and what they mean.
#include "render_options.h"

#include "automatic.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/parts/plan_file.h"

#include <algorithm>
#include <tuple>

namespace tyndall {
namespace {
void read_crop(const std::string& text, RenderRequest& request) {
    const std::vector<std::string> edges = comma_list(text);
    if (edges.size() != 4)
        fail(ExitCode::usage, "--crop", "expected X0,Y0,X1,Y1 in pixels; got '" + printable(text, 40) + "'");
    int values[4];
    for (int i = 0; i < 4; ++i) values[i] = static_cast<int>(integer_option("--crop", edges[i], 0, largest_side));
    request.crop_low = {values[0], values[1]}, request.crop_high = {values[2], values[3]};
    if (request.crop_low.x >= request.crop_high.x || request.crop_low.y >= request.crop_high.y)
        fail(ExitCode::usage, "--crop",
             "X1,Y1 have to lie right of and below X0,Y0; got '" + printable(text, 40) + "'");
}

// Layers beside RGBA, from --aov.
std::vector<std::string> parsed_layers(const std::string& text) {
    if (text == "none") return {};
    const std::vector<std::string>& known = layer_names();
    std::vector<std::string> layers;
    for (const std::string& name : comma_list(text)) layers.push_back(known[choice_among("--aov", name, known)]);
    return layers;
}

// A mode whose only error is noise gets so many times the quality's samples.
constexpr int noisy_factor = 16;

// --orders, for modes that follow light further than once.
void read_orders(const std::string& text, RenderRequest& request) {
    const int orders = text == "all" ? all_orders : static_cast<int>(integer_option("--orders", text, 1, all_orders));
    if (find_mode(request.mode).accuracy == Accuracy::multiple_scattering)
        request.settings.path.orders = orders;
    else if (find_mode(request.mode).adds_fluence)
        request.settings.fluence.orders = orders;
    else if (orders > 1)
        fail(ExitCode::usage, "--orders",
             request.mode + " scatters light once only; --mode march, froxel and path take more");
}

// A goal decides how many samples there are, but that path begins with as many as asked for when time is no matter.
void check_samples(const RenderRequest& request, const Mode& mode) {
    if (!has_goal(request) || (error_is_noise(mode) && request.time_budget == 0)) return;
    if (request.settings.pixel.samples != settings_for(request.quality).pixel.samples)
        fail(ExitCode::usage, "--samples",
             std::string(request.time_budget > 0 ? "--time-budget" : "--target-error") +
                 " decides how many rays a pixel takes");
}

void add_what(const Command& command, RenderOptions& texts) {
    command.option("--frames", texts.frames,
                   "frames to render: 1-48, 1-48x2 or 1-48:2 (every second), 1,5,9\n"
                   "(default: the scene's range)",
                   "RANGE");
    command.option("--camera", texts.camera, "camera by name (default: the scene's)", "NAME");
    command.option("--res", texts.resolution, "image size in pixels (default: the scene's)", "WxH");
    command.option("--crop", texts.crop, "only the pixels from X0,Y0 (upper left, included) to X1,Y1 (excluded)",
                   "X0,Y0,X1,Y1");
    command.option("--missing", texts.missing,
                   "a missing frame of a VDB sequence: error (default), hold the one\n"
                   "before, or skip the fog",
                   "WHAT");
    command.option("--light-units", texts.light_units,
                   "what a glTF's light intensities mean: spec (candela, lux;\n"
                   "default), or Blender's unitless or raw (watts) export",
                   "UNITS");
}

void add_mode(const Command& command, RenderOptions& texts) {
    command
        .option("--mode", texts.mode,
                "rendering technique (default: march), or auto: the quickest that gets to\n"
                "--target-error (default: by quality, 0.05 for preview) or the best for\n"
                "--time-budget, as tyndall plan finds it for the first frame. Several\n"
                "(a,b,c) or all: each then writes files of its own, out.MODE.####.exr, and\n"
                "a PNG shows them side by side; tyndall modes lists them",
                "NAMES")
        .group("Quality");
}

void add_how(const Command& command, RenderOptions& texts) {
    const auto option = [&](const char* name, std::string& text, const char* help, const char* type) {
        command.option(name, text, help, type).group("Quality");
    };
    option("--quality", texts.quality, "draft, preview (default), final or reference", "NAME");
    option("--samples", texts.samples,
           "camera rays per pixel, instead of the quality's 1, 4, 16 or 64 (16 times\n"
           "as many for path)",
           "N");
    option("--target-error", texts.target_error,
           "go on until the error (rmse) is below this share of the image's mean,\n"
           "0.01 for instance; not for billboard and radial-blur. A mode's error is\n"
           "measured on a few pixels against exact single scattering, and its steps,\n"
           "maps and grids are picked by it, those of --set apart; path has no error\n"
           "but noise. Exit code 1 when the error stays larger",
           "E");
    option("--time-budget", texts.time_budget,
           "the best image in so many seconds for each frame, but one ray per pixel\n"
           "at least; not for billboard and radial-blur. It is the time of the whole process,\n"
           "loading, measuring and writing included: N frames take N times as long at most, and\n"
           "what one leaves the next may use. Exit code 1 when that is not enough. The image\n"
           "depends on the machine; with --target-error what comes first ends it",
           "SECONDS");
    option("--orders", texts.orders,
           "how many times light scatters, in fog or on surfaces, or all of them\n"
           "(default: 1; all for path). In march and froxel a grid of light that has\n"
           "scattered before is added to the fog, on top of exact single scattering;\n"
           "surfaces keep direct light",
           "N");
    option("--history", texts.history,
           "frames before each that modes with a memory (tyndall modes) look at first,\n"
           "to smooth their noise (default: 0)",
           "N");
    command
        .options("--set", texts.settings,
                 "one setting, for instance march.step_depth=0.1; may be repeated;\n"
                 "tyndall modes lists them",
                 "NAME=VALUE")
        .group("Quality");
    option("--seed", texts.seed, "another pattern of noise (default: 0)", "N");
    option("--isa", texts.isa,
           "instruction set: auto (default), avx2 or avx512. auto and avx2 give the\n"
           "same bits on every machine, avx512 gives others",
           "NAME");
}

void add_layers(const Command& command, RenderOptions& texts) {
    const char* group = "Results";
    command
        .option("--aov", texts.aov,
                "layers beside the image: Z, inscatter, transmittance (these by default),\n"
                "surface and background, which with inscatter add up to the image; lights\n"
                "(one layer per light), ambient, emission and multiple, which add up to\n"
                "inscatter; validity, variance (of the mean), halves (two independent\n"
                "images); none for the image alone",
                "NAMES")
        .group(group);
    command
        .option("--background", texts.background,
                "on (default), or off to leave the background out of colour and alpha, for\n"
                "images that go over others",
                "WHAT")
        .group(group);
    command.flag("--float", texts.full_float, "colours as 32 bit floats instead of 16 bit").group(group);
}

void add_results(const Command& command, RenderOptions& texts) {
    const char* group = "Results";
    command.flag("--png", texts.png, "also write images for looking at (8-bit sRGB)").group(group);
    command
        .option("--exposure", texts.exposure,
                "how much brighter (+) or darker (-) than the EXRs the PNGs are, in stops,\n"
                "or auto: measured on the first, middle and last frame of the scene, one for\n"
                "all frames (default: the scene's exposure, auto where it states none)",
                "EV")
        .group(group);
    command
        .option("--view-transform", texts.view_transform,
                "how PNGs show what is brighter than a screen: filmic (AgX; default) rolls\n"
                "it off, srgb cuts it off at 1",
                "NAME")
        .group(group);
    command
        .option("--reference", texts.sheet_reference,
                "with several modes: an EXR that the PNG of all shows beside them, with the\n"
                "error and the FLIP of each against it; #### stands for the frame number",
                "FILE")
        .group(group);
    command.flag("--resume", texts.resume, "keep frames that are already there and still right").group(group);
    command
        .option("--order", texts.order,
                "of frames: listed (default), or spread: the first, the last, then the middle\n"
                "of every gap, to see the whole shot early",
                "WHAT")
        .group(group);
    command
        .option("--stats-json", texts.stats,
                "write times and counts of every frame to a file; with several modes each\n"
                "writes its own, FILE with the mode in its name",
                "FILE")
        .group(group);
}
}

namespace {
void add_shares(const Command& command, RenderOptions& texts) {
    const auto option = [&](const char* name, std::string& text, const char* help, const char* type) {
        command.option(name, text, help, type).group("Many machines");
    };
    option("--plan", texts.plan, "a plan that tyndall plan --save made, instead of scene and quality", "FILE");
    option("--part", texts.part,
           "part i of N of each frame's samples, into an EXR part beside the frame;\n"
           "tyndall merge puts parts together",
           "i/N");
    option("--more", texts.more,
           "M groups of samples beyond those of the plan, as parts; M@G: beyond the first\n"
           "G groups, where some were added before",
           "M[@G]");
    option("--checkpoint", texts.checkpoint,
           "with --part: keep what is rendered of it in a file every so many minutes\n"
           "(default: 10) and when stopped by SIGTERM; --resume goes on from there",
           "MINUTES");
    option("--cache-local", texts.cache_local,
           "a folder of this machine that files of tyndall prepare are copied to first,\n"
           "unless they are there; without it they are read where they lie",
           "DIR");
}
}

void add_render_options(const Command& command, RenderOptions& texts) {
    command.option("SCENE", texts.scene, "scene file (.json), or a .gltf, .glb or .vdb by itself", "");
    command.option("-o,--output", texts.output, "files to write; #### stands for the frame number", "out.####.exr");
    add_what(command, texts);
    add_mode(command, texts);
    add_how(command, texts);
    add_layers(command, texts);
    add_results(command, texts);
    add_shares(command, texts);
}

void add_planned_options(const Command& command, RenderOptions& texts) {
    add_what(command, texts);
    add_how(command, texts);
    add_layers(command, texts);
}

std::vector<std::string> planned_words(const RenderOptions& texts) {
    const RenderOptions usual;
    std::vector<std::string> words;
    const auto add = [&](const char* name, std::string RenderOptions::*text) {
        if (texts.*text != usual.*text) words.insert(words.end(), {name, texts.*text});
    };
    words.insert(words.end(), {"--mode", texts.mode});
    add("--camera", &RenderOptions::camera), add("--res", &RenderOptions::resolution);
    add("--crop", &RenderOptions::crop), add("--missing", &RenderOptions::missing);
    add("--light-units", &RenderOptions::light_units), add("--quality", &RenderOptions::quality);
    add("--samples", &RenderOptions::samples), add("--target-error", &RenderOptions::target_error);
    add("--orders", &RenderOptions::orders), add("--seed", &RenderOptions::seed), add("--isa", &RenderOptions::isa);
    add("--aov", &RenderOptions::aov), add("--background", &RenderOptions::background);
    for (const std::string& setting : texts.settings) words.insert(words.end(), {"--set", setting});
    if (texts.full_float) words.emplace_back("--float");
    return words;
}

void check_crop(const RenderRequest& request, ivec2 picture) {
    if (request.crop_high.x > picture.x || request.crop_high.y > picture.y)
        fail(ExitCode::usage, "--crop", formatted("reaches beyond the image of %dx%d pixels", picture.x, picture.y));
}

std::vector<const Mode*> asked_modes(std::string_view option, const std::string& text) {
    std::vector<const Mode*> result;
    if (text == "all") {
        for (const Mode& mode : modes()) result.push_back(&mode);
        return result;
    }
    for (const std::string& name : comma_list(text)) {
        if (name == automatic) fail(ExitCode::usage, option, "auto is one mode of its choice: name it alone");
        const Mode& mode = find_mode(name, option);
        if (std::ranges::count(result, &mode)) fail(ExitCode::usage, option, name + " is named twice");
        result.push_back(&mode);
    }
    return result;
}

namespace {
void read_look(const RenderOptions& texts, RenderRequest& request) {
    for (const auto& [name, text] :
         {std::pair{"--exposure", &texts.exposure}, {"--view-transform", &texts.view_transform}})
        if (!text->empty() && !texts.png)
            fail(ExitCode::usage, name, "is for PNGs only, EXR files hold light as it is: add --png");
    request.automatic_exposure = texts.exposure == automatic;
    if (!texts.exposure.empty() && !request.automatic_exposure)
        request.exposure = number_option("--exposure", texts.exposure, -100, 100);
    if (!texts.view_transform.empty())
        request.view_transform =
            static_cast<ViewTransform>(choice_among("--view-transform", texts.view_transform, view_transform_names()));
}
}

RenderRequest make_request(const RenderOptions& texts, const Mode& mode) {
    RenderRequest request;
    request.scene_file = texts.scene;
    request.output = texts.output;
    if (!texts.frames.empty()) request.frames = parse_frames(texts.frames);
    check_pattern(texts.output, ".exr", request.frames.size() > 1);
    request.mode = mode.name;
    request.quality = quality_named(texts.quality);
    request.settings = settings_for(request.quality);
    const bool goal = !texts.target_error.empty() || !texts.time_budget.empty();
    if (error_is_noise(mode) && !goal) request.settings.pixel.samples *= noisy_factor;
    if (!texts.samples.empty())
        request.settings.pixel.samples = static_cast<int>(integer_option("--samples", texts.samples, 1, 4096));
    if (!texts.orders.empty()) read_orders(texts.orders, request);
    for (const std::string& assignment : texts.settings) apply_setting(request.settings, assignment);
    if (!texts.target_error.empty()) {
        request.target_error = number_option("--target-error", texts.target_error, 1e-5, 10);
        check_target(mode);
    }
    if (!texts.time_budget.empty()) {
        request.time_budget = number_option("--time-budget", texts.time_budget, 1e-3, 1e6);
        check_target(mode, "--time-budget");
    }
    if (texts.mode == automatic && !goal) request.target_error = usual_error(request.quality);
    check_samples(request, mode);
    if (!texts.history.empty() && has_goal(request))
        fail(ExitCode::usage, "--history",
             "does not go with --target-error and --time-budget: they measure single frames");
    if (!texts.history.empty()) request.history = static_cast<int>(integer_option("--history", texts.history, 0, 1000));
    request.camera = texts.camera;
    if (!texts.resolution.empty()) request.resolution = resolution_option("--res", texts.resolution);
    if (!texts.crop.empty()) read_crop(texts.crop, request);
    if (!texts.crop.empty() && !texts.resolution.empty()) check_crop(request, request.resolution);
    if (!texts.seed.empty()) request.seed = static_cast<uint32_t>(integer_option("--seed", texts.seed, 0, UINT32_MAX));
    request.missing = static_cast<MissingFrame>(choice_among("--missing", texts.missing, missing_frame_names));
    read_look(texts, request);
    if (!texts.aov.empty()) request.exr.layers = parsed_layers(texts.aov);
    request.background = choice_among("--background", texts.background, {"on", "off"}) == 0;
    if (!request.background && wants_layer(request, "background"))
        fail(ExitCode::usage, "--aov", "there is no layer background with --background off");
    request.exr.full_float = texts.full_float;
    request.png = texts.png, request.resume = texts.resume;
    request.isa = chosen_isa(texts.isa);
    return request;
}

namespace {
// i/N, both from 1.
void read_part_option(const std::string& text, Grouping& grouping) {
    const size_t slash = text.find('/');
    if (slash == text.npos)
        fail(ExitCode::usage, "--part", "expected i/N, 3/8 for instance; got '" + printable(text, 40) + "'");
    grouping.parts = static_cast<int>(integer_option("--part", text.substr(slash + 1), 1, 1 << 16));
    grouping.part = static_cast<int>(integer_option("--part", text.substr(0, slash), 1, grouping.parts));
}

// The options that a plan has decided.
void check_planned(const RenderOptions& texts) {
    const RenderOptions usual;
    const std::tuple<const char*, bool> decided[] = {{"SCENE", !texts.scene.empty()},
                                                     {"--mode", texts.mode != usual.mode},
                                                     {"--quality", texts.quality != usual.quality},
                                                     {"--camera", !texts.camera.empty()},
                                                     {"--res", !texts.resolution.empty()},
                                                     {"--crop", !texts.crop.empty()},
                                                     {"--samples", !texts.samples.empty()},
                                                     {"--light-units", texts.light_units != usual.light_units},
                                                     {"--missing", texts.missing != usual.missing},
                                                     {"--aov", !texts.aov.empty()},
                                                     {"--seed", !texts.seed.empty()},
                                                     {"--isa", texts.isa != usual.isa},
                                                     {"--orders", !texts.orders.empty()},
                                                     {"--target-error", !texts.target_error.empty()},
                                                     {"--time-budget", !texts.time_budget.empty()},
                                                     {"--history", !texts.history.empty()},
                                                     {"--background", texts.background != usual.background},
                                                     {"--set", !texts.settings.empty()},
                                                     {"--float", texts.full_float}};
    for (const auto& [name, given] : decided)
        if (given) fail(ExitCode::usage, name, "the plan has decided it: plan again to change it");
}
}

RenderRequest planned_request(const RenderOptions& texts, SavedPlan& plan) {
    check_planned(texts);
    plan = load_plan(texts.plan);
    RenderRequest request = plan.request;
    use_planned_isa(request.isa);
    request.output = texts.output;
    Grouping& grouping = request.grouping;
    if (!texts.part.empty()) read_part_option(texts.part, grouping);
    if (!texts.more.empty()) {
        const size_t at = texts.more.find('@');
        grouping.more = static_cast<int>(integer_option("--more", texts.more.substr(0, at), 1, 1 << 16));
        grouping.after = grouping.groups;
        if (at != texts.more.npos)
            grouping.after =
                static_cast<int>(integer_option("--more", texts.more.substr(at + 1), grouping.groups, 1 << 20));
        if (texts.part.empty()) grouping.part = grouping.parts = 1;
    }
    if (!texts.checkpoint.empty() && !is_part(grouping)) fail(ExitCode::usage, "--checkpoint", "is for --part");
    if (!texts.checkpoint.empty())
        request.checkpoint_seconds = 60 * number_option("--checkpoint", texts.checkpoint, 0.01, 10000);
    if (is_part(grouping) && texts.png) fail(ExitCode::usage, "--png", "a part is no image: merge shows it");
    if (!texts.frames.empty()) {
        request.frames = parse_frames(texts.frames);
        for (const int frame : request.frames)
            if (!std::ranges::count(plan.request.frames, frame))
                fail(ExitCode::usage, "--frames", formatted("frame %d is not in the plan", frame));
    }
    check_pattern(texts.output, ".exr", request.frames.size() > 1);
    read_look(texts, request);
    request.png = texts.png, request.resume = texts.resume;
    return request;
}

LoadOptions load_options(const RenderOptions& texts) {
    return {static_cast<LightUnits>(choice_among("--light-units", texts.light_units, light_unit_names))};
}
}
