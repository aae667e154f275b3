// The report of a sequence as JSON.
#include "base/io/json.h"
#include "modes/mode.h"
#include "render/sequence/sequence.h"

namespace tyndall {
namespace {
Json json_of(double value) {
    Json json;
    json.kind = Json::Kind::number, json.number = value;
    return json;
}
Json json_of(uint64_t value) { return json_of(static_cast<double>(value)); }
Json json_of(int value) { return json_of(static_cast<double>(value)); }
Json json_of(bool value) {
    Json json;
    json.kind = Json::Kind::boolean, json.boolean = value;
    return json;
}
Json json_of(const std::string& text) {
    Json json;
    json.kind = Json::Kind::string, json.string = text;
    return json;
}
Json json_of(ivec2 value) {
    Json json;
    json.kind = Json::Kind::array, json.items = {json_of(value.x), json_of(value.y)};
    return json;
}
Json json_of(const std::vector<std::string>& texts) {
    Json json;
    json.kind = Json::Kind::array;
    for (const std::string& text : texts) json.items.push_back(json_of(text));
    return json;
}
Json object(std::vector<std::pair<std::string, Json>> members) {
    Json json;
    json.kind = Json::Kind::object, json.members = std::move(members);
    return json;
}

Json json_of(const FrameReport& frame) {
    Json json = object({{"frame", json_of(frame.frame)},
                        {"file", json_of(frame.file)},
                        {"kept", json_of(frame.kept)},
                        {"load_seconds", json_of(frame.load_seconds)},
                        {"prepare_seconds", json_of(frame.stats.prepare_seconds)},
                        {"render_seconds", json_of(frame.stats.render_seconds)},
                        {"fog_seconds", json_of(frame.stats.fog_seconds)},
                        {"write_seconds", json_of(frame.write_seconds)},
                        {"camera_rays", json_of(frame.stats.camera_rays)},
                        {"steps", json_of(frame.stats.steps)},
                        {"non_finite", json_of(frame.stats.non_finite)}});
    if (frame.stats.noise) {
        json.members.emplace_back("samples", json_of(frame.stats.samples));
        json.members.emplace_back("achieved_error", json_of(frame.stats.error()->error));
        json.members.emplace_back("error_bound", json_of(frame.stats.error()->bound));
    }
    if (frame.stats.integrator) {
        json.members.emplace_back("candidate", json_of(frame.stats.integrator->candidate));
        json.members.emplace_back("noise_error", json_of(frame.stats.noise->error));
        json.members.emplace_back("noise_bound", json_of(frame.stats.noise->bound));
        json.members.emplace_back("integrator_error", json_of(frame.stats.integrator->error.error));
        json.members.emplace_back("integrator_bound", json_of(frame.stats.integrator->error.bound));
    }
    if (frame.stats.goal_seconds > 0) json.members.emplace_back("goal_seconds", json_of(frame.stats.goal_seconds));
    if (frame.stats.non_finite) json.members.emplace_back("first_non_finite", json_of(frame.stats.first_non_finite));
    return json;
}

Json totals(const RenderReport& report) {
    FrameReport sum;
    int kept = 0;
    for (const FrameReport& frame : report.frames) {
        kept += frame.kept;
        sum.load_seconds += frame.load_seconds, sum.write_seconds += frame.write_seconds;
        sum.stats.prepare_seconds += frame.stats.prepare_seconds;
        sum.stats.render_seconds += frame.stats.render_seconds;
        sum.stats.fog_seconds += frame.stats.fog_seconds;
        sum.stats.camera_rays += frame.stats.camera_rays, sum.stats.steps += frame.stats.steps;
    }
    return object({{"seconds", json_of(report.seconds)},
                   {"frames", json_of(static_cast<int>(report.frames.size()))},
                   {"kept", json_of(kept)},
                   {"load_seconds", json_of(sum.load_seconds)},
                   {"prepare_seconds", json_of(sum.stats.prepare_seconds)},
                   {"render_seconds", json_of(sum.stats.render_seconds)},
                   {"fog_seconds", json_of(sum.stats.fog_seconds)},
                   {"write_seconds", json_of(sum.write_seconds)},
                   {"camera_rays", json_of(sum.stats.camera_rays)},
                   {"steps", json_of(sum.stats.steps)},
                   {"non_finite", json_of(report.non_finite)},
                   {"peak_memory_bytes", json_of(report.peak_memory_bytes)}});
}
}

std::string stats_json(const RenderReport& report, const RenderRequest& request, const RenderPlan& plan) {
    std::vector<std::pair<std::string, Json>> settings;
    for (const SettingRow& row : setting_rows()) settings.emplace_back(row.name, json_of(row.get(plan.settings)));
    Json frames;
    frames.kind = Json::Kind::array;
    for (const FrameReport& frame : report.frames) frames.items.push_back(json_of(frame));
    Json json = object({{"schema", json_of(std::string("tyndall-render-stats"))},
                        {"schema_version", json_of(1)},
                        {"version", json_of(std::string(TYNDALL_VERSION))},
                        {"scene", json_of(request.scene_file.string())},
                        {"output", json_of(request.output)},
                        {"mode", json_of(std::string(plan.mode->name))},
                        {"quality", json_of(std::string(name_of(request.quality)))},
                        {"isa", json_of(request.isa)},
                        {"seed", json_of(static_cast<uint64_t>(request.seed))},
                        {"settings", object(std::move(settings))},
                        {"limitations", json_of(report.limitations)},
                        {"notes", json_of(report.notes)},
                        {"cancelled", json_of(report.cancelled)},
                        {"frames", std::move(frames)},
                        {"totals", totals(report)}});
    if (request.target_error > 0) {
        json.members.emplace_back("target_error", json_of(request.target_error));
        json.members.emplace_back("missed", json_of(report.missed));
    }
    if (request.time_budget > 0) json.members.emplace_back("time_budget", json_of(request.time_budget));
    return format_json(json);
}
}
