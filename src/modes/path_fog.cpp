// Light from fog on a stretch of a line.
#include "modes/path_line.h"

namespace tyndall {
namespace {
void look_at_fog(const Snapshot& snapshot, vec3 position, FogPoint& fog, int& lookups) {
    fog.position = position, fog.total = 0;
    fog.extinction.resize(snapshot.media.size());
    for (size_t m = 0; m < snapshot.media.size(); ++m, ++lookups) {
        fog.extinction[m] = snapshot.media[m].optics.extinction * density_at(snapshot.media[m], position);
        fog.total += fog.extinction[m];
    }
}

// A guess at the chance per metre that delta tracking collides at the end of the stretch. Weights may be built from any
// guess: they only have to be the same from both sides.
float guessed_collision_density(const Snapshot& snapshot, const Line& line, float distance, const FogPoint& fog) {
    Ray ray = line.rest;
    ray.t_max = distance;
    double depth = 0;
    for (const Medium& medium : snapshot.media) {
        if (medium.kind != DensityKind::bricks) {
            depth += optical_depth(medium, ray);
            continue;
        }
        const Interval inside = clip(medium.world_bounds, ray.origin, ray.direction, {0, distance});
        depth += static_cast<double>(inside.length()) * medium.optics.extinction * medium.bricks->mean;
    }
    return fog.total * static_cast<float>(std::exp(-depth));
}

// Light scattered at a distance picked for the lights. Returns the light that passes the stretch.
float gather_on_the_way(const Walk& walk, Line& line) {
    const Snapshot& snapshot = walk.snapshot;
    int& lookups = walk.results[line.walker.lane].steps;
    const auto passing = [&](Interval range) {
        float share = 1;
        for (const Medium& medium : snapshot.media)
            if (share > 0) share *= ratio_transmittance(medium, line.rest, range, line.random, lookups);
        return share;
    };
    Ray stretch = line.rest;
    stretch.t_max = line.end;
    walk.scratch.lights.clear();
    if (walk.turns) lights_on_line(snapshot, stretch, walk.scratch.lights);
    const std::vector<LineLight>& lights = walk.scratch.lights;

    const vec2 u = line.numbers(use_distance);
    size_t picked = 0;
    for (float left = u.x; picked < lights.size() && (left -= lights[picked].chance) >= 0;) ++picked;
    while (picked > 0 && (picked == lights.size() || !(lights[picked].chance > 0))) --picked;
    if (lights.empty() || !(lights[picked].chance > 0) || !(line.through > 0)) return passing({0, line.end});

    const LineLight& along = lights[picked];
    const float t = along.distance(u.y), before = passing({0, t});
    FogPoint& fog = walk.scratch.fog;
    look_at_fog(snapshot, line.rest.at(t), fog, lookups);
    if (before > 0 && fog.total > 0) {
        const Light& light = snapshot.lights[picked];
        const Arrival arriving = arrival(light, fog.position);
        const float chance = along.chance * along.density(t),
                    other = guessed_collision_density(snapshot, line, t, fog) *
                            pick_chance(snapshot, fog.position, static_cast<int>(picked));
        const float cosine = glm::dot(arriving.to_light, line.rest.direction);
        const vec3 scattered = fog.scattered(snapshot, cosine) * fog.total * arriving.irradiance * light.volume_scale;
        if (chance > 0)
            queue(walk, line,
                  connection_to_light(walk.tracer, fog.position, static_cast<int>(picked), arriving.to_light,
                                      line.numbers(use_soft)),
                  scattered * (line.through * before / (chance + other)), walk.order == 0 || line.walker.in_fog);
    }
    return before > 0 ? before * passing({t, line.end}) : 0;
}

// Light that reaches the point of a collision, straight from lights and glowing surfaces.
void gather_at_collision(const Walk& walk, Line& line, float distance, const FogPoint& fog) {
    const Snapshot& snapshot = walk.snapshot;
    const bool in_fog = walk.order == 0 || line.walker.in_fog;
    const LightPick pick = pick_light(snapshot, fog.position, line.numbers(use_light).x);
    if (pick.chance > 0) {
        const LineLight& along = walk.scratch.lights[pick.light];
        const float mine = guessed_collision_density(snapshot, line, distance, fog) * pick.chance,
                    other = along.chance * along.density(distance);
        const vec3 scattered = fog.scattered(snapshot, glm::dot(pick.to_light, line.rest.direction)) * pick.irradiance;
        const float weight = mine > 0 ? mine / (mine + other) : (other > 0 ? 0.0f : 1.0f);
        queue(walk, line,
              connection_to_light(walk.tracer, fog.position, pick.light, pick.to_light, line.numbers(use_soft)),
              scattered * (weight / pick.chance), in_fog);
    }
    if (walk.tracer.glow.empty()) return;
    const GlowPoint target =
        pick_glow_point(walk.tracer.glow, snapshot, line.numbers(use_light).y, line.numbers(use_glow));
    const Connection connection = connection_to_glow(fog.position, target);
    const float facing = std::abs(glm::dot(target.normal, connection.to_light));
    const float chance = target.density * connection.fog_length * connection.fog_length / facing;
    const float cosine = glm::dot(connection.to_light, line.rest.direction);
    if (facing > 0 && chance > 0)
        queue(walk, line, connection,
              fog.scattered(snapshot, cosine) * target.emission / (chance + fog.density(snapshot, cosine)), in_fog);
}

// Where the path collides with fog on this stretch it gathers light and turns.
void collide(const Walk& walk, Line& line) {
    const Snapshot& snapshot = walk.snapshot;
    float nearest = line.end;
    int hit = -1;
    for (size_t m = 0; m < snapshot.media.size(); ++m) {
        const float first = m == 0 ? line.numbers(use_free_path).x : line.random.next();
        const float t = collision_distance(snapshot.media[m], line.rest, {0, nearest}, first, line.random,
                                           walk.results[line.walker.lane].steps);
        if (t < nearest) nearest = t, hit = static_cast<int>(m);
    }
    if (hit < 0) return;
    line.walking = false;

    const Optics& optics = snapshot.media[hit].optics;
    const bool in_fog = walk.order == 0 || line.walker.in_fog;
    add_light(walk, line, optics.emission / optics.extinction, in_fog);
    if (!walk.turns) return;
    FogPoint& fog = walk.scratch.fog;
    look_at_fog(snapshot, line.rest.at(nearest), fog, walk.results[line.walker.lane].steps);
    if (!(fog.total > 0)) return;
    gather_at_collision(walk, line, nearest, fog);
    const vec3 direction = sample_phase(optics.phase, line.rest.direction, line.numbers(use_phase));
    const float density = fog.density(snapshot, glm::dot(direction, line.rest.direction));
    turn(walk, line, {fog.position, direction}, optics.albedo, density, in_fog);
}
}

void follow_fog(const Walk& walk, Line& line) {
    const float passing = gather_on_the_way(walk, line);
    if (line.walking) collide(walk, line);
    line.through *= passing;
    if (walk.order == 0) walk.results[line.walker.lane].transmittance *= passing;
}
}
