#include "measuring/explain_json.h"
#include "common.h"

namespace tyndall {
namespace {
Json world_place(const RayReport& report) {
    const dvec3 place = dvec3(report.origin) + report.world_origin;
    if (report.world_origin == dvec3(0)) return report.origin;
    return std::vector{place.x, place.y, place.z};
}

Json surface_json(const SurfaceOnRay& surface) {
    return json_object({{"distance", surface.distance},
                        {"name", surface.name},
                        {"material", surface.material},
                        {"alpha", surface.alpha},
                        {"radiance", surface.radiance},
                        {"share", surface.share}});
}

Json stretch_json(const LightStretch& stretch) {
    return json_object({{"from", stretch.low},
                        {"to", stretch.high},
                        {"state", name_of(stretch.state)},
                        {"share", stretch.share},
                        {"blockers", stretch.blockers}});
}

Json light_at_json(const LightAtStep& at) {
    return json_object({{"share", at.share}, {"transmittance", at.transmittance}, {"scattered", at.scattered}});
}

Json light_json(const LightOnRay& light) {
    return json_object({{"name", light.name},
                        {"type", traits_of(light.kind).name},
                        {"shadows", light.shadows},
                        {"points", light.points},
                        {"sampled", light.sampled},
                        {"fog", light.fog},
                        {"surfaces", light.surfaces},
                        {"stretches", json_list(light.stretches, stretch_json)},
                        {"steps", json_list(light.at, light_at_json)}});
}

Json step_json(const RayStep& step) {
    return json_object({{"from", step.low},
                        {"to", step.high},
                        {"extinction", step.extinction},
                        {"depth", step.depth},
                        {"to_eye", step.to_eye},
                        {"reach", step.reach},
                        {"glow", step.glow}});
}

Json result_json(const ModeResult& result, const ModeResult* reference) {
    Json json = json_object({{"mode", result.mode},
                             {"accuracy", name_of(result.accuracy)},
                             {"fog", result.inscatter},
                             {"color", result.color},
                             {"transmittance", result.transmittance},
                             {"validity", result.validity},
                             {"steps", result.steps},
                             {"samples", result.samples},
                             {"finite", result.finite}});
    if (reference) json.members.emplace_back("difference", difference(result, *reference));
    if (result.standard_error) json.members.emplace_back("standard_error", *result.standard_error);
    if (result.image_size.x > 0) json.members.emplace_back("picture", result.image_size);
    if (!result.remark.empty()) json.members.emplace_back("remark", result.remark);
    if (reference) json.members.emplace_back("limitations", json_of(result.limitations));
    return json;
}
}

std::string explain_json(const RayReport& report, const ReportTitle& title) {
    const auto medium_json = [](const MediumOnRay& medium) {
        return json_object({{"name", medium.name}, {"depth", medium.depth}});
    };
    const auto mode_json = [&](const ModeResult& result) { return result_json(result, &report.reference); };
    return json_line({{"version", TYNDALL_VERSION},
                      {"scene", title.scene},
                      {"frame", title.frame},
                      {"camera", title.camera},
                      {"quality", title.quality},
                      {"pixel", report.pixel},
                      {"size", report.size},
                      {"origin", world_place(report)},
                      {"direction", report.direction},
                      {"end", report.end},
                      {"hits", report.hits},
                      {"surfaces", json_list(report.surfaces, surface_json)},
                      {"background", report.background},
                      {"background_share", report.background_share},
                      {"media", json_list(report.media, medium_json)},
                      {"depth", report.depth},
                      {"glow", report.glow},
                      {"steps", json_list(report.steps, step_json)},
                      {"lights", json_list(report.lights, light_json)},
                      {"reference", result_json(report.reference, nullptr)},
                      {"modes", json_list(report.results, mode_json)}});
}
}
