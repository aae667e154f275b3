#include "modes/path/faces.h"

#include "scene/lights/area_shape.h"

namespace tyndall {
namespace {
// Number of samples that light sampling counts as in MIS weights, against one sample of the phase function: lines from
// the eye resample 16 distances for it. With these, noise beside a panel is no more than with light sampling alone up
// to g = 0.8, and a third of it at 0.97.
float aimed_count(int order) { return order == 0 ? 16 : 4; }

// Whether, roughly, the phase function is narrower than the solid angle of the face from a point. Only for faces that
// all surfaces shadow, as they do lines.
bool finds_face(const Light& light, vec3 point, float peak) {
    if (!light.area || !light.shadows || light.casters >= 0 || !(light.volume_scale > 0)) return false;
    const vec3 offset = point - light.position;
    const float area = face_area(*light.area), steradians = area / (glm::dot(offset, offset) + area / (2 * pi));
    return peak * steradians > 1;
}
}

float peak_for_faces(const PathTracer& tracer, const FogPoint& fog) {
    if (tracer.peaks.empty()) return 0;
    float peak = 0;
    for (size_t m = 0; m < fog.extinction.size(); ++m) peak += fog.extinction[m] / fog.total * tracer.peaks[m];
    const auto finds = [&](const Light& light) { return finds_face(light, fog.position, peak); };
    return std::ranges::any_of(tracer.snapshot.lights, finds) ? peak : 0;
}

float mis_weight(const PathState& state, const FogPoint& fog, const Connection& connection, float peak, float cosine) {
    if (!(peak > 0)) return 1;
    const Light& light = state.snapshot.lights[static_cast<size_t>(connection.light_index)];
    if (!finds_face(light, connection.point, peak)) return 1;
    const float aimed = aimed_count(state.order);
    return aimed / (aimed + connection.steradians * fog.phase_pdf(state.snapshot, cosine));
}

void hit_faces(const PathState& state, Segment& line) {
    const PathVertex& from = line.vertex;
    const float aimed = aimed_count(state.order - 1);
    for (size_t i = 0; i < state.snapshot.lights.size() && line.lit(); ++i) {
        const Light& light = state.snapshot.lights[i];
        if (!finds_face(light, from.ray.origin, from.peak)) continue;
        const float away = area_hit(*light.area, {from.ray.origin, from.ray.direction, infinity});
        if (away == infinity || !(away > line.traveled && away <= line.traveled + line.end)) continue;
        const float own = from.pdf * area_steradians(*light.area, from.ray.origin, from.ray.direction, away);
        const vec3 radiance = radiance_of(light) * face_texture(*light.area, from.ray.at(away)) * light.volume_scale;
        const vec3 share = line.transmittance * line_transmittance(state, line, {0, away - line.traveled});
        add_light(state, line, radiance * (share * own / (aimed + own)), i, from.in_fog);
    }
}
}
