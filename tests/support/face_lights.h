// Lights that are faces, made in memory.
#pragma once
#include "scene/lights/area_shape.h"
#include "scene/lights/light_filter.h"

namespace tyndall::test {
// Of one nit unless said; `size`: width and height, or the radius twice.
inline Light face_light(LightKind kind, vec3 center, vec3 normal, vec2 size, vec3 nits = vec3(1),
                        bool two_sided = false) {
    AreaShape shape;
    shape.kind = kind, shape.center = center, shape.normal = glm::normalize(normal);
    const LightAxes axes = light_axes(shape.normal, {0, 1, 0}, 0);
    shape.right = axes.right, shape.up = axes.up;
    shape.half = kind == LightKind::rectangle ? 0.5f * size : size;
    shape.two_sided = two_sided;
    Light light;
    light.name = "face";
    light.position = center, light.direction = shape.normal, light.intensity = nits * face_area(shape);
    make_punctual(shape, light);
    return light;
}
inline Light rectangle_light(vec3 center, vec3 normal, vec2 size, vec3 nits = vec3(1)) {
    return face_light(LightKind::rectangle, center, normal, size, nits);
}
// The same with a picture on it.
inline Light picture_light(const Light& light, std::shared_ptr<const Gobo> texture) {
    AreaShape shape = *light.area;
    shape.texture = std::move(texture);
    Light result = light;
    make_punctual(shape, result);
    return result;
}
inline Light disc_light(vec3 center, vec3 normal, float radius, vec3 nits = vec3(1)) {
    return face_light(LightKind::disc, center, normal, vec2(radius), nits);
}
inline Light sphere_light(vec3 center, float radius, vec3 nits = vec3(1)) {
    return face_light(LightKind::sphere, center, {0, -1, 0}, vec2(radius), nits);
}
}
