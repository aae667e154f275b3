#include "explain_json.h"
#include "common.h"

namespace tyndall {
namespace {
template<class T, class Make> Json list(const std::vector<T>& values, const Make& make) {
    std::vector<Json> items;
    for (const T& value : values) items.push_back(make(value));
    return json_array(std::move(items));
}

Json pair_json(ivec2 v) { return json_array({json_of(v.x), json_of(v.y)}); }
Json number(float value) { return json_of(static_cast<double>(value)); }

Json surface_json(const SurfaceOnRay& surface) {
    return json_object({{"distance", json_of(surface.distance)},
                        {"name", json_of(surface.name)},
                        {"material", json_of(surface.material)},
                        {"alpha", number(surface.alpha)},
                        {"radiance", json_of(surface.radiance)},
                        {"share", number(surface.share)}});
}

Json stretch_json(const LightStretch& stretch) {
    return json_object({{"from", json_of(stretch.low)},
                        {"to", json_of(stretch.high)},
                        {"state", json_of(name_of(stretch.state))},
                        {"share", json_of(stretch.share)},
                        {"blockers", json_of(stretch.blockers)}});
}

Json light_at_json(const LightAtStep& at) {
    return json_object({{"share", number(at.share)},
                        {"transmittance", number(at.transmittance)},
                        {"scattered", json_of(at.scattered)}});
}

Json light_json(const LightOnRay& light) {
    constexpr const char* kinds[] = {"point", "spot", "sun"};
    return json_object({{"name", json_of(light.name)},
                        {"type", json_of(kinds[static_cast<size_t>(light.kind)])},
                        {"shadows", json_of(light.shadows)},
                        {"points", json_of(light.points)},
                        {"sampled", json_of(light.sampled)},
                        {"fog", json_of(light.fog)},
                        {"surfaces", json_of(light.surfaces)},
                        {"stretches", list(light.stretches, stretch_json)},
                        {"steps", list(light.at, light_at_json)}});
}

Json step_json(const RayStep& step) {
    return json_object({{"from", json_of(step.low)},
                        {"to", json_of(step.high)},
                        {"extinction", json_of(step.extinction)},
                        {"depth", json_of(step.depth)},
                        {"to_eye", json_of(step.to_eye)},
                        {"reach", json_of(step.reach)},
                        {"glow", json_of(step.glow)}});
}

Json answer_json(const Answer& answer, const Answer* reference) {
    Json json = json_object({{"mode", json_of(answer.mode)},
                             {"accuracy", json_of(name_of(answer.accuracy))},
                             {"fog", json_of(answer.inscatter)},
                             {"color", json_of(answer.color)},
                             {"transmittance", number(answer.transmittance)},
                             {"validity", number(answer.validity)},
                             {"steps", json_of(answer.steps)},
                             {"samples", json_of(answer.samples)},
                             {"finite", json_of(answer.finite)}});
    if (reference) json.members.emplace_back("difference", json_of(difference(answer, *reference)));
    if (answer.standard_error) json.members.emplace_back("standard_error", json_of(*answer.standard_error));
    if (answer.picture.x > 0) json.members.emplace_back("picture", pair_json(answer.picture));
    if (!answer.remark.empty()) json.members.emplace_back("remark", json_of(answer.remark));
    if (reference) json.members.emplace_back("limitations", json_of(answer.limitations));
    return json;
}
}

std::string explain_json(const RayStory& story, const StoryTitle& title) {
    const auto medium_json = [](const MediumOnRay& medium) {
        return json_object({{"name", json_of(medium.name)}, {"depth", json_of(medium.depth)}});
    };
    const auto mode_json = [&](const Answer& answer) { return answer_json(answer, &story.reference); };
    return format_json(json_object({{"version", json_of(TYNDALL_VERSION)},
                                    {"scene", json_of(title.scene)},
                                    {"frame", json_of(title.frame)},
                                    {"camera", json_of(title.camera)},
                                    {"quality", json_of(title.quality)},
                                    {"pixel", pair_json(story.pixel)},
                                    {"size", pair_json(story.size)},
                                    {"origin", json_of(story.origin)},
                                    {"direction", json_of(story.direction)},
                                    {"end", json_of(story.end)},
                                    {"hits", json_of(story.hits)},
                                    {"surfaces", list(story.surfaces, surface_json)},
                                    {"background", json_of(story.background)},
                                    {"background_share", number(story.background_share)},
                                    {"media", list(story.media, medium_json)},
                                    {"depth", json_of(story.depth)},
                                    {"glow", json_of(story.glow)},
                                    {"steps", list(story.steps, step_json)},
                                    {"lights", list(story.lights, light_json)},
                                    {"reference", answer_json(story.reference, nullptr)},
                                    {"modes", list(story.answers, mode_json)}})) +
           "\n";
}
}
