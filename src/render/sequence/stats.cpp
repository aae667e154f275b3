// The report of a sequence as JSON.
#include "base/json/json_values.h"
#include "modes/mode.h"
#include "render/sequence/sequence.h"

namespace tyndall {
namespace {
Json frame_json(const FrameReport& frame) {
    Json json = json_object({{"frame", frame.frame},
                             {"file", frame.file},
                             {"kept", frame.kept},
                             {"load_seconds", frame.load_seconds},
                             {"prepare_seconds", frame.stats.prepare_seconds},
                             {"render_seconds", frame.stats.render_seconds},
                             {"fog_seconds", frame.stats.fog_seconds},
                             {"write_seconds", frame.write_seconds},
                             {"camera_rays", frame.stats.camera_rays},
                             {"steps", frame.stats.steps},
                             {"non_finite", frame.stats.non_finite}});
    if (!frame.mode.empty()) json.members.emplace_back("mode", frame.mode);
    if (frame.stats.moments > 1) json.members.emplace_back("time_samples", frame.stats.moments);
    if (frame.exposure) json.members.emplace_back("exposure", *frame.exposure);
    if (frame.stats.noise) {
        json.members.emplace_back("samples", frame.stats.samples);
        json.members.emplace_back("achieved_error", frame.stats.error()->error);
        json.members.emplace_back("error_bound", frame.stats.error()->bound);
    }
    if (frame.stats.integrator) {
        json.members.emplace_back("candidate", frame.stats.integrator->candidate);
        json.members.emplace_back("noise_error", frame.stats.noise->error);
        json.members.emplace_back("noise_bound", frame.stats.noise->bound);
        json.members.emplace_back("integrator_error", frame.stats.integrator->error.error);
        json.members.emplace_back("integrator_bound", frame.stats.integrator->error.bound);
    }
    if (frame.stats.orders) {
        json.members.emplace_back("orders_mean", frame.stats.orders->mean.error);
        json.members.emplace_back("orders_mean_bound", frame.stats.orders->mean.bound);
        json.members.emplace_back("orders_error", frame.stats.orders->pixels.error);
        json.members.emplace_back("orders_bound", frame.stats.orders->pixels.bound);
    }
    if (frame.stats.moments_error) {
        json.members.emplace_back("moments_error", frame.stats.moments_error->error);
        json.members.emplace_back("moments_bound", frame.stats.moments_error->bound);
    }
    if (frame.stats.goal_seconds > 0) json.members.emplace_back("goal_seconds", frame.stats.goal_seconds);
    if (frame.stats.forecast_seconds > 0 && frame.stats.forecast_seconds < infinity)
        json.members.emplace_back("forecast_seconds", frame.stats.forecast_seconds);
    if (frame.stats.non_finite) json.members.emplace_back("first_non_finite", frame.stats.first_non_finite);
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
    return json_object({{"seconds", report.seconds},
                        {"frames", report.frames.size()},
                        {"kept", kept},
                        {"load_seconds", sum.load_seconds},
                        {"prepare_seconds", sum.stats.prepare_seconds},
                        {"render_seconds", sum.stats.render_seconds},
                        {"fog_seconds", sum.stats.fog_seconds},
                        {"write_seconds", sum.write_seconds},
                        {"camera_rays", sum.stats.camera_rays},
                        {"steps", sum.stats.steps},
                        {"non_finite", report.non_finite},
                        {"peak_memory_bytes", report.peak_memory_bytes}});
}
}

std::string stats_json(const RenderReport& report, const RenderRequest& request, const RenderPlan& plan) {
    JsonMembers settings;
    for (const SettingRow& row : setting_rows()) settings.emplace_back(row.name, row.get(plan.settings));
    Json json = json_object({{"schema", "tyndall-render-stats"},
                             {"schema_version", 1},
                             {"version", TYNDALL_VERSION},
                             {"scene", request.scene_file.string()},
                             {"output", request.output},
                             {"mode", plan.mode->name},
                             {"quality", name_of(request.quality)},
                             {"isa", request.isa},
                             {"seed", request.seed},
                             {"settings", json_object(std::move(settings))},
                             {"limitations", json_of(report.limitations)},
                             {"notes", report.notes},
                             {"cancelled", report.cancelled},
                             {"frames", json_list(report.frames, frame_json)},
                             {"totals", totals(report)}});
    if (request.target_error > 0) {
        json.members.emplace_back("target_error", request.target_error);
        json.members.emplace_back("missed", report.missed);
    }
    if (request.time_budget > 0) json.members.emplace_back("time_budget", request.time_budget);
    if (request.png) {
        json.members.emplace_back("view_transform", name_of(request.view_transform));
        json.members.emplace_back("automatic_exposure", plan.exposure.has_value());
    }
    return format_json(json);
}
}
