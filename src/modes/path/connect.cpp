// Connections: shadow rays in packets, transmittance of fog by ratio tracking.
#include "modes/path/connect.h"

#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "trace/lights/environment.h"
#include "trace/lights/light_ray.h"
#include "trace/occlusion/occluders.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Traces shadow rays against the surfaces that shadow each light: all surfaces, or the light's set of casters.
void trace_shadows(const Snapshot& snapshot, std::span<const Connection> connections, Occluders::ShadowRays& rays,
                   float* shares) {
    const auto set_of = [&](size_t i) { return i < connections.size() ? connections[i].casters : -1; };
    int32_t wanted[16];
    std::copy_n(rays.active, 16, wanted);
    for (int set = -1; set < static_cast<int>(snapshot.casters.size()); ++set) {
        const Occluders* surfaces =
            set < 0 ? snapshot.occluders.get() : snapshot.casters[static_cast<size_t>(set)].occluders.get();
        bool any = false;
        for (size_t i = 0; i < 16; ++i) {
            rays.active[i] = set_of(i) == set ? wanted[i] : 0;
            any |= rays.active[i] != 0;
        }
        if (any && surfaces && !surfaces->empty()) surfaces->transmission(rays, shares);
    }
}

// A connection to a sampled point of an area light's face.
Connection connection_to_face(const Light& light, vec3 point, int index, vec2 u) {
    const AreaSample sample = sample_area(*light.area, point, u);
    Connection c;
    c.point = point, c.to_light = c.shadow = sample.direction;
    c.fog_length = sample.distance, c.shadow_length = sample.distance * shadow_reach<float>;
    c.steradians = sample.steradians;
    c.irradiance =
        radiance_of(light) * sample.steradians * face_texture(*light.area, point + sample.distance * sample.direction);
    c.shadows = light.shadows, c.casters = light.casters, c.light_index = index;
    return c;
}

void connect_packet(const PathTracer& tracer, std::span<Connection> connections, const RayBatch& batch,
                    std::span<Scatter> results) {
    float visibility[16];
    find_visibility(tracer, connections, visibility);
    for (size_t i = 0; i < connections.size(); ++i) {
        Connection& c = connections[i];
        vec3 passing(visibility[i]);
        const Ray way{c.point, c.to_light, c.fog_length};
        for (const Medium& medium : tracer.snapshot.media)
            if (max_component(passing) > 0)
                passing *= channel_transmittance(medium, c.light * passing, way, {0, c.fog_length}, c.random,
                                                 results[c.lane].steps);
        const vec3 arriving = c.light * passing;
        (c.in_fog ? results[c.lane].radiance : results[c.lane].surface) += arriving;
        if (!c.in_fog || batch.parts.empty()) continue;
        const bool other = c.light_index < 0;
        batch.part(c.lane, other ? batch.index_of(c.other) : static_cast<size_t>(c.light_index)) += arriving;
    }
}
}

void find_visibility(const PathTracer& tracer, std::span<const Connection> connections, float* visibility) {
    alignas(64) float shares[16];
    Occluders::ShadowRays rays{};
    bool any = false;
    for (size_t i = 0; i < connections.size(); ++i) {
        const Connection& c = connections[i];
        shares[i] = 1;
        if (!c.shadows || !(max_component(c.light) > 0)) continue;
        rays.set(i, off_surface(c.face_normal, {c.point, c.shadow, c.shadow_length}));
        any = true;
    }
    if (any) trace_shadows(tracer.snapshot, connections, rays, shares);
    std::copy_n(shares, connections.size(), visibility);
}

Connection connection_to_light(const PathTracer& tracer, vec3 point, int index, vec3 to_light, vec2 u) {
    const Light& light = tracer.snapshot.lights[index];
    if (light.area) return connection_to_face(light, point, index, u);
    const Ray shadow = ray_to_light(light, point, is_soft(light) ? u : vec2(0));
    Connection c;
    c.point = point, c.to_light = to_light;
    c.fog_length = infinity;
    if (!is_distant(light)) c.fog_length = std::max(0.0f, glm::length(light.position - point) - light.radius);
    c.shadow = shadow.direction, c.shadow_length = shadow.t_max;
    c.shadows = light.shadows, c.casters = light.casters, c.light_index = index;
    return c;
}

Connection connection_to_emitter(const Snapshot& snapshot, vec3 point, const EmissivePoint& target) {
    const vec3 offset = target.position - point;
    const float distance = glm::length(offset);
    Connection c;
    c.point = point;
    c.to_light = c.shadow = offset / distance;
    c.fog_length = distance, c.shadow_length = distance * shadow_reach<float>;
    c.casters = emission_links(snapshot, target.instance).x;
    return c;
}

Connection connection_to_fire(vec3 point, const EmissionSample& target) {
    const vec3 offset = target.position - point;
    const float distance = std::max(glm::length(offset), 1e-20f);
    Connection c;
    c.point = point;
    c.to_light = c.shadow = offset / distance;
    c.fog_length = c.shadow_length = distance;
    return c;
}

Connection connection_to_sky(const Environment& environment, vec3 point, vec3 direction) {
    Connection c;
    c.point = point;
    c.to_light = c.shadow = direction;
    c.fog_length = c.shadow_length = infinity;
    c.shadows = environment.shadows, c.casters = environment.casters, c.other = OtherLight::ambient;
    return c;
}

void connect(const PathTracer& tracer, std::vector<Connection>& connections, const RayBatch& batch,
             std::span<Scatter> results) {
    for (size_t first = 0; first < connections.size(); first += 16) {
        const size_t count = std::min<size_t>(16, connections.size() - first);
        connect_packet(tracer, std::span(connections).subspan(first, count), batch, results);
    }
    connections.clear();
}
}
