#include "modes/path/emission.h"

namespace tyndall {
namespace {
// Factor on the pdf of collisions in MIS weights, against picking: points on a line are picked by their brightness,
// collisions are not. Between 1/4 and 1/16 noise is within 5 % of its minimum, in flames of 0.5 as in those of 200
// optical depths.
constexpr float collision_share = 1.0f / 8;

// Light of a point in fire is sampled in three ways, combined by the balance heuristic: by connecting to it from the
// start of the line; by picking a point on the line, best in thin fog; and by collisions of the path, best in thick
// fog. Transmittance along the line is left out of the pdfs of the last two.
struct FireShares {
    float picked = 0, collided = 0;
};
FireShares fire_shares(const Segment& line, const EmissionSample& place, float distance, float colliding) {
    const float found = place.line_pdf + colliding, away = line.traveled + distance;
    const bool aims = line.vertex.pdf > 0; // no connections from the eye
    const float pdf = aims ? found + place.pdf * away * away / line.vertex.pdf : found;
    if (!(pdf > 0)) return {};
    return {place.line_pdf / pdf, colliding / pdf};
}

void gather_field(const PathState& state, Segment& line, size_t number) {
    Ray stretch = line.rest;
    stretch.t_max = line.end;
    const EmissionOnLine hit = emission_on_line(*state.tracer.fire, number, stretch, line.numbers(use_emission).x);
    if (!(hit.inverse_pdf > 0)) return;
    int& lookups = state.results[line.vertex.lane].steps;
    ++lookups;
    if (!(max_component(hit.sample.emission) > 0)) return;
    const float colliding = collision_pdf(state.snapshot, hit.sample.position, lookups);
    const vec3 share = line.transmittance * line_transmittance(state, line, {0, hit.distance}) *
                       fire_shares(line, hit.sample, hit.distance, colliding).picked;
    add_light(state, line, hit.sample.emission * (share * hit.inverse_pdf), OtherLight::emission,
              state.order == 0 || line.vertex.in_fog);
}
}

ThinPart thin_part(const Segment& line, const Medium& medium) {
    ThinPart part{clip(medium.world_bounds, line.rest.origin, line.rest.direction, {0, line.end})};
    if (part.range.empty()) return part;
    const float depth = medium.majorant() * part.range.length();
    for (glm::length_t c = 0; c < 3; ++c) part.channels[c] = depth * medium.optics.channels[c] < 1 ? 1.0f : 0.0f;
    return part;
}

float collision_pdf(const Snapshot& snapshot, vec3 position, int& lookups) {
    float extinction = 0;
    for (const Medium& medium : snapshot.media) {
        if (only_emits(medium.optics)) continue;
        extinction += gray_extinction(medium.optics) * density_at(medium, position);
        ++lookups;
    }
    return collision_share * extinction;
}

void gather_emission(const PathState& state, Segment& line) {
    const size_t fields = state.tracer.fire ? state.tracer.fire->fields.size() : 0;
    for (size_t m = 0; m < fields && line.lit(); ++m) gather_field(state, line, m);
    for (const Medium& medium : state.snapshot.media) {
        const auto [range, channels] = thin_part(line, medium);
        const vec3 emission = medium.optics.emission.radiance * channels;
        if (!(max_component(emission) > 0) || !line.lit()) continue;
        const float distance = range.low + line.numbers(use_emission).x * range.length();
        const float density = density_at(medium, line.rest.at(distance));
        if (!(density > 0)) continue;
        const vec3 share = line.transmittance * line_transmittance(state, line, {0, distance});
        add_light(state, line, emission * (share * density * range.length()), OtherLight::emission,
                  state.order == 0 || line.vertex.in_fog);
    }
}

void gather_fire_at_collision(const PathState& state, Segment& line, float distance, const FogPoint& fog) {
    for (size_t field = 0; field < state.tracer.fire->fields.size(); ++field) {
        const EmissionSample place = emission_sample_at(*state.tracer.fire, field, fog.position);
        if (!(max_component(place.emission) > 0)) continue;
        const float share = fire_shares(line, place, distance, collision_share * fog.total).collided;
        add_light(state, line, place.emission * (share / (fog.total * fog.channels)), OtherLight::emission,
                  state.order == 0 || line.vertex.in_fog);
    }
}
}
