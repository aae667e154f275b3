// The path-tracing loop: lines, the surfaces on them, and scattering.
#include "modes/path/tracer.h"

#include "modes/path/emission.h"
#include "modes/path/faces.h"
#include "scene/lights/area_shape.h"
#include "trace/lights/faces.h"
#include "trace/mattes.h"
#include "trace/surface.h"

namespace tyndall {
namespace {
// Position of a camera ray in the image, 0..1 from the upper left. With a lens, the pinhole's ray leads to the same
// point in the plane of focus.
vec2 screen_position(const PathTracer& tracer, const Ray& ray) {
    const Camera& camera = tracer.camera;
    vec3 offset = camera.lens || camera.ortho_height > 0 ? ray.origin - camera.position : vec3(0);
    if (camera.ortho_height == 0) {
        const float along = glm::dot(ray.direction, camera.forward);
        offset += ray.direction * ((camera.lens ? camera.lens.focus : 1) / along);
    }
    return pixel_of_offset(camera, tracer.size, offset).value_or(vec2(0)) / vec2(tracer.size);
}

// Solid-angle pdf with which light sampling at the start of the line picks this point of an emissive surface.
float target_pdf(const PathTracer& tracer, const Segment& line, const SurfacePoint& surface, int instance,
                 int triangle) {
    const float per_area = tracer.emitters ? triangle_pdf(*tracer.emitters, instance, triangle) : 0;
    const float distance = line.traveled + line.end,
                facing = std::abs(glm::dot(surface.face_normal, line.rest.direction));
    return per_area > 0 ? per_area * distance * distance / std::max(facing, 1e-12f) : 0;
}

void gather_at_surface(const PathState& state, Segment& line, const SurfacePoint& surface, vec3 share) {
    const vec3 reflected = surface.base_color * (share / pi);
    const LightPick pick = pick_light(state.snapshot, surface, line.numbers(use_surface_light).x);
    if (pick.probability > 0) {
        Connection connection = connection_to_light(state.tracer, surface.position, pick.light, pick.to_light,
                                                    line.numbers(use_surface_soft));
        connection.face_normal = surface.face_normal;
        vec3 irradiance = pick.irradiance;
        if (const Light& light = state.snapshot.lights[static_cast<size_t>(pick.light)]; light.area) {
            const float cosine = std::max(glm::dot(surface.normal, connection.to_light), 0.0f);
            irradiance = connection.irradiance * (light.surface_scale * cosine);
        }
        queue(state, line, connection, reflected * irradiance / pick.probability, line.vertex.in_fog);
    }
    if (state.tracer.fire) {
        const EmissionSample target = pick_fire(state, line);
        Connection connection = connection_to_fire(surface.position, target);
        connection.face_normal = surface.face_normal;
        const float cosine = glm::dot(surface.normal, connection.to_light), away = connection.fog_length;
        const float found =
            target.line_pdf + collision_pdf(state.snapshot, target.position, state.results[line.vertex.lane].steps);
        const float pdf = target.pdf * away * away + std::max(cosine, 0.0f) / pi * found;
        if (cosine > 0 && pdf > 0)
            queue(state, line, connection, reflected * target.emission * (cosine / pdf), line.vertex.in_fog);
    }
    if (state.snapshot.environment && is_lit(*state.snapshot.environment, state.snapshot, surface.instance))
        gather_sky(
            state, line, surface.position, surface.face_normal, state.snapshot.environment->surface_scale,
            line.vertex.in_fog,
            [&](vec3 direction) { return reflected * std::max(glm::dot(surface.normal, direction), 0.0f); },
            [&](vec3 direction) { return std::max(glm::dot(surface.normal, direction), 0.0f) / pi; });
    if (!state.tracer.emitters) return;
    const EmissivePoint target = sample_triangles(*state.tracer.emitters, *state.snapshot.occluders,
                                                  line.numbers(use_surface_light).y, line.numbers(use_surface_glow));
    if (!is_lit_by_emitter(state.snapshot, target.instance, surface.instance)) return;
    Connection connection = connection_to_emitter(state.snapshot, surface.position, target);
    connection.face_normal = surface.face_normal;
    const float cosine = glm::dot(surface.normal, connection.to_light),
                facing = std::abs(glm::dot(target.normal, connection.to_light));
    const float pdf = target.pdf * connection.fog_length * connection.fog_length / facing;
    const float found = is_linked(state.snapshot, target.instance) ? 0 : cosine / pi;
    if (cosine > 0 && facing > 0 && pdf > 0)
        queue(state, line, connection, reflected * target.emission * (cosine / (pdf + found)), line.vertex.in_fog);
}

// Lambertian reflection: directions are sampled by their cosine, so that the weight is the base color.
void bounce(const PathState& state, const Segment& line, const SurfacePoint& surface) {
    const vec2 u = line.numbers(use_bounce);
    const float cosine = std::sqrt(std::max(0.0f, 1 - u.x));
    const vec3 direction = cosine_direction(surface.normal, u);
    const Ray ray = off_surface(surface.face_normal, {surface.position, direction});
    const bool finds_sky =
        state.tracer.finds_sky && is_lit(*state.snapshot.environment, state.snapshot, surface.instance);
    const float sky_scale = finds_sky ? state.snapshot.environment->surface_scale : 0;
    scatter(state, line, {ray, surface.base_color, cosine / pi, sky_scale}, line.vertex.in_fog);
}

// Ambient light, and the environment's with its MIS weight against light sampling (balance heuristic).
vec3 surroundings(const PathState& state, const Segment& line) {
    const PathVertex& from = line.vertex;
    const vec3 ambient = from.ambient ? state.snapshot.ambient : vec3(0);
    if (!(from.sky_scale > 0)) return ambient;
    const Environment& environment = *state.snapshot.environment;
    const float aimed = environment_pdf(environment, from.ray.direction);
    const float weight = from.sky_scale * from.pdf / (from.pdf + aimed);
    return ambient + environment_radiance(environment, from.ray.direction) * weight;
}

// The line leaves the scene: adds the background for the eye, the surroundings for other lines.
void leave(const PathState& state, Segment& line) {
    if (state.order == 0)
        state.results[line.vertex.lane].background +=
            line.vertex.throughput * line.transmittance *
            background_radiance(state.snapshot.background, line.vertex.ray.direction,
                                screen_position(state.tracer, line.vertex.ray));
    else
        add_light(state, line, surroundings(state, line) * line.transmittance, OtherLight::ambient, line.vertex.in_fog);
    line.unscattered = false, line.transmittance = vec3(0);
}

void start_lines(const PathState& state) {
    state.scratch.lines.clear();
    for (const PathVertex& vertex : state.scratch.vertices) {
        Segment line;
        line.vertex = vertex, line.rest = vertex.ray, line.skip = vertex.skip;
        line.order = state.order, line.pdfs = vertex.shares;
        line.random = {hash(vertex.id, static_cast<uint32_t>(state.order))};
        state.scratch.lines.push_back(line);
    }
    state.scratch.vertices.clear();
}

// Finds the next segment of every line, up to a surface or out of the scene.
void find_ends(const PathState& state, Ray* tested, Hits& hits) {
    const std::vector<Segment>& lines = state.scratch.lines;
    for (size_t i = 0; i < lines.size(); ++i) {
        const Segment& line = lines[i];
        const float left = std::max(line.rest.t_max - line.skip, 0.0f);
        tested[i] = {line.rest.at(line.skip), line.rest.direction, left};
    }
    hits.instance.fill(-1);
    const Occluders* occluders = state.snapshot.occluders.get();
    if (occluders && !occluders->empty()) occluders->closest({tested, lines.size()}, 0, hits, state.order == 0);
    for (size_t i = 0; i < lines.size(); ++i) {
        Segment& line = state.scratch.lines[i];
        line.end = hits.instance[i] >= 0 ? line.skip + hits.t[i] : line.rest.t_max;
    }
}

// Finds the area lights that the eye sees in front of any surface, and ends lines there. -1 = none.
void find_faces(const PathState& state, const Ray* tested, Hits& hits, std::span<int> faces) {
    for (size_t i = 0; i < faces.size(); ++i) {
        Segment& line = state.scratch.lines[i];
        const FaceHit face = visible_face(state.snapshot, tested[i]);
        faces[i] = face.light >= 0 && line.skip + face.distance < line.end ? face.light : -1;
        if (faces[i] >= 0) line.end = line.skip + face.distance, hits.instance[i] = -1;
    }
}

// Adds the face of a light that the eye sees, and ends the line.
void hit_face(const PathState& state, Segment& line, const Light& light) {
    const vec3 radiance = radiance_of(light) * face_texture(*light.area, line.rest.at(line.end));
    add_light(state, line, radiance * line.transmittance, OtherLight::emission, line.vertex.in_fog);
    line.unscattered = false, line.transmittance = vec3(0);
}

void follow_lines(const PathState& state) {
    std::vector<Segment>& lines = state.scratch.lines;
    const bool shown = state.order == 0 && shows_faces(state.snapshot);
    for (int layer = 0; layer < max_layers && !lines.empty(); ++layer) {
        Ray tested[16];
        Hits hits;
        int faces[16];
        find_ends(state, tested, hits);
        std::fill_n(faces, 16, -1);
        if (shown) find_faces(state, tested, hits, {faces, lines.size()});
        for (size_t i = 0; i < lines.size(); ++i) {
            Segment& line = lines[i];
            line.layer = layer;
            if (line.vertex.peak > 0) hit_faces(state, line);
            follow_fog(state, line);
            if (faces[i] >= 0) {
                hit_face(state, line, state.snapshot.lights[static_cast<size_t>(faces[i])]);
                continue;
            }
            if (hits.instance[i] < 0) {
                leave(state, line);
                continue;
            }
            if (!line.open()) continue;
            SurfacePoint surface = state.snapshot.occluders->surface(tested[i], hits, static_cast<int>(i));
            if (hits.instance[i] == line.instance && hits.triangle[i] == line.triangle) surface.alpha = 0;
            if (layer + 1 == max_layers) surface.alpha = 1;
            hit_surface(state, line, surface, hits.instance[i], hits.triangle[i]);
        }
        connect(state.tracer, state.scratch.connections, state.batch, state.results);
        std::erase_if(lines, [](const Segment& line) { return !line.open(); });
    }
}
}

void add_light(const PathState& state, const Segment& line, vec3 radiance, size_t part, bool in_fog) {
    const size_t lane = line.vertex.lane;
    const vec3 added = line.vertex.throughput * line.vertex.shares * radiance;
    (in_fog ? state.results[lane].radiance : state.results[lane].surface) += added;
    if (in_fog && !state.batch.parts.empty()) state.batch.part(lane, part) += added;
}

void add_light(const PathState& state, const Segment& line, vec3 radiance, OtherLight light, bool in_fog) {
    add_light(state, line, radiance, state.batch.parts.empty() ? 0 : state.batch.index_of(light), in_fog);
}

EmissionSample pick_fire(const PathState& state, const Segment& line) {
    const vec2 first = line.numbers(use_fire), second = line.numbers(use_in_fire);
    return sample_emission(*state.tracer.fire, first.x, {first.y, second.x, second.y});
}

void queue(const PathState& state, Segment& line, Connection connection, vec3 light, bool in_fog) {
    connection.lane = line.vertex.lane, connection.in_fog = in_fog;
    connection.light = line.vertex.throughput * line.vertex.shares * light;
    connection.random = {hash(line.random.key, line.random.count++, 1u)};
    if (max_component(connection.light) > 0) state.scratch.connections.push_back(connection);
}

void scatter(const PathState& state, const Segment& line, const ScatterEvent& event, bool in_fog) {
    const bool looks = state.tracer.has_emission || event.peak > 0;
    const bool blind = state.order + 1 >= state.tracer.settings.orders && !looks;
    PathVertex next = line.vertex;
    next.ray = event.ray, next.skip = 0, next.in_fog = in_fog;
    next.pdf = event.pdf, next.sky_scale = event.sky_scale, next.peak = event.peak;
    next.ambient = event.ambient;
    next.throughput *= event.share, next.shares = shares_of(state, line);
    const float brightness = max_component(next.throughput * next.shares) / max_component(next.shares);
    if (blind || !(brightness > 0)) return;
    if (state.order + 1 >= certain_orders && brightness < 1) {
        if (line.numbers(use_roulette).x >= brightness) return;
        next.throughput /= brightness;
    }
    state.scratch.vertices.push_back(next);
}

void hit_surface(const PathState& state, Segment& line, const SurfacePoint& surface, int instance, int triangle) {
    const vec3 share = line.transmittance * surface.alpha;
    const bool holdout = state.order == 0 && is_matte(state.snapshot, instance); // seen by the camera
    if (holdout) state.results[line.vertex.lane].holdout += state.mean(share);
    // The eye sees emissive surfaces even if they illuminate nothing. Linked ones light others only by connections,
    // which know whom they connect.
    const bool found = state.order == 0 || (state.tracer.surfaces_emit && !is_linked(state.snapshot, instance));
    if (!holdout && found && max_component(surface.emission) > 0) {
        const float aimed = line.vertex.pdf > 0 ? target_pdf(state.tracer, line, surface, instance, triangle) : 0;
        const float weight = aimed > 0 ? line.vertex.pdf / (line.vertex.pdf + aimed) : 1;
        add_light(state, line, surface.emission * (share * weight), OtherLight::emission, line.vertex.in_fog);
    }
    if (state.scatters && max_component(share) > 0 && !holdout) gather_at_surface(state, line, surface, share);
    if (line.unscattered && (surface.alpha >= 1 || line.numbers(use_blend).x < surface.alpha)) {
        line.unscattered = false;
        if (state.scatters && !holdout) bounce(state, line, surface);
    }

    // Continues behind the surface, offset by more than rounding errors.
    line.transmittance *= 1 - surface.alpha;
    const float t = line.end;
    line.rest.origin = line.rest.at(t);
    line.rest.t_max -= t;
    line.traveled += t;
    line.skip = surface_skip(line.rest.origin, t);
    line.instance = instance, line.triangle = triangle;
}

void trace_paths(const PathTracer& tracer, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local PathScratch scratch;
    scratch.vertices.clear(), scratch.connections.clear();
    std::fill(results.begin(), results.end(), Scatter{});
    for (size_t lane = 0; lane < batch.rays.size(); ++lane) {
        PathVertex vertex;
        vertex.lane = lane, vertex.ray = batch.rays[lane], vertex.id = batch.ids[lane];
        vertex.skip = batch.clip_near.empty() ? 0 : batch.clip_near[lane];
        vertex.sample = batch.sample_indices.empty() ? SampleIndex{vertex.id, 0} : batch.sample_indices[lane];
        // Each channel in turn, from sample to sample.
        vertex.channel = static_cast<int>((vertex.sample.index + hash(vertex.sample.sequence, use_channel)) % 3);
        scratch.vertices.push_back(vertex);
    }
    const int orders = tracer.settings.orders;
    for (int order = 0; order <= orders && !scratch.vertices.empty(); ++order) {
        // Light of paths that this limit cuts off is missing: the sample is marked invalid.
        if (order == all_orders)
            for (const PathVertex& vertex : scratch.vertices) results[vertex.lane].validity = 0;
        const PathState state{tracer, tracer.snapshot, batch, results, scratch, order, order < orders};
        start_lines(state);
        follow_lines(state);
    }
    for (Scatter& result : results) {
        result.transmittance = tracer.chromatic ? mean_component(result.tint) : result.tint.x;
        result.tint = result.transmittance > 0 && tracer.chromatic ? result.tint / result.transmittance : vec3(1);
    }
}
}
