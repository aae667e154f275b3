// The table of steps.
#include "measure/explain/report.h"

#include "base/text.h"

namespace tyndall {
namespace {
// A field, in quotes if it holds commas, quotes or line breaks (RFC 4180).
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == text.npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

std::string numbers(vec3 v) { return formatted(",%.7g,%.7g,%.7g", v.x, v.y, v.z); }
}

std::string explain_csv(const RayReport& report) {
    std::string text = "from_m,to_m,extinction_per_m,depth_from_eye,to_eye,reach_m,glow_r,glow_g,glow_b";
    for (const LightOnRay& light : report.lights)
        for (const char* what : {" lit", " to_light", " r", " g", " b"}) text += "," + field(light.name + what);
    text += "\n";
    for (size_t i = 0; i < report.steps.size(); ++i) {
        const RayStep& step = report.steps[i];
        text += formatted("%.9g,%.9g,%.7g,%.7g,%.7g,%.7g", step.low, step.high, step.extinction, step.depth,
                          step.to_eye, step.reach) +
                numbers(step.glow);
        for (const LightOnRay& light : report.lights)
            text +=
                formatted(",%.7g,%.7g", light.at[i].share, light.at[i].transmittance) + numbers(light.at[i].scattered);
        text += "\n";
    }
    return text;
}
}
