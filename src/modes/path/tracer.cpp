// The path-tracing loop: lines, the surfaces on them, and scattering.
#include "modes/path/tracer.h"

#include "modes/path/faces.h"
#include "scene/area_shape.h"
#include "trace/lights/faces.h"
#include "trace/mattes.h"
#include "trace/surface.h"

namespace tyndall {
namespace {
// Position of a camera ray in the image, 0..1 from the upper left.
vec2 screen_position(const PathTracer& tracer, const Ray& ray) {
    const Camera& camera = tracer.camera;
    const float aspect = static_cast<float>(tracer.size.x) / tracer.size.y;
    vec2 screen;
    if (camera.ortho_height > 0) {
        const vec3 offset = (ray.origin - camera.position) / (0.5f * camera.ortho_height);
        screen = {glm::dot(offset, camera.right), glm::dot(offset, camera.up)};
    } else {
        const float along = glm::dot(ray.direction, camera.forward);
        // With a lens, the pinhole's ray leads to the same point in the plane of focus.
        const vec3 direction =
            camera.lens ? ray.direction + (ray.origin - camera.position) * (along / camera.lens.focus) : ray.direction;
        const float depth = along * std::tan(0.5f * camera.vertical_fov);
        screen = vec2(glm::dot(direction, camera.right), glm::dot(direction, camera.up)) / depth;
    }
    return {0.5f * (screen.x / aspect + 1), 0.5f * (1 - screen.y)};
}

// Solid-angle pdf with which light sampling at the start of the line picks this point of an emissive surface.
float target_density(const PathTracer& tracer, const Segment& line, const SurfacePoint& surface, int instance,
                     int triangle) {
    const float density = tracer.glow ? glow_density(*tracer.glow, instance, triangle) : 0;
    const float distance = line.travelled + line.end,
                facing = std::abs(glm::dot(surface.face_normal, line.rest.direction));
    return density > 0 ? density * distance * distance / std::max(facing, 1e-12f) : 0;
}

void gather_at_surface(const Walk& walk, Segment& line, const SurfacePoint& surface, float share) {
    const vec3 reflected = surface.base_color * (share / pi);
    const LightPick pick = pick_light(walk.snapshot, surface, line.numbers(use_surface_light).x);
    if (pick.chance > 0) {
        Connection connection = connection_to_light(walk.tracer, surface.position, pick.light, pick.to_light,
                                                    line.numbers(use_surface_soft));
        connection.face_normal = surface.face_normal;
        vec3 irradiance = pick.irradiance;
        if (const Light& light = walk.snapshot.lights[static_cast<size_t>(pick.light)]; light.area) {
            const float cosine = std::max(glm::dot(surface.normal, connection.to_light), 0.0f);
            irradiance = connection.irradiance * (light.surface_scale * cosine);
        }
        queue(walk, line, connection, reflected * irradiance / pick.chance, line.walker.in_fog);
    }
    if (walk.tracer.fire) {
        const EmissivePlace target = pick_fire(walk, line);
        Connection connection = connection_to_fire(surface.position, target);
        connection.face_normal = surface.face_normal;
        const float cosine = glm::dot(surface.normal, connection.to_light), away = connection.fog_length;
        const float found = target.line_density +
                            colliding_chance(walk.snapshot, target.position, walk.results[line.walker.lane].steps);
        const float chance = target.density * away * away + std::max(cosine, 0.0f) / pi * found;
        if (cosine > 0 && chance > 0)
            queue(walk, line, connection, reflected * target.emission * (cosine / chance), line.walker.in_fog);
    }
    if (walk.snapshot.environment && is_lit(*walk.snapshot.environment, walk.snapshot, surface.instance))
        gather_sky(
            walk, line, surface.position, surface.face_normal, walk.snapshot.environment->surface_scale,
            line.walker.in_fog,
            [&](vec3 direction) { return reflected * std::max(glm::dot(surface.normal, direction), 0.0f); },
            [&](vec3 direction) { return std::max(glm::dot(surface.normal, direction), 0.0f) / pi; });
    if (!walk.tracer.glow) return;
    const EmissivePoint target = pick_glow_point(*walk.tracer.glow, *walk.snapshot.occluders,
                                                 line.numbers(use_surface_light).y, line.numbers(use_surface_glow));
    Connection connection = connection_to_glow(surface.position, target);
    connection.face_normal = surface.face_normal;
    const float cosine = glm::dot(surface.normal, connection.to_light),
                facing = std::abs(glm::dot(target.normal, connection.to_light));
    const float chance = target.density * connection.fog_length * connection.fog_length / facing;
    if (cosine > 0 && facing > 0 && chance > 0)
        queue(walk, line, connection, reflected * target.emission * (cosine / (chance + cosine / pi)),
              line.walker.in_fog);
}

// Lambertian reflection: directions are sampled by their cosine, so that the weight is the base color.
void bounce(const Walk& walk, const Segment& line, const SurfacePoint& surface) {
    const vec2 u = line.numbers(use_bounce);
    const float cosine = std::sqrt(std::max(0.0f, 1 - u.x));
    const vec3 direction = cosine_direction(surface.normal, u);
    const vec3 origin = off_surface(surface.position, surface.face_normal, direction);
    const bool finds_sky = walk.tracer.finds_sky && is_lit(*walk.snapshot.environment, walk.snapshot, surface.instance);
    const float sky_scale = finds_sky ? walk.snapshot.environment->surface_scale : 0;
    scatter(walk, line, {{origin, direction}, surface.base_color, cosine / pi, sky_scale}, line.walker.in_fog);
}

// Ambient light, and the environment's with its MIS weight against light sampling (balance heuristic).
vec3 surroundings(const Walk& walk, const Segment& line) {
    const PathVertex& from = line.walker;
    if (!(from.sky_scale > 0)) return walk.snapshot.ambient;
    const Environment& environment = *walk.snapshot.environment;
    const float aimed = environment_density(environment, from.ray.direction);
    const float weight = from.sky_scale * from.density / (from.density + aimed);
    return walk.snapshot.ambient + environment_radiance(environment, from.ray.direction) * weight;
}

// The line leaves the scene: adds the background for the eye, the surroundings for other lines.
void leave(const Walk& walk, Segment& line) {
    if (walk.order == 0)
        walk.results[line.walker.lane].background +=
            line.walker.throughput * line.through *
            background_radiance(walk.snapshot.background, line.walker.ray.direction,
                                screen_position(walk.tracer, line.walker.ray));
    else
        add_light(walk, line, surroundings(walk, line) * line.through, OtherLight::ambient, line.walker.in_fog);
    line.walking = false, line.through = 0;
}

void start_lines(const Walk& walk) {
    walk.scratch.lines.clear();
    for (const PathVertex& walker : walk.scratch.walkers) {
        Segment line;
        line.walker = walker, line.rest = walker.ray, line.skip = walker.skip;
        line.order = walk.order;
        line.random = {hash(walker.id, static_cast<uint32_t>(walk.order))};
        walk.scratch.lines.push_back(line);
    }
    walk.scratch.walkers.clear();
}

// Finds the next segment of every line, up to a surface or out of the scene.
void find_ends(const Walk& walk, Ray* tested, Hits& hits) {
    const std::vector<Segment>& lines = walk.scratch.lines;
    for (size_t i = 0; i < lines.size(); ++i) {
        const Segment& line = lines[i];
        const float left = std::max(line.rest.t_max - line.skip, 0.0f);
        tested[i] = {line.rest.at(line.skip), line.rest.direction, left};
    }
    hits.instance.fill(-1);
    const Occluders* occluders = walk.snapshot.occluders.get();
    if (occluders && !occluders->empty()) occluders->closest({tested, lines.size()}, 0, hits, walk.order == 0);
    for (size_t i = 0; i < lines.size(); ++i) {
        Segment& line = walk.scratch.lines[i];
        line.end = hits.instance[i] >= 0 ? line.skip + hits.t[i] : line.rest.t_max;
    }
}

// Finds the area lights that the eye sees in front of any surface, and ends lines there. -1 = none.
void find_faces(const Walk& walk, const Ray* tested, Hits& hits, std::span<int> faces) {
    for (size_t i = 0; i < faces.size(); ++i) {
        Segment& line = walk.scratch.lines[i];
        const FaceHit face = visible_face(walk.snapshot, tested[i]);
        faces[i] = face.light >= 0 && line.skip + face.distance < line.end ? face.light : -1;
        if (faces[i] >= 0) line.end = line.skip + face.distance, hits.instance[i] = -1;
    }
}

// Adds the face of a light that the eye sees, and ends the line.
void meet_face(const Walk& walk, Segment& line, const Light& light) {
    const vec3 radiance = radiance_of(light) * face_picture(*light.area, line.rest.at(line.end));
    add_light(walk, line, radiance * line.through, OtherLight::emission, line.walker.in_fog);
    line.walking = false, line.through = 0;
}

void follow_lines(const Walk& walk) {
    std::vector<Segment>& lines = walk.scratch.lines;
    const bool shown = walk.order == 0 && shows_faces(walk.snapshot);
    for (int layer = 0; layer < max_layers && !lines.empty(); ++layer) {
        Ray tested[16];
        Hits hits;
        int faces[16];
        find_ends(walk, tested, hits);
        std::fill_n(faces, 16, -1);
        if (shown) find_faces(walk, tested, hits, {faces, lines.size()});
        for (size_t i = 0; i < lines.size(); ++i) {
            Segment& line = lines[i];
            line.layer = layer;
            if (line.walker.peak > 0) meet_faces(walk, line);
            follow_fog(walk, line);
            if (faces[i] >= 0) {
                meet_face(walk, line, walk.snapshot.lights[static_cast<size_t>(faces[i])]);
                continue;
            }
            if (hits.instance[i] < 0) {
                leave(walk, line);
                continue;
            }
            if (!line.open()) continue;
            SurfacePoint surface = walk.snapshot.occluders->surface(tested[i], hits, static_cast<int>(i));
            if (hits.instance[i] == line.instance && hits.triangle[i] == line.triangle) surface.alpha = 0;
            if (layer + 1 == max_layers) surface.alpha = 1;
            meet_surface(walk, line, surface, hits.instance[i], hits.triangle[i]);
        }
        connect(walk.tracer, walk.scratch.connections, walk.batch, walk.results);
        std::erase_if(lines, [](const Segment& line) { return !line.open(); });
    }
}
}

void add_light(const Walk& walk, const Segment& line, vec3 radiance, size_t part, bool in_fog) {
    const size_t lane = line.walker.lane;
    const vec3 added = line.walker.throughput * radiance;
    (in_fog ? walk.results[lane].radiance : walk.results[lane].surface) += added;
    if (in_fog && !walk.batch.parts.empty()) walk.batch.part(lane, part) += added;
}

void add_light(const Walk& walk, const Segment& line, vec3 radiance, OtherLight light, bool in_fog) {
    add_light(walk, line, radiance, walk.batch.parts.empty() ? 0 : walk.batch.index_of(light), in_fog);
}

EmissivePlace pick_fire(const Walk& walk, const Segment& line) {
    const vec2 first = line.numbers(use_fire), second = line.numbers(use_in_fire);
    return pick_emissive_place(*walk.tracer.fire, first.x, {first.y, second.x, second.y});
}

void queue(const Walk& walk, Segment& line, Connection connection, vec3 light, bool in_fog) {
    connection.lane = line.walker.lane, connection.in_fog = in_fog;
    connection.light = line.walker.throughput * light;
    connection.random = {hash(line.random.key, line.random.count++, 1u)};
    if (max_component(connection.light) > 0) walk.scratch.connections.push_back(connection);
}

void scatter(const Walk& walk, const Segment& line, const Turn& turn, bool in_fog) {
    const bool looks = walk.tracer.has_emission || turn.peak > 0;
    const bool blind = walk.order + 1 >= walk.tracer.settings.orders && !looks;
    PathVertex next = line.walker;
    next.ray = turn.ray, next.skip = 0, next.in_fog = in_fog;
    next.density = turn.density, next.sky_scale = turn.sky_scale, next.peak = turn.peak;
    next.throughput *= turn.share;
    const float brightness = max_component(next.throughput);
    if (blind || !(brightness > 0)) return;
    if (walk.order + 1 >= certain_orders && brightness < 1) {
        if (line.numbers(use_roulette).x >= brightness) return;
        next.throughput /= brightness;
    }
    walk.scratch.walkers.push_back(next);
}

void meet_surface(const Walk& walk, Segment& line, const SurfacePoint& surface, int instance, int triangle) {
    const float share = line.through * surface.alpha;
    const bool held = walk.order == 0 && is_matte(walk.snapshot, instance); // seen by the camera
    if (held) walk.results[line.walker.lane].held += share;
    // The eye sees emissive surfaces even if they illuminate nothing.
    if (!held && (walk.tracer.surfaces_emit || walk.order == 0) && max_component(surface.emission) > 0) {
        const float aimed =
            line.walker.density > 0 ? target_density(walk.tracer, line, surface, instance, triangle) : 0;
        const float weight = aimed > 0 ? line.walker.density / (line.walker.density + aimed) : 1;
        add_light(walk, line, surface.emission * (share * weight), OtherLight::emission, line.walker.in_fog);
    }
    if (walk.turns && share > 0 && !held) gather_at_surface(walk, line, surface, share);
    if (line.walking && (surface.alpha >= 1 || line.numbers(use_blend).x < surface.alpha)) {
        line.walking = false;
        if (walk.turns && !held) bounce(walk, line, surface);
    }

    // Continues behind the surface, offset by more than rounding errors.
    line.through *= 1 - surface.alpha;
    const float t = line.end;
    line.rest.origin = line.rest.at(t);
    line.rest.t_max -= t;
    line.travelled += t;
    line.skip = std::max(shadow_offset(line.rest.origin), 4e-6f * t);
    line.instance = instance, line.triangle = triangle;
}

void trace_paths(const PathTracer& tracer, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local PathScratch scratch;
    scratch.walkers.clear(), scratch.connections.clear();
    std::fill(results.begin(), results.end(), Scatter{});
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        PathVertex walker;
        walker.lane = lane, walker.ray = batch.rays[lane], walker.id = batch.ids[lane];
        walker.skip = batch.clip_near.empty() ? 0 : batch.clip_near[lane];
        walker.place = batch.places.empty() ? SamplePlace{walker.id, 0} : batch.places[lane];
        scratch.walkers.push_back(walker);
    }
    const int orders = tracer.settings.orders;
    for (int order = 0; order <= orders && !scratch.walkers.empty(); ++order) {
        // Light of paths that this limit cuts off is missing: the sample is marked invalid.
        if (order == all_orders)
            for (const PathVertex& walker : scratch.walkers) results[walker.lane].validity = 0;
        const Walk walk{tracer, tracer.snapshot, batch, results, scratch, order, order < orders};
        start_lines(walk);
        follow_lines(walk);
    }
}
}
