
#include "render/sequence/job.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/frame/frame.h"
#include "scene/camera.h"
#include "scene/input_files.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "trace/shutter_motion.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int largest_side = 16384; // the largest that read_exr accepts

void check_picture(const Scene& scene, const RenderRequest& request) {
    const ivec2 size = request.resolution.x > 0 ? request.resolution : scene.resolution;
    if (size.x < 1 || size.y < 1 || size.x > largest_side || size.y > largest_side)
        fail(ExitCode::usage, "resolution", "expected 1 to 16384 pixels on each side");
    const ivec2 low = request.crop_low, high = request.crop_high;
    if (low == high) return;
    if (low.x < 0 || low.y < 0 || low.x >= high.x || low.y >= high.y || high.x > size.x || high.y > size.y)
        fail(ExitCode::usage, "crop", "must lie inside the image and not be empty");
}
}

void check_outputs(const Scene& scene, const RenderRequest& request, OutputPaths& places) {
    if (request.frames.empty()) fail(ExitCode::usage, "frames", "there is nothing to render");
    if (std::filesystem::path(request.output).extension() != ".exr")
        fail(ExitCode::usage, printable(request.output), "the output must end in .exr");
    if (request.frames.size() > 1 && !has_frame_token(request.output))
        fail(ExitCode::usage, printable(request.output),
             "several frames need a frame number in the name, like name.####.exr");
    places.check(request.output, request.frames);
    if (request.png)
        for (const int frame : request.frames) places.check(png_name(frame_name(request.output, frame)));
    spare_files(scene, places);
}

void check_job(const Scene& scene, const RenderRequest& request, const Mode& mode, OutputPaths& places) {
    check_layer_names(request.exr);
    check_picture(scene, request);
    find_camera(scene, request.camera);
    if (request.time_budget > 0) check_target(mode, "--time-budget");
    if (request.target_error > 0) check_target(mode);
    if (mode.surfaces == Surfaces::post && measures_noise(request))
        fail(ExitCode::usage, "--aov",
             std::string(mode.name) + " works on the finished image: variance and halves are not available");
    if (request.history > 0 && shutter_of(scene, request))
        fail(ExitCode::usage, "--history", "cannot be combined with an open shutter: add --shutter 0,0");
    check_outputs(scene, request, places);
}

RenderPlan requested_plan(const RenderRequest& request) {
    return {&find_mode(request.mode), request.settings, {}, {}, {}, {}};
}

bool has_goal(const RenderRequest& request) {
    return request.grouping.groups == 0 && (request.target_error > 0 || request.time_budget > 0);
}

bool measures_noise(const RenderRequest& request) {
    return wants_layer(request, "variance") || wants_layer(request, "halves");
}

std::vector<std::string> drop_absent_layers(const Scene& scene, const RenderPlan& plan, RenderRequest& request) {
    const auto lit = [](const Keyed<vec3>& color) {
        return std::ranges::any_of(color.values, [](vec3 value) { return value != vec3(0); });
    };
    const bool surfaces_glow =
        std::ranges::any_of(scene.materials, [](const Material& material) { return material.emission != vec3(0); });
    const bool fog_glows = std::ranges::any_of(scene.media, emits_light);
    const auto has = [&](std::string_view layer) {
        if (layer == "ambient") return !scene.media.empty() && (scene.environment || lit(scene.ambient));
        if (layer == "emission") return fog_glows || (!scene.media.empty() && surfaces_glow);
        return layer != "multiple" || (plan.mode->adds_fluence && plan.settings.fluence.orders > 1);
    };
    std::vector<std::string> dropped;
    std::erase_if(request.exr.layers, [&](const std::string& layer) {
        if (!has(layer)) dropped.push_back(layer);
        return !has(layer);
    });
    return dropped;
}

bool wants_layer(const RenderRequest& request, std::string_view layer) {
    return std::ranges::count(request.exr.layers, layer) > 0;
}

Shutter shutter_of(const Scene& scene, const RenderRequest& request) {
    // A camera moved by hand is not one of the scene's and has no shutter of its own.
    const bool own =
        request.camera.empty() || std::ranges::count(scene.cameras, request.camera, &CameraSource::name) > 0;
    if (!own) return request.shutter.value_or(Shutter{});
    Shutter shutter = scene.cameras[static_cast<size_t>(find_camera(scene, request.camera))].shutter;
    if (!request.shutter) return shutter;
    shutter.open = request.shutter->open, shutter.close = request.shutter->close;
    if (!request.shutter->curve.empty()) shutter.curve = request.shutter->curve;
    return shutter;
}

int frame_before(const Scene& scene, int frame, int back) {
    return std::max(frame - back, std::min(scene.first_frame, frame));
}

namespace {
ivec2 size_of(const Scene& scene, const RenderRequest& request) {
    return request.resolution.x > 0 ? request.resolution : scene.resolution;
}

// Whether the mode stores data per pixel and light.
bool keeps_images(const RenderRequest& request) { return request.mode_open || find_mode(request.mode).uses_history; }
}

FrameMoments moments_of(const Scene& scene, const RenderRequest& request, int frame) {
    const Shutter shutter = shutter_of(scene, request);
    const int camera = find_camera(scene, request.camera);
    if (!moves_while_open(scene, camera, shutter)) return frame_moments(scene, frame, shutter, 1);
    const int finer = request.target_error > 0 ? 2 : 1; // the error left by half of them is part of the target error
    const int count = request.time_samples > 0 ? request.time_samples
                                               : auto_moments(scene, camera, size_of(scene, request), frame, shutter,
                                                              keeps_images(request), finer);
    return frame_moments(scene, frame, shutter, count);
}

int moment_limit(const Scene& scene, const RenderRequest& request, int frame) {
    const Shutter shutter = shutter_of(scene, request);
    if (request.time_samples > 0 || !shutter) return 0;
    return affordable_moments(scene, find_camera(scene, request.camera), size_of(scene, request), frame, shutter,
                              keeps_images(request));
}

namespace {
std::shared_ptr<const OpenShutter> open_shutter(const Scene& scene, const RenderRequest& request, int camera,
                                                ivec2 size, int frame, const FrameMoments& moments) {
    if (moments.moments.empty()) return nullptr;
    auto shutter = std::make_shared<OpenShutter>();
    for (const Moment& moment : moments.moments) shutter->cameras.push_back(camera_at(scene, camera, moment.seconds));
    shutter->motion = image_motion(scene, camera, size, frame, shutter_of(scene, request));
    return shutter;
}
}

View view_of(const Scene& scene, const RenderRequest& request, const Settings& settings, int frame) {
    View view;
    const FrameMoments moments = moments_of(scene, request, frame);
    const int camera = find_camera(scene, request.camera);
    view.camera = camera_at(scene, camera, moments.middle.seconds);
    view.size = size_of(scene, request);
    view.shutter = open_shutter(scene, request, camera, view.size, frame, moments);
    view.crop_low = request.crop_low, view.crop_high = request.crop_high;
    view.pixel_samples = settings.pixel.samples;
    view.filter = settings.pixel.filter, view.filter_radius = settings.pixel.filter_radius;
    view.lamp_samples = settings.pixel.lamp_samples, view.edge_samples = settings.pixel.edge_samples;
    view.jitter = settings.pixel.jitter, view.background = request.background;
    for (const char* layer : {"surface", "background"}) view.surface_parts |= wants_layer(request, layer);
    for (const char* layer : {"lights", "ambient", "emission", "multiple"})
        view.fog_parts |= wants_layer(request, layer);
    view.seed = request.seed, view.frame = frame, view.has_history = request.history > 0;
    const Grouping& grouping = request.grouping;
    if (grouping.groups > 0)
        view.batches = grouping.groups, view.sections = grouping.sections, view.leaves = grouping.leaves,
        view.allotted = grouping.counts;
    else if (measures_noise(request))
        view.batches = noise_batches, view.pixel_samples = batched_samples(view.pixel_samples);
    return view;
}
}
