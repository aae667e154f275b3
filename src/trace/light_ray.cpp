#include "trace/light_ray.h"
#include "scene/light.h"

namespace tyndall {
namespace {
// Direction inside a cone about `axis`, uniform over solid angle; one_minus_cosine is that of the cone's half angle.
vec3 cone_direction(vec3 axis, float one_minus_cosine, vec2 u) {
    const float height = u.x * one_minus_cosine; // 1 - cosine of the direction
    const float across = std::sqrt(std::max(0.0f, height * (2 - height))), turn = 2 * pi * u.y;
    vec3 x, y;
    make_frame(axis, x, y);
    return glm::normalize((1 - height) * axis + across * std::cos(turn) * x + across * std::sin(turn) * y);
}

float one_minus_cosine(float sine_squared) { return sine_squared / (1 + std::sqrt(std::max(0.0f, 1 - sine_squared))); }
}

Ray ray_to_light(const Light& light, vec3 point, vec2 u) {
    if (light.kind == LightKind::sun) {
        const float half = std::sin(0.5f * light.angle);
        return {point, light.angle > 0 ? cone_direction(-light.direction, 2 * half * half, u) : -light.direction};
    }
    const vec3 towards = light.position - point;
    const float distance = glm::length(towards);
    if (!(distance > light.radius)) return {point, -light.direction, 0};
    const vec3 axis = towards / distance;
    if (!(light.radius > 0)) return {point, axis, distance * 0.9999f};

    // Where the direction meets the ball: of the two roots of |t·d - towards|² = r², the nearer.
    const float sine = light.radius / distance;
    const vec3 direction = cone_direction(axis, one_minus_cosine(sine * sine), u);
    const float along = glm::dot(direction, towards);
    const vec3 off = towards - along * direction;
    const float half_chord = std::sqrt(std::max(0.0f, light.radius * light.radius - glm::dot(off, off)));
    return {point, direction, (along - half_chord) * 0.9999f};
}

LightPoint center_of(const Light& light) {
    if (light.kind == LightKind::sun) return {-glm::normalize(dvec3(light.direction)), true};
    return {dvec3(light.position), false, dvec3(light.position), light.radius};
}

LightPoint point_on(const Light& light, const Ray& ray, vec3 u) {
    LightPoint result = center_of(light);
    if (light.kind == LightKind::sun) {
        result.at = glm::normalize(dvec3(ray_to_light(light, ray.origin, vec2(u)).direction));
        return result;
    }
    // The sphere in four dimensions has this density when seen in three, and an even disc when seen in two.
    const float nearest = std::clamp(glm::dot(light.position - ray.origin, ray.direction), 0.0f, ray.t_max);
    const vec3 towards = light.position - ray.at(nearest);
    const float distance = glm::length(towards);
    const vec3 z = distance > 0 ? towards / distance : ray.direction;
    vec3 x, y;
    make_frame(z, x, y);
    const float across = light.radius * std::sqrt(u.x), along = light.radius * std::sqrt(1 - u.x);
    result.at += dvec3(across * std::cos(2 * pi * u.y) * x + across * std::sin(2 * pi * u.y) * y +
                       along * std::cos(2 * pi * u.z) * z);
    return result;
}
}
