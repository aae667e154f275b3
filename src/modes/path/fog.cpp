// Light scattered in fog on a segment of a line.
#include "modes/path/emission.h"
#include "modes/path/faces.h"
#include "scene/light.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <utility>

namespace tyndall {
namespace {
void evaluate_fog(const PathState& state, vec3 position, FogPoint& fog, int& lookups) {
    const std::vector<Medium>& media = state.snapshot.media;
    fog.position = position, fog.total = 0, fog.channels = vec3(1);
    fog.extinction.resize(media.size()), fog.albedo.resize(media.size());
    for (size_t m = 0; m < media.size(); ++m, ++lookups) {
        const Optics& optics = media[m].optics;
        fog.extinction[m] = gray_extinction(optics) * density_at(media[m], position);
        if (optics.albedo_field) fog.albedo[m] = albedo_at(optics, position);
        fog.total += fog.extinction[m];
    }
    if (!state.tracer.chromatic || !(fog.total > 0)) return;
    vec3 totals(0);
    for (size_t m = 0; m < media.size(); ++m) totals += fog.extinction[m] * media[m].optics.channels;
    fog.channels = totals / fog.total;
}

// Transmittance up to a distance, of one channel or (dvec3) three, where grids have their mean density, up to a limit,
// as a ray may pass through gaps in them.
template<class Spectrum, class Share>
Spectrum mean_transmittance(const Snapshot& snapshot, const Segment& line, float distance, const Share& share) {
    Ray ray = line.rest;
    ray.t_max = distance;
    constexpr double max_in_grids = 3;
    Spectrum depth(0), in_grids(0);
    for (const Medium& medium : snapshot.media) {
        if (medium.density.kind != DensityKind::bricks) {
            depth += optical_depth(medium, ray) * share(medium);
            continue;
        }
        const Interval<float> inside = clip(medium.world_bounds, ray.origin, ray.direction, {0, distance});
        in_grids += static_cast<double>(inside.length()) * gray_extinction(medium.optics) *
                    medium.density.bricks->mean * share(medium);
    }
    using std::exp, glm::exp;
    return exp(-depth - glm::min(in_grids, Spectrum(max_in_grids)));
}

// An estimate of the transmittance up to a distance. MIS weights may use any estimate that is the same for both
// techniques.
vec3 guessed_transmittance(const PathState& state, const Segment& line, float distance) {
    if (!state.tracer.chromatic)
        return vec3(mean_transmittance<double>(state.snapshot, line, distance, [](const Medium&) { return 1.0; }));
    return vec3(mean_transmittance<dvec3>(state.snapshot, line, distance,
                                          [](const Medium& medium) { return dvec3(medium.optics.channels); }));
}

// Estimated pdf, 1/m, of a collision at a point, given the transmittance up to it.
float guessed_collision_pdf(const PathState& state, const FogPoint& fog, vec3 transmittance) {
    return fog.total * state.mean(fog.channels * transmittance);
}

// Number of candidate distances on a line. Lines from the eye are worth more shadow rays, as beams are narrow.
int candidate_count(const PathState& state) { return state.order == 0 ? 16 : 1; }

// A candidate distance along the segment, at which a light is sampled.
struct Candidate {
    float distance = 0, brightness = 0; // brightness: luminance of `scattered` times transmittance; 0 = rejected
    vec3 scattered{0};                  // over its pdf, with the MIS weight against collisions; without transmittance
};

// Distributes the candidates over lights and distances, and traces all their shadow rays together.
void find_candidates(const PathState& state, const Segment& line, std::span<Candidate> candidates,
                     std::span<Connection> connections) {
    const Snapshot& snapshot = state.snapshot;
    const std::vector<LineLight>& lights = state.scratch.lights;
    const vec2 u = line.numbers(use_distance), soft = line.numbers(use_soft);
    const float count = static_cast<float>(candidates.size());
    size_t light = 0;
    float passed = 0; // probability of all earlier lights
    for (size_t i = 0; i < candidates.size(); ++i) {
        const float wanted = (static_cast<float>(i) + u.x) / count;
        while (light + 1 < lights.size() && passed + lights[light].probability <= wanted)
            passed += lights[light++].probability;
        if (!(lights[light].probability > 0)) continue;
        const auto turned = [&](float x) { // rotated by the golden ratio from candidate to candidate
            const float sum = x + static_cast<float>(i) * 0.618034f;
            return sum - std::floor(sum);
        };
        candidates[i].distance = lights[light].distance(turned(u.y));
        const vec3 point = line.rest.at(candidates[i].distance);
        const LightSample arriving = arrival(snapshot.lights[light], point);
        connections[i] = connection_to_light(state.tracer, point, static_cast<int>(light), arriving.to_light,
                                             {turned(soft.x), soft.y});
        const vec3 irradiance = snapshot.lights[light].area ? connections[i].irradiance : arriving.irradiance;
        connections[i].light = irradiance * snapshot.lights[light].volume_scale;
    }
    float visibility[16];
    find_visibility(state.tracer, connections, visibility);
    for (size_t i = 0; i < candidates.size(); ++i)
        connections[i].light *= visibility[i], connections[i].shadows = false;
}

void weigh(const PathState& state, const Segment& line, const Connection& connection, Candidate& candidate,
           int& lookups) {
    if (!(max_component(connection.light) > 0)) return;
    const Snapshot& snapshot = state.snapshot;
    FogPoint& fog = state.scratch.fog;
    evaluate_fog(state, connection.point, fog, lookups);
    if (!(fog.total > 0)) return;
    const LineLight& along = state.scratch.lights[connection.light_index];
    const vec3 guess = guessed_transmittance(state, line, candidate.distance);
    const float pdf = static_cast<float>(candidate_count(state)) * along.probability * along.pdf(candidate.distance),
                other = guessed_collision_pdf(state, fog, guess) *
                        pick_probability(snapshot, fog.position, connection.light_index);
    if (!(pdf > 0)) return;
    const float cosine = glm::dot(connection.to_light, line.rest.direction);
    const float share =
        fog.total / (pdf + other) * mis_weight(state, fog, connection, peak_for_faces(state.tracer, fog), cosine);
    candidate.scattered = fog.scattered(snapshot, cosine) * share * connection.light;
    candidate.brightness =
        state.tracer.chromatic ? luminance(candidate.scattered * guess) : luminance(candidate.scattered) * guess.x;
}

// Adds light scattered at a distance sampled for the lights: one of several candidates, picked in proportion to its
// estimated contribution (resampled importance sampling: Talbot et al. 2005). Returns the transmittance of the segment.
vec3 gather_on_the_way(const PathState& state, Segment& line) {
    int& lookups = state.results[line.vertex.lane].steps;
    const auto passing = [&](Interval<float> range) { return line_transmittance(state, line, range); };
    Ray stretch = line.rest;
    stretch.t_max = line.end;
    state.scratch.lights.clear();
    if (state.scatters) lights_on_line(state.snapshot, stretch, state.scratch.lights);
    if (state.scratch.lights.empty() || !line.lit()) return passing({0, line.end});

    Candidate candidates[16];
    Connection connections[16];
    const size_t count = static_cast<size_t>(candidate_count(state));
    find_candidates(state, line, {candidates, count}, {connections, count});
    float total = 0;
    for (size_t i = 0; i < count; ++i) {
        weigh(state, line, connections[i], candidates[i], lookups);
        total += candidates[i].brightness;
    }
    if (!(total > 0)) return passing({0, line.end});
    size_t picked = 0;
    for (float left = line.random.next() * total; picked + 1 < count; ++picked)
        if ((left -= candidates[picked].brightness) < 0) break;
    while (!(candidates[picked].brightness > 0)) --picked;

    const Candidate& candidate = candidates[picked];
    const vec3 before = passing({0, candidate.distance});
    if (!(max_component(before) > 0)) return vec3(0);
    queue(state, line, connections[picked],
          candidate.scattered * (line.transmittance * before * total / candidate.brightness),
          state.order == 0 || line.vertex.in_fog);
    return before * passing({candidate.distance, line.end});
}

bool scatters_sky(const PathState& state) { return state.snapshot.environment && state.tracer.ambient_in_fog; }

// Adds environment light that a medium scatters at a point of the line; `weight`: length that the point represents,
// times transmittance.
void gather_sky_by(const PathState& state, Segment& line, const FogPoint& fog, size_t medium, vec3 weight) {
    const Snapshot& snapshot = state.snapshot;
    const Optics& optics = snapshot.media[medium].optics;
    const vec3 scattered = fog.albedo_of(optics, medium) * optics.channels * (fog.extinction[medium] * weight);
    const auto cosine = [&](vec3 direction) { return glm::dot(direction, line.rest.direction); };
    gather_sky(
        state, line, fog.position, vec3(0), snapshot.environment->volume_scale, state.order == 0 || line.vertex.in_fog,
        [&](vec3 direction) { return scattered * phase_value(optics.phase, cosine(direction)); },
        [&](vec3 direction) { return fog.phase_pdf(snapshot, cosine(direction)); });
}

// Adds environment light scattered by thin fog at one sampled distance per medium; thicker fog scatters it at
// collisions.
void gather_sky_on_the_way(const PathState& state, Segment& line) {
    if (!state.scatters) return;
    FogPoint& fog = state.scratch.fog;
    for (size_t m = 0; m < state.snapshot.media.size() && line.lit(); ++m) {
        const auto [range, channels] = thin_part(line, state.snapshot.media[m]);
        if (!(max_component(channels) > 0)) continue;
        const float distance = range.low + line.numbers(use_sky_distance).x * range.length();
        evaluate_fog(state, line.rest.at(distance), fog, state.results[line.vertex.lane].steps);
        if (!(fog.extinction[m] > 0)) continue;
        gather_sky_by(state, line, fog, m,
                      range.length() * line.transmittance * line_transmittance(state, line, {0, distance}) * channels);
    }
}

void gather_sky_at_collision(const PathState& state, Segment& line, const FogPoint& fog) {
    for (size_t m = 0; m < state.snapshot.media.size(); ++m) {
        const vec3 thick = 1.0f - thin_part(line, state.snapshot.media[m]).channels;
        if (fog.extinction[m] > 0 && max_component(thick) > 0)
            gather_sky_by(state, line, fog, m, 1.0f / (fog.total * fog.channels) * thick);
    }
}

// Adds direct light at a collision: of lights, fire, the environment and emissive surfaces.
void gather_at_collision(const PathState& state, Segment& line, float distance, const FogPoint& fog, float peak) {
    const Snapshot& snapshot = state.snapshot;
    const auto scattered = [&](float cosine) { return fog.scattered(snapshot, cosine) / fog.channels; };
    const bool in_fog = state.order == 0 || line.vertex.in_fog;
    int& lookups = state.results[line.vertex.lane].steps;
    const LightPick pick = pick_light(snapshot, fog.position, line.numbers(use_light).x);
    if (pick.probability > 0) {
        const LineLight& along = state.scratch.lights[pick.light];
        const float mine = guessed_collision_pdf(state, fog, guessed_transmittance(state, line, distance)) *
                           pick.probability,
                    other = static_cast<float>(candidate_count(state)) * along.probability * along.pdf(distance);
        const Connection connection =
            connection_to_light(state.tracer, fog.position, pick.light, pick.to_light, line.numbers(use_soft));
        const Light& light = snapshot.lights[static_cast<size_t>(pick.light)];
        const vec3 irradiance = light.area ? connection.irradiance * light.volume_scale : pick.irradiance;
        const float cosine = glm::dot(connection.to_light, line.rest.direction);
        const float weight = mine > 0 ? mine / (mine + other) : (other > 0 ? 0.0f : 1.0f);
        const float share = weight * mis_weight(state, fog, connection, peak, cosine);
        queue(state, line, connection, scattered(cosine) * irradiance * (share / pick.probability), in_fog);
    }
    if (state.tracer.fire) {
        const EmissionSample target = pick_fire(state, line);
        const Connection connection = connection_to_fire(fog.position, target);
        const float cosine = glm::dot(connection.to_light, line.rest.direction), away = connection.fog_length;
        const float found = target.line_pdf + collision_pdf(snapshot, target.position, lookups);
        const float pdf = target.pdf * away * away + fog.phase_pdf(snapshot, cosine) * found;
        if (pdf > 0) queue(state, line, connection, scattered(cosine) * target.emission / pdf, in_fog);
    }
    if (scatters_sky(state)) gather_sky_at_collision(state, line, fog);
    if (!state.tracer.emitters) return;
    const EmissivePoint target = sample_triangles(*state.tracer.emitters, *snapshot.occluders,
                                                  line.numbers(use_light).y, line.numbers(use_glow));
    const Connection connection = connection_to_emitter(snapshot, fog.position, target);
    const float facing = std::abs(glm::dot(target.normal, connection.to_light));
    const float pdf = target.pdf * connection.fog_length * connection.fog_length / facing;
    const float cosine = glm::dot(connection.to_light, line.rest.direction);
    const float found = is_linked(snapshot, target.instance) ? 0 : fog.phase_pdf(snapshot, cosine);
    if (facing > 0 && pdf > 0)
        queue(state, line, connection, scattered(cosine) * target.emission / (pdf + found), in_fog);
}

// A collision of the path with fog.
struct Collision {
    float distance = 0;
    int medium = -1; // none
};

Collision find_collision(const PathState& state, Segment& line) {
    Collision nearest{line.end};
    for (size_t m = 0; m < state.snapshot.media.size(); ++m) {
        const float first = m == 0 ? line.numbers(use_free_path).x : line.random.next();
        const float t =
            collision_distance(state.snapshot.media[m], line.vertex.channel, line.rest, {0, nearest.distance}, first,
                               line.random, state.results[line.vertex.lane].steps, line.pdfs);
        if (t < nearest.distance) nearest = {t, static_cast<int>(m)};
    }
    return nearest;
}

// Gathers light where the path collides with fog, and scatters it.
void scatter_in_fog(const PathState& state, Segment& line, const Collision& collision) {
    const Snapshot& snapshot = state.snapshot;
    const Optics& optics = snapshot.media[collision.medium].optics;
    const bool in_fog = state.order == 0 || line.vertex.in_fog;
    const vec3 thick = 1.0f - thin_part(line, snapshot.media[collision.medium]).channels;
    if (max_component(thick) > 0)
        add_light(state, line, optics.emission.radiance / (gray_extinction(optics) * optics.channels) * thick,
                  OtherLight::emission, in_fog);
    if (!state.scatters && !state.tracer.fire) return;
    FogPoint& fog = state.scratch.fog;
    evaluate_fog(state, line.rest.at(collision.distance), fog, state.results[line.vertex.lane].steps);
    if (!(fog.total > 0)) return;
    if (state.tracer.fire) gather_fire_at_collision(state, line, collision.distance, fog);
    if (!state.scatters) return;
    const float peak = peak_for_faces(state.tracer, fog);
    gather_at_collision(state, line, collision.distance, fog, peak);
    const vec3 direction = sample_phase(optics.phase, line.rest.direction, line.numbers(use_phase));
    const float pdf = fog.phase_pdf(snapshot, glm::dot(direction, line.rest.direction));
    const bool ambient = state.tracer.ambient_in_fog, finds_sky = ambient && state.tracer.finds_sky;
    const float sky_scale = finds_sky ? snapshot.environment->volume_scale : 0;
    const vec3 albedo = fog.albedo_of(optics, static_cast<size_t>(collision.medium));
    scatter(state, line, {{fog.position, direction}, albedo, pdf, sky_scale, peak, ambient}, in_fog);
}

// If the path collides with fog on this segment, gathers light there and scatters the path.
void collide(const PathState& state, Segment& line) {
    const Collision collision = find_collision(state, line);
    if (collision.medium < 0) return;
    line.unscattered = false;
    const vec3 shares = std::exchange(line.vertex.shares, shares_of(state, line));
    scatter_in_fog(state, line, collision);
    line.vertex.shares = shares; // of light that passes the collision, whose transmittance is estimated by itself
}
}

vec3 line_transmittance(const PathState& state, Segment& line, Interval<float> range) {
    const vec3 arriving = line.vertex.throughput * line.vertex.shares * line.transmittance;
    int& lookups = state.results[line.vertex.lane].steps;
    vec3 share(1);
    for (const Medium& medium : state.snapshot.media)
        if (max_component(share) > 0)
            share *= channel_transmittance(medium, arriving * share, line.rest, range, line.random, lookups);
    return share;
}

void follow_fog(const PathState& state, Segment& line) {
    gather_emission(state, line);
    if (scatters_sky(state)) gather_sky_on_the_way(state, line);
    const vec3 passing = gather_on_the_way(state, line);
    if (line.unscattered) collide(state, line);
    line.transmittance *= passing;
    if (state.order == 0) state.results[line.vertex.lane].tint *= passing;
}
}
