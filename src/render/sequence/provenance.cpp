// Hashes and header texts of a frame.
#include "render/sequence/provenance.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/text.h"
#include "integrate/style.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "render/sequence/job.h"
#include "scene/camera.h"
#include "scene/input_files.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <algorithm>
#include <cstdlib>

namespace tyndall {
namespace {
std::string number(double value) { return formatted("%.9g", value); }
std::string numbers(vec3 v) { return number(v.x) + "," + number(v.y) + "," + number(v.z); }
std::string pair_text(ivec2 v, const char* between) { return std::to_string(v.x) + between + std::to_string(v.y); }

// The scene's own files as they were when it was loaded; sequences of volumes and gobos are hashed by frame.
std::string scene_text(const Scene& scene) {
    std::string text;
    for (const InputFile& input : scene.inputs) text += "input=" + input.hash + "\n";
    return text;
}

std::string fog_text(const Scene& scene, const RenderRequest& request, int frame, FileHashes& files) {
    std::string text;
    for (const FrameFile& file : frame_files(scene, frame, request.missing, shutter_of(scene, request)))
        text +=
            (file.volume ? "fog=" : "gobo=") + (file.path ? file_hash(*file.path, files) : std::string("none")) + "\n";
    return text;
}

// Lights as they were loaded: the unit they were read in is not in the files.
std::string light_text(const Scene& scene, double seconds) {
    std::string text;
    for (const LightSource& light : scene.lights)
        text += "light=" + light.name + " " + numbers(light.color.at(seconds) * light.intensity.at(seconds)) + "\n";
    return text;
}

std::string lens_text(const Lens& lens) {
    return number(lens.radius) + " " + number(lens.focus) + " " + std::to_string(lens.blades) + " " +
           number(lens.rotation);
}

std::string camera_text(const Camera& camera) {
    return numbers(camera.position) + " " + numbers(camera.right) + " " + numbers(camera.up) + " " +
           number(camera.vertical_fov) + " " + number(camera.ortho_height) + " " + number(camera.near) + " " +
           number(camera.far) + (camera.lens ? " lens " + lens_text(camera.lens) : "");
}

std::string settings_text(const Settings& settings) {
    std::string text;
    for (const SettingRow& row : setting_rows()) text += (text.empty() ? "" : " ") + row.name + "=" + row.get(settings);
    return text;
}

std::string joined_layers(const ExrOptions& options) {
    std::string text;
    for (const std::string& layer : options.layers) text += (text.empty() ? "" : ",") + layer;
    return text.empty() ? "none" : text;
}

// All options of tyndall render except scene, output, frames and image size.
std::string option_text(const RenderRequest& request, const Settings& settings) {
    std::string text = " --seed " + std::to_string(request.seed) + " --aov " + joined_layers(request.exr);
    if (request.exr.full_float) text += " --float";
    if (!request.background) text += " --background off";
    if (request.target_error > 0) text += " --target-error " + number(request.target_error);
    if (request.time_budget > 0) text += " --time-budget " + number(request.time_budget);
    if (request.history > 0) text += " --history " + std::to_string(request.history);
    if (request.shutter) text += " --shutter " + number(request.shutter->open) + "," + number(request.shutter->close);
    if (request.time_samples > 0) text += " --time-samples " + std::to_string(request.time_samples);
    if (!request.isa.empty()) text += " --isa " + request.isa;
    if (!request.camera.empty()) text += " --camera " + quoted_for_shell(request.camera);
    if (request.crop_low != request.crop_high)
        text += " --crop " + pair_text(request.crop_low, ",") + "," + pair_text(request.crop_high, ",");
    if (request.missing != MissingFrame::error)
        text += " --missing " + missing_frame_names[static_cast<size_t>(request.missing)];
    if (request.light_units != LightUnits::spec)
        text += " --light-units " + light_unit_names[static_cast<size_t>(request.light_units)];

    const Settings usual = settings_for(request.quality);
    // The default number of samples depends on the mode, so it is always stated.
    for (const SettingRow& row : setting_rows())
        if (row.get(settings) != row.get(usual) || (row.name == "pixel.samples" && !has_goal(request)))
            text += " --set " + row.name + "=" + row.get(settings);
    return text;
}

std::string mode_text(const std::string& mode, Quality quality) {
    return " --mode " + mode + " --quality " + std::string(name_of(quality));
}

// Scene and output of a command.
struct Names {
    std::filesystem::path scene, output;
};

std::filesystem::path common_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::filesystem::path common;
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end() && *i == *j; ++i, ++j) common /= *i;
    return common;
}

// Paths relative to the working folder, or else to the deepest folder that holds both; otherwise each one's folder and
// name. Folders above them are private and stay out of the image.
Names names_of(const RenderRequest& request) {
    std::error_code ignored;
    const std::filesystem::path here = std::filesystem::current_path(ignored);
    const std::filesystem::path scene = (here / request.scene_file).lexically_normal();
    const std::filesystem::path output = (here / request.output).lexically_normal();
    for (const std::filesystem::path& base : {here, common_folder(scene.parent_path(), output.parent_path())}) {
        const Names names{scene.lexically_relative(base), output.lexically_relative(base)};
        const auto inside = [](const std::filesystem::path& name) { return !name.empty() && *name.begin() != ".."; };
        if (base.has_relative_path() && inside(names.scene) && inside(names.output)) return names;
    }
    const auto short_name = [](const std::filesystem::path& path) {
        return path.parent_path().filename() / path.filename();
    };
    return {short_name(scene), short_name(output)};
}

std::string command_text(const Names& names, const RenderRequest& request, const RenderPlan& plan, const View& view) {
    return "tyndall render " + quoted_for_shell(names.scene.string()) + " -o " +
           quoted_for_shell(names.output.string()) + " --frames " + std::to_string(view.frame) +
           mode_text(std::string(plan.mode->name), request.quality) + " --res " + pair_text(view.size, "x") +
           option_text(request, plan.settings);
}
}

std::string command_line(const RenderRequest& request) {
    std::string text = "tyndall render " + quoted_for_shell(request.scene_file.string()) + " -o " +
                       quoted_for_shell(request.output) + " --frames " + format_frames(request.frames) +
                       mode_text(request.mode, request.quality);
    if (request.resolution.x > 0) text += " --res " + pair_text(request.resolution, "x");
    text += option_text(request, request.settings);
    if (request.png) text += " --png";
    if (request.png && request.automatic_exposure) text += " --exposure auto";
    if (request.png && request.exposure) text += " --exposure " + number(*request.exposure);
    if (request.png && request.view_transform != ViewTransform::filmic)
        text += " --view-transform " + name_of(request.view_transform);
    return text;
}

void hash_fog(const Scene& scene, const RenderRequest& request, int frame, FileHashes& files) {
    fog_text(scene, request, frame, files);
}

std::string frame_hash(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, const View& view,
                       FileHashes& files) {
    const double seconds = moment_of(scene, view.frame).seconds;
    const Names names{request.scene_file.filename(), "out.####.exr"}; // independent of folder and output
    std::string text = "version=" TYNDALL_VERSION "\n" + command_text(names, request, plan, view) + "\n" +
                       settings_text(plan.settings);
    text += "\nrate=" + number(scene.frame_rate) + "\ncamera=" + camera_text(view.camera) + "\n";
    text += request.exr.full_float ? "float\n" : "half\n";
    text += scene_text(scene) + light_text(scene, seconds);
    for (int back = request.history; back >= 0; --back)
        text += fog_text(scene, request, frame_before(scene, view.frame, back), files);
    if (!request.grouping.plan_hash.empty()) text += "plan=" + request.grouping.plan_hash + "\n";
    if (!request.unsaved.empty()) text += "edits=" + request.unsaved + "\n";
    return content_hash(text);
}

Provenance provenance_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, const View& view,
                         const std::string& hash, const FrameStats& stats) {
    Provenance result{view.camera, scene.frame_rate, view.frame, {}};
    auto& attributes = result.attributes;
    attributes["tyndall:version"] = TYNDALL_VERSION;
    attributes["tyndall:scene"] = request.scene_file.filename().string();
    attributes["tyndall:camera"] = view.camera.name;
    attributes["tyndall:mode"] = plan.mode->name;
    attributes["tyndall:quality"] = name_of(request.quality);
    attributes["tyndall:settings"] = settings_text(stats.integrator ? stats.integrator->settings : plan.settings);
    attributes["tyndall:seed"] = std::to_string(request.seed);
    attributes["tyndall:isa"] = request.isa;
    attributes["tyndall:command"] = command_text(names_of(request), request, plan, view);
    attributes["tyndall:hash"] = hash;
    attributes["tyndall:nonFinite"] = std::to_string(stats.non_finite);
    if (stats.non_finite) attributes["tyndall:firstNonFinite"] = pair_text(stats.first_non_finite, ",");
    if (is_stylized(plan.settings.style) && honors_style(*plan.mode)) attributes["stylized"] = "1";
    if (plan.missed) attributes["tyndall:plannedMode"] = plan.missed->name;
    if (view.shutter) attributes["tyndall:timeSamples"] = std::to_string(view.shutter->cameras.size());
    if (stats.noise) {
        attributes["tyndall:samples"] = std::to_string(stats.samples);
        attributes["tyndall:achievedError"] = number(stats.error()->error);
        attributes["tyndall:errorBound"] = number(stats.error()->bound);
    }
    if (stats.noise && !stats.is_noise_alone()) {
        attributes["tyndall:noiseError"] = number(stats.noise->error);
        attributes["tyndall:noiseBound"] = number(stats.noise->bound);
    }
    if (stats.integrator) {
        attributes["tyndall:candidate"] = stats.integrator->candidate;
        attributes["tyndall:integratorError"] = number(stats.integrator->error.error);
        attributes["tyndall:integratorBound"] = number(stats.integrator->error.bound);
    }
    if (stats.orders) {
        attributes["tyndall:ordersError"] = number(stats.orders->pixels.error);
        attributes["tyndall:ordersBound"] = number(stats.orders->pixels.bound);
        attributes["tyndall:ordersMean"] = number(stats.orders->mean.error);
        attributes["tyndall:ordersMeanBound"] = number(stats.orders->mean.bound);
    }
    if (stats.moments_error) {
        attributes["tyndall:momentsError"] = number(stats.moments_error->error);
        attributes["tyndall:momentsBound"] = number(stats.moments_error->bound);
    }
    if (request.target_error > 0) attributes["tyndall:targetError"] = number(request.target_error);
    if (request.time_budget > 0) {
        attributes["tyndall:timeBudget"] = number(request.time_budget);
        attributes["tyndall:timeUsed"] = number(stats.goal_seconds);
    }
    if (!request.unsaved.empty()) attributes["tyndall:unsavedEdits"] = request.unsaved;
    if (!plan.certificate.empty()) attributes["tyndall:plan"] = plan.certificate;
    if (!request.grouping.plan_hash.empty()) attributes["tyndall:planHash"] = request.grouping.plan_hash;
    return result;
}

void read_noise(const std::map<std::string, std::string>& attributes, FrameStats& stats) {
    const auto value = [&](const char* name) {
        const auto found = attributes.find(name);
        return found == attributes.end() ? -1 : std::strtod(found->second.c_str(), nullptr);
    };
    stats.non_finite = static_cast<uint64_t>(std::clamp(value("tyndall:nonFinite"), 0.0, 1e18));
    stats.goal_seconds = std::max(value("tyndall:timeUsed"), 0.0);
    const Noise integrator{value("tyndall:integratorError"), value("tyndall:integratorBound")};
    const bool parts = attributes.contains("tyndall:noiseError");
    const Noise noise{value(parts ? "tyndall:noiseError" : "tyndall:achievedError"),
                      value(parts ? "tyndall:noiseBound" : "tyndall:errorBound")};
    if (noise.error < 0 || noise.bound < 0) return;
    stats.noise = noise;
    if (integrator.error >= 0 && integrator.bound >= 0 && attributes.contains("tyndall:candidate"))
        stats.integrator = {integrator, attributes.at("tyndall:candidate"), {}};
    const Noise orders{value("tyndall:ordersError"), value("tyndall:ordersBound")};
    const Noise mean{value("tyndall:ordersMean"), value("tyndall:ordersMeanBound")};
    if (orders.error >= 0 && orders.bound >= 0 && mean.bound >= 0) stats.orders = OrdersError{mean, orders};
    const Noise moments{value("tyndall:momentsError"), value("tyndall:momentsBound")};
    if (moments.error >= 0 && moments.bound >= 0) stats.moments_error = moments;
    stats.samples = static_cast<int>(std::clamp(value("tyndall:samples"), 0.0, 1e9));
}
}
