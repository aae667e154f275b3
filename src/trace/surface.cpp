// Shades Lambertian surfaces with every light, attenuated by the fog in between.
#include "trace/surface.h"
#include "trace/lights/environment.h"
#include "trace/lights/faces.h"
#include "trace/lights/light_ray.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <array>

namespace tyndall {
namespace {
// Sixteen points, padded with the last one.
struct Packet {
    alignas(64) float x[16], y[16], z[16];
    alignas(64) int32_t active[16];
    vec3 irradiance[16]; // of the current light, cosine included
};

// Unoccluded irradiance at each point, on the visible side. False if it is 0 at all of them.
bool gather_light(const Light& light, const Snapshot& snapshot, std::span<const SurfacePoint> points, Packet& packet) {
    bool any = false;
    for (size_t i = 0; i < 16; ++i) {
        packet.active[i] = 0, packet.irradiance[i] = vec3(0);
        if (i >= points.size() || !is_lit(light, snapshot, points[i].instance)) continue;
        const LightSample arriving = arrival(light, points[i].position);
        const float cosine = dot(points[i].normal, arriving.to_light);
        const vec3 irradiance = arriving.irradiance * (std::max(cosine, 0.0f) * light.surface_scale);
        if (!(max_component(irradiance) > 0)) continue;
        packet.irradiance[i] = irradiance;
        packet.active[i] = -1, any = true;
    }
    return any;
}

// Transmission from each surface point to a point of the light; `u` chooses the latter, one sample pair each.
void see_light(const Occluders& occluders, const Light& light, std::span<const SurfacePoint> points, const vec2* u,
               const Packet& packet, float* visibility) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint& point = points[i];
        rays.set(i, off_surface(point.face_normal, ray_to_light(light, point.position, u[i])));
        rays.active[i] = packet.active[i];
    }
    occluders.transmission(rays, visibility);
}

void cast_shadows(const Occluders& occluders, const Light& light, std::span<const SurfacePoint> points,
                  std::span<const vec2> u, Packet& packet) {
    const size_t count = is_soft(light) ? u.size() / points.size() : 1;
    float total[16] = {};
    for (size_t k = 0; k < count; ++k) {
        vec2 picked[16] = {};
        alignas(64) float visibility[16] = {};
        if (is_soft(light))
            for (size_t i = 0; i < points.size(); ++i) picked[i] = u[i * count + k];
        see_light(occluders, light, points, picked, packet, visibility);
        for (size_t i = 0; i < points.size(); ++i) total[i] += visibility[i];
    }
    for (size_t i = 0; i < points.size(); ++i) packet.irradiance[i] *= total[i] / static_cast<float>(count);
}

void dim(const LightDepth& depth, Packet& packet) {
    alignas(64) float optical_depth[16];
    light_depths(depth, packet.x, packet.y, packet.z, packet.active, optical_depth);
    for (int i = 0; i < 16; ++i) packet.irradiance[i] *= std::exp(-optical_depth[i]);
}
}

void shade_surfaces(const Snapshot& snapshot, std::span<const LightDepth> depths, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light) {
    const size_t lights = snapshot.lights.size();
    if (per_light) per_light->assign(points.size() * lights, vec3(0));
    Packet packet;
    for (size_t i = 0; i < 16; ++i) {
        const vec3 position = points[std::min(i, points.size() - 1)].position;
        packet.x[i] = position.x, packet.y[i] = position.y, packet.z[i] = position.z;
    }
    for (size_t i = 0; i < points.size(); ++i)
        radiance[i] = points[i].base_color * snapshot.ambient + points[i].emission;

    for (size_t l = 0; l < lights; ++l) {
        const Light& light = snapshot.lights[l];
        if (light.area) {
            std::array<vec3, 16> irradiance{};
            add_face_light(snapshot, light, l < depths.size(), points, u, irradiance);
            std::copy_n(irradiance.begin(), 16, packet.irradiance);
        } else {
            if (!gather_light(light, snapshot, points, packet)) continue;
            if (const auto& occluders = shadow_casters(light, snapshot))
                cast_shadows(*occluders, light, points, u, packet);
            if (l < depths.size()) dim(depths[l], packet);
        }
        for (size_t i = 0; i < points.size(); ++i) {
            const vec3 added = points[i].base_color * packet.irradiance[i] / pi;
            radiance[i] += added;
            if (per_light) (*per_light)[i * lights + l] = added;
        }
    }
    if (snapshot.environment) add_environment(snapshot, points, u, radiance);
}

vec3 cosine_direction(vec3 normal, vec2 u) {
    vec3 x, y;
    make_frame(normal, x, y);
    const float across = std::sqrt(u.x), turned = 2 * pi * u.y, cosine = std::sqrt(std::max(0.0f, 1 - u.x));
    return glm::normalize(across * std::cos(turned) * x + across * std::sin(turned) * y + cosine * normal);
}
}
