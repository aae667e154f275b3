#include "render/parts/plan_file.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/file_hashes.h"
#include "base/io/frames.h"
#include "base/json/json_values.h"
#include "base/text.h"
#include "modes/mode.h"
#include "plan_schema.h"
#include "render/parts/counts_file.h"
#include "scene/scene.h"

#include <algorithm>
#include <bit>

namespace tyndall {
namespace {
constexpr int max_leaves = 64, max_sections = 8; // in all groups together; in a single group

Json settings_json(const Settings& settings) {
    JsonMembers members;
    for (const SettingRow& row : setting_rows()) members.emplace_back(row.name, std::string_view(row.get(settings)));
    return json_object(std::move(members));
}

// The scene's path relative to the plan's folder.
std::string scene_name(const std::filesystem::path& scene, const std::filesystem::path& plan) {
    return normal_path(scene).lexically_relative(normal_path(plan).parent_path()).string();
}

Json error_json(const Noise& error) { return std::vector{error.error, error.bound}; }

// For a plan whose error decides the number of samples; writes the counts next to the plan.
Json target_json(const std::filesystem::path& file, const Grouping& grouping) {
    const std::filesystem::path counts = std::filesystem::path(file).replace_extension(".counts");
    const PlannedError& planned = grouping.error;
    return json_object({{"error", planned.target},
                        {"counts", counts.filename().string()},
                        {"counts_hash", save_counts(counts, *grouping.counts)},
                        {"truth", planned.is_truth}});
}

JsonMembers plan_json(const std::filesystem::path& file, const Scene& scene, const SavedPlan& saved) {
    const RenderRequest& request = saved.request;
    const ivec2 size = request.resolution.x > 0 ? request.resolution : scene.resolution;
    const ivec2 low = request.crop_low, high = request.crop_high;
    return {{"tyndall_plan", 1},
            {"version", TYNDALL_VERSION},
            {"build", saved.build},
            {"isa", request.isa},
            {"scene", scene_name(request.scene_file, file)},
            {"inputs", json_list(scene.inputs, [](const InputFile& input) { return Json(input.hash); })},
            {"frames", format_frames(request.frames)},
            {"mode", saved.plan.mode->name},
            {"quality", name_of(request.quality)},
            {"settings", settings_json(saved.plan.settings)},
            {"camera", request.camera},
            {"resolution", size},
            {"crop", std::vector{low.x, low.y, high.x, high.y}},
            {"seed", request.seed},
            {"missing", missing_frame_names[static_cast<size_t>(request.missing)]},
            {"light_units", light_unit_names[static_cast<size_t>(request.light_units)]},
            {"layers", json_list(request.exr.layers, [](const std::string& layer) { return Json(layer); })},
            {"float", request.exr.full_float},
            {"background", request.background},
            {"groups", request.grouping.groups},
            {"sections", request.grouping.sections},
            {"leaves", request.grouping.leaves}};
}

size_t index_in(const std::vector<std::string>& names, const std::string& name) {
    return static_cast<size_t>(std::ranges::find(names, name) - names.begin());
}

int integer(const Json& value) { return static_cast<int>(value.number); }

Noise error_of(const Json& pair) { return {pair.items[0].number, pair.items[1].number}; }

void read_target(const Json& target, const std::filesystem::path& file, RenderRequest& request) {
    PlannedError& planned = request.grouping.error;
    planned.target = request.target_error = target.number_or("error", 0),
    planned.is_truth = target.boolean_or("truth", false);
    request.grouping.counts =
        load_counts(file.parent_path() / target.string_or("counts", ""), target.string_or("counts_hash", ""));
}

RenderRequest request_of(const Json& json, const std::filesystem::path& file) {
    RenderRequest request;
    request.scene_file = (file.parent_path() / json.string_or("scene", "")).lexically_normal();
    request.frames = parse_frames(json.string_or("frames", ""));
    request.mode = json.string_or("mode", "");
    request.quality = quality_named(json.string_or("quality", ""));
    for (const auto& [name, value] : json.find("settings")->members)
        apply_setting(request.settings, name + "=" + value.string);
    request.camera = json.string_or("camera", "");
    const auto& size = json.find("resolution")->items;
    request.resolution = {integer(size[0]), integer(size[1])};
    const auto& crop = json.find("crop")->items;
    request.crop_low = {integer(crop[0]), integer(crop[1])}, request.crop_high = {integer(crop[2]), integer(crop[3])};
    request.seed = static_cast<uint32_t>(json.number_or("seed", 0));
    request.isa = json.string_or("isa", "");
    request.missing = static_cast<MissingFrame>(index_in(missing_frame_names, json.string_or("missing", "")));
    request.light_units = static_cast<LightUnits>(index_in(light_unit_names, json.string_or("light_units", "")));
    request.exr.layers.clear();
    for (const Json& layer : json.find("layers")->items) request.exr.layers.push_back(layer.string);
    check_layer_names(request.exr);
    request.exr.full_float = json.boolean_or("float", false);
    request.background = json.boolean_or("background", true);
    if (const Json* shutter = json.find("shutter"))
        request.shutter = Shutter{shutter->items[0].number, shutter->items[1].number, {}};
    request.time_samples = static_cast<int>(json.number_or("time_samples", 0));
    request.grouping.groups = static_cast<int>(json.number_or("groups", 1));
    request.grouping.sections = static_cast<int>(json.number_or("sections", 1));
    request.grouping.leaves = static_cast<int>(json.number_or("leaves", 1));
    request.grouping.plan_file = file;
    if (const Json* integrator = json.find("integrator"))
        request.grouping.error.integrator = {error_of(*integrator), json.string_or("candidate", ""), request.settings};
    const Json *orders = json.find("orders"), *orders_mean = json.find("orders_mean");
    if (orders && orders_mean) request.grouping.error.orders = OrdersError{error_of(*orders_mean), error_of(*orders)};
    if (const Json* moments = json.find("moments")) request.grouping.error.moments = error_of(*moments);
    return request;
}

// Reports errors as those of the file, not of the command line.
RenderRequest checked_request(const Json& json, const std::filesystem::path& file) {
    try {
        RenderRequest request = request_of(json, file);
        find_mode(request.mode);
        const Grouping& grouping = request.grouping;
        if (request.settings.pixel.samples % (grouping.groups * grouping.sections) != 0)
            refuse("/settings/pixel.samples",
                   formatted("expected a multiple of %d (groups times sections)", grouping.groups * grouping.sections));
        return request;
    } catch (const Error& error) {
        refuse(file.string(), error.what());
    }
}
}

int leaves_for(int sections, double samples) {
    const int most = std::max(static_cast<int>(std::min(samples, 1.0 * max_leaves)) / sections, 1);
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(most)));
}

Grouping grouping_of(int& samples, int groups) {
    Grouping grouping;
    grouping.groups = std::min(samples, groups);
    if (grouping.groups == 1)
        grouping.sections = std::min(max_sections, static_cast<int>(std::bit_ceil(static_cast<unsigned>(samples))));
    const int unit = grouping.groups * grouping.sections;
    samples = (samples + unit - 1) / unit * unit;
    grouping.leaves = leaves_for(unit, samples);
    return grouping;
}

std::string build_name() {
    static const std::string name = content_hash(read_file("/proc/self/exe", uint64_t{1} << 30));
    return name;
}

void save_plan(const std::filesystem::path& file, const Scene& scene, const SavedPlan& plan) {
    JsonMembers members = plan_json(file, scene, plan);
    const PlannedError& error = plan.request.grouping.error;
    if (error.integrator) {
        members.emplace_back("candidate", error.integrator->candidate);
        members.emplace_back("integrator", error_json(error.integrator->error));
    }
    if (const std::optional<OrdersError>& orders = error.orders) {
        members.emplace_back("orders", error_json(orders->pixels));
        members.emplace_back("orders_mean", error_json(orders->mean));
    }
    if (error.moments) members.emplace_back("moments", error_json(*error.moments));
    if (const std::optional<Shutter>& shutter = plan.request.shutter)
        members.emplace_back("shutter", std::vector{shutter->open, shutter->close});
    if (plan.request.time_samples > 0) members.emplace_back("time_samples", plan.request.time_samples);
    if (!plan.plan.certificate.empty()) members.emplace_back("certificate", plan.plan.certificate);
    if (plan.request.grouping.counts) members.emplace_back("target", target_json(file, plan.request.grouping));
    write_file_atomically(file, json_line(std::move(members)));
}

SavedPlan load_plan(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    const Json json = parse_json(text, file.string());
    check_schema(json, plan_schema, file.string());
    SavedPlan plan{checked_request(json, file), {}, {}, json.string_or("build", "")};
    if (const Json* target = json.find("target")) read_target(*target, file, plan.request);
    if (const std::string version = json.string_or("version", ""); version != TYNDALL_VERSION)
        refuse(file.string() + ": /version",
               "made by Tyndall " + printable(version, 20) + "; this is " TYNDALL_VERSION);
    if (plan.build != build_name())
        refuse(file.string() + ": /build",
               "made by another build of this version, whose results may differ: plan again, or use that build");
    for (const Json& input : json.find("inputs")->items) plan.inputs.push_back(input.string);
    plan.request.grouping.plan_hash = content_hash(text);
    plan.plan = requested_plan(plan.request);
    plan.plan.certificate = json.string_or("certificate", "");
    return plan;
}

void check_inputs(const SavedPlan& plan, const Scene& scene) {
    const auto same = [](const std::string& hash, const InputFile& input) { return hash == input.hash; };
    if (std::ranges::equal(plan.inputs, scene.inputs, same)) return;
    std::string changed = scene.file.string();
    for (size_t i = 0; i < std::min(plan.inputs.size(), scene.inputs.size()); ++i)
        if (plan.inputs[i] != scene.inputs[i].hash) changed = scene.inputs[i].path.string();
    refuse(changed, "has changed since " + plan.request.grouping.plan_file.string() + " was made: plan again");
}
}
