// Turns the options of tyndall render into requests.
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/parts/plan_file.h"
#include "rendering/automatic.h"
#include "rendering/render_options.h"
#include "trace/shutter_motion.h"

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
             "X1,Y1 must lie to the right of and below X0,Y0; got '" + printable(text, 40) + "'");
}

// Layers beside RGBA, from --aov.
std::vector<std::string> parsed_layers(const std::string& text) {
    if (text == "none") return {};
    const std::vector<std::string>& known = layer_names();
    std::vector<std::string> layers;
    for (const std::string& name : comma_list(text)) layers.push_back(known[choice_among("--aov", name, known)]);
    return layers;
}

// Factor on the quality's sample count for a mode whose only error is noise.
constexpr int noisy_factor = 16;

// --orders, for modes that render multiple scattering.
void read_orders(const std::string& text, RenderRequest& request) {
    const int orders = text == "all" ? all_orders : static_cast<int>(integer_option("--orders", text, 1, all_orders));
    if (find_mode(request.mode).accuracy == Accuracy::multiple_scattering)
        request.settings.path.orders = orders;
    else if (find_mode(request.mode).adds_fluence)
        request.settings.fluence.orders = orders;
    else if (orders > 1)
        fail(ExitCode::usage, "--orders",
             request.mode + " scatters light once only; --mode march, froxel and path support more");
}

// Throws Error (usage) for a sample count together with a goal, which determines it; without a time budget, path takes
// one to start from.
void check_samples(const RenderRequest& request, const Mode& mode) {
    if (!has_goal(request) || (is_unbiased(mode) && request.time_budget == 0)) return;
    if (request.settings.pixel.samples != settings_for(request.quality).pixel.samples)
        fail(ExitCode::usage, "--samples",
             std::string(request.time_budget > 0 ? "--time-budget" : "--target-error") +
                 " already decides how many rays a pixel takes");
}
}

namespace {
Shutter shutter_option(const std::string& text) {
    constexpr double most = 100; // frames, as in the scene file
    const std::vector<std::string> times = comma_list(text);
    if (times.size() != 2)
        fail(ExitCode::usage, "--shutter", "expected OPEN,CLOSE in frames; got '" + printable(text, 40) + "'");
    const Shutter shutter{
        number_option("--shutter", times[0], -most, most), number_option("--shutter", times[1], -most, most), {}};
    if (shutter.close < shutter.open)
        fail(ExitCode::usage, "--shutter", "runs backwards: it closes before it opens: '" + printable(text, 40) + "'");
    return shutter;
}
}

void check_crop(const RenderRequest& request, ivec2 picture) {
    if (request.crop_high.x > picture.x || request.crop_high.y > picture.y)
        fail(ExitCode::usage, "--crop", formatted("reaches beyond the image of %dx%d pixels", picture.x, picture.y));
}

std::vector<const Mode*> modes_option(std::string_view option, const std::string& text) {
    std::vector<const Mode*> result;
    if (text == "all") {
        for (const Mode& mode : modes()) result.push_back(&mode);
        return result;
    }
    for (const std::string& name : comma_list(text)) {
        if (name == automatic)
            fail(ExitCode::usage, option, "auto chooses the mode itself; do not combine it with others");
        const Mode& mode = find_mode(name, option);
        if (std::ranges::count(result, &mode)) fail(ExitCode::usage, option, name + " is named twice");
        result.push_back(&mode);
    }
    return result;
}

namespace {
void read_look(const RenderOptions& args, RenderRequest& request) {
    for (const auto& [name, text] :
         {std::pair{"--exposure", &args.exposure}, {"--view-transform", &args.view_transform}})
        if (!text->empty() && !args.png)
            fail(ExitCode::usage, name, "applies to PNGs only, EXR files store light unchanged: add --png");
    request.automatic_exposure = args.exposure == automatic;
    if (!args.exposure.empty() && !request.automatic_exposure)
        request.exposure = number_option("--exposure", args.exposure, -100, 100);
    if (!args.view_transform.empty())
        request.view_transform =
            static_cast<ViewTransform>(choice_among("--view-transform", args.view_transform, view_transform_names()));
}
}

RenderRequest make_request(const RenderOptions& args, const Mode& mode) {
    RenderRequest request;
    request.scene_file = args.scene;
    request.output = args.output;
    if (!args.frames.empty()) request.frames = parse_frames(args.frames);
    check_pattern(args.output, ".exr", request.frames.size() > 1);
    request.mode = mode.name;
    request.quality = quality_named(args.quality);
    request.settings = settings_for(request.quality);
    const bool goal = !args.target_error.empty() || !args.time_budget.empty();
    if (is_unbiased(mode) && !goal) request.settings.pixel.samples *= noisy_factor;
    if (!args.samples.empty())
        request.settings.pixel.samples = static_cast<int>(integer_option("--samples", args.samples, 1, 4096));
    if (!args.orders.empty()) read_orders(args.orders, request);
    for (const std::string& assignment : args.settings) apply_setting(request.settings, assignment);
    if (!args.target_error.empty()) {
        request.target_error = number_option("--target-error", args.target_error, 1e-5, 10);
        check_target(mode);
    }
    if (!args.time_budget.empty()) {
        request.time_budget = number_option("--time-budget", args.time_budget, 1e-3, 1e6);
        check_target(mode, "--time-budget");
    }
    if (args.mode == automatic && !goal) request.target_error = default_error(request.quality);
    check_samples(request, mode);
    if (!args.history.empty() && has_goal(request))
        fail(ExitCode::usage, "--history",
             "cannot be combined with --target-error and --time-budget: they measure single frames");
    if (!args.history.empty()) request.history = static_cast<int>(integer_option("--history", args.history, 0, 1000));
    if (!args.shutter.empty()) request.shutter = shutter_option(args.shutter);
    if (!args.time_samples.empty())
        request.time_samples = static_cast<int>(integer_option("--time-samples", args.time_samples, 1, max_moments));
    request.camera = args.camera;
    if (!args.resolution.empty()) request.resolution = resolution_option("--res", args.resolution);
    if (!args.crop.empty()) read_crop(args.crop, request);
    if (!args.crop.empty() && !args.resolution.empty()) check_crop(request, request.resolution);
    if (!args.seed.empty()) request.seed = static_cast<uint32_t>(integer_option("--seed", args.seed, 0, UINT32_MAX));
    request.missing = static_cast<MissingFrame>(choice_among("--missing", args.missing, missing_frame_names));
    read_look(args, request);
    if (!args.aov.empty()) request.exr.layers = parsed_layers(args.aov);
    request.background = choice_among("--background", args.background, {"on", "off"}) == 0;
    if (!request.background && wants_layer(request, "background"))
        fail(ExitCode::usage, "--aov", "the layer background is not available with --background off");
    request.exr.full_float = args.full_float;
    request.png = args.png, request.resume = args.resume;
    request.isa = select_isa(args.isa);
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

// Throws Error (usage) for options that a plan fixes.
void check_planned(const RenderOptions& args) {
    const RenderOptions usual;
    const std::tuple<const char*, bool> decided[] = {{"SCENE", !args.scene.empty()},
                                                     {"--mode", args.mode != usual.mode},
                                                     {"--quality", args.quality != usual.quality},
                                                     {"--camera", !args.camera.empty()},
                                                     {"--res", !args.resolution.empty()},
                                                     {"--crop", !args.crop.empty()},
                                                     {"--samples", !args.samples.empty()},
                                                     {"--light-units", args.light_units != usual.light_units},
                                                     {"--missing", args.missing != usual.missing},
                                                     {"--aov", !args.aov.empty()},
                                                     {"--seed", !args.seed.empty()},
                                                     {"--isa", args.isa != usual.isa},
                                                     {"--orders", !args.orders.empty()},
                                                     {"--target-error", !args.target_error.empty()},
                                                     {"--time-budget", !args.time_budget.empty()},
                                                     {"--history", !args.history.empty()},
                                                     {"--shutter", !args.shutter.empty()},
                                                     {"--time-samples", !args.time_samples.empty()},
                                                     {"--background", args.background != usual.background},
                                                     {"--set", !args.settings.empty()},
                                                     {"--float", args.full_float}};
    for (const auto& [name, given] : decided)
        if (given) fail(ExitCode::usage, name, "is fixed by the plan: plan again to change it");
}
}

RenderRequest planned_request(const RenderOptions& args, SavedPlan& plan) {
    check_planned(args);
    plan = load_plan(args.plan);
    RenderRequest request = plan.request;
    use_planned_isa(request.isa);
    request.output = args.output;
    Grouping& grouping = request.grouping;
    if (!args.part.empty()) read_part_option(args.part, grouping);
    if (!args.more.empty()) {
        const size_t at = args.more.find('@');
        grouping.more = static_cast<int>(integer_option("--more", args.more.substr(0, at), 1, 1 << 16));
        grouping.after = grouping.groups;
        if (at != args.more.npos)
            grouping.after =
                static_cast<int>(integer_option("--more", args.more.substr(at + 1), grouping.groups, 1 << 20));
        if (args.part.empty()) grouping.part = grouping.parts = 1;
    }
    if (!args.checkpoint.empty() && !is_part(grouping)) fail(ExitCode::usage, "--checkpoint", "needs --part or --more");
    if (!args.checkpoint.empty())
        request.checkpoint_seconds = 60 * number_option("--checkpoint", args.checkpoint, 0.01, 10000);
    if (is_part(grouping) && args.png)
        fail(ExitCode::usage, "--png", "a part is not an image; tyndall merge --png writes the frame's");
    if (!args.frames.empty()) {
        request.frames = parse_frames(args.frames);
        for (const int frame : request.frames)
            if (!std::ranges::count(plan.request.frames, frame))
                fail(ExitCode::usage, "--frames", formatted("frame %d is not in the plan", frame));
    }
    check_pattern(args.output, ".exr", request.frames.size() > 1);
    read_look(args, request);
    request.png = args.png, request.resume = args.resume;
    return request;
}

LoadOptions load_options(const RenderOptions& args) {
    return {static_cast<LightUnits>(choice_among("--light-units", args.light_units, light_unit_names))};
}
}
