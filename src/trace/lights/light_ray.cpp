#include "trace/lights/light_ray.h"
#include "scene/light.h"

namespace tyndall {
LightPoint center_of(const Light& light) {
    if (is_distant(light)) return {-glm::normalize(dvec3(light.direction)), true};
    return {dvec3(light.position), false, dvec3(light.position), light.radius};
}

Ray ray_to_point(const LightPoint& to, dvec3 from) {
    const dvec3 towards = to.far ? to.at : to.at - from;
    const double distance = glm::length(towards);
    const dvec3 direction = towards / distance;
    double end = to.far ? double(infinity) : distance;
    if (to.radius > 0) { // ends at the surface of the sphere
        const dvec3 center = to.center - from;
        const double along = glm::dot(center, direction), off = glm::dot(center, center) - along * along;
        end = along - std::sqrt(std::max(to.radius * to.radius - off, 0.0));
    }
    return {vec3(from), vec3(direction), static_cast<float>(std::max(end, 0.0) * shadow_reach<double>)};
}

LightPoint point_on(const Light& light, const Ray& ray, vec3 u) {
    LightPoint result = center_of(light);
    if (is_distant(light)) {
        result.at = glm::normalize(dvec3(ray_to_light(light, ray.origin, vec2(u)).direction));
        return result;
    }
    // The uniform surface of a sphere in 4D projects to this density in 3D, and to a uniform disc in 2D.
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
