#include "trace/fluence/light_emission.h"
#include "scene/area_shape.h"
#include "scene/light.h"
#include "scene/light_filter.h"
#include "trace/lights/environment.h"

namespace tyndall {
namespace {
vec2 on_disc(vec2 u) {
    const float radius = std::sqrt(u.x), angle = 2 * pi * u.y;
    return radius * vec2(std::cos(angle), std::sin(angle));
}

// A uniformly distributed point of a rectangle or disc.
vec3 face_place(const AreaShape& face, vec2 u) {
    const vec2 place = (face.kind == LightKind::disc ? on_disc(u) : 2.0f * u - 1.0f) * face.half;
    return face.center + place.x * face.right + place.y * face.up;
}

vec3 corner(const Box& box, int i) {
    return {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z};
}

void fit_sun(const Box& reach, LightSquare& square) {
    square.low = vec2(infinity), square.high = vec2(-infinity), square.start = infinity;
    float end = -infinity;
    for (int i = 0; i < 8; ++i) {
        const vec3 point = corner(reach, i);
        const vec2 at(glm::dot(point, square.across), glm::dot(point, square.up));
        square.low = glm::min(square.low, at), square.high = glm::max(square.high, at);
        square.start = std::min(square.start, glm::dot(point, square.axis));
        end = std::max(end, glm::dot(point, square.axis));
    }
    // Slanted rays of a soft sun may start outside the box's silhouette.
    const float slant = std::tan(std::min(square.light->angle, 1.5f)) * (end - square.start);
    square.low -= slant, square.high += slant;
    const vec2 size = square.high - square.low;
    square.power = square.light->intensity * (size.x * size.y);
}

// Directions of a local light: a spot's cone, or the cone around the box.
void fit_directions(const Box& reach, LightSquare& square) {
    const Light& light = *square.light;
    vec3 axis = light.direction;
    float cosine = std::cos(std::min(light.outer_cone, pi));
    if (shines_around(light)) {
        const vec3 towards = reach.center() - light.position;
        const float distance = glm::length(towards),
                    radius =
                        0.5f * glm::length(reach.size()) + (light.area ? glm::length(light.area->half) : light.radius);
        cosine = distance > radius ? std::sqrt(1 - radius * radius / (distance * distance)) : -1;
        axis = distance > radius ? towards / distance : vec3(0, 1, 0);
    }
    square.axis = axis, square.lowest_cosine = cosine;
    make_frame(axis, square.across, square.up);
    square.power = light.intensity * (2 * pi * (1 - cosine));
}

LightSquare square_of(const Light& light, const Box& reach) {
    LightSquare square;
    square.light = &light;
    square.axis = light.direction;
    make_frame(square.axis, square.across, square.up);
    is_distant(light) ? fit_sun(reach, square) : fit_directions(reach, square);
    return square;
}

LightSquare square_of(const std::shared_ptr<const Environment>& environment, const Box& reach) {
    Light light;
    light.name = environment->name, light.kind = LightKind::sun, light.shadows = environment->shadows;
    light.volume_scale = environment->volume_scale, light.surface_scale = environment->surface_scale;
    light.casters = environment->casters, light.lit = environment->lit;
    LightSquare square;
    square.environment = environment, square.as_light = std::make_shared<const Light>(std::move(light));
    square.light = square.as_light.get();
    square.center = reach.center(), square.radius = 0.5f * glm::length(reach.size());
    square.power = environment->mean() * (4 * pi * pi * square.radius * square.radius);
    return square;
}
}

std::vector<LightSquare> squares_of(const Snapshot& snapshot, const Box& reach) {
    std::vector<LightSquare> squares;
    for (const Light& light : snapshot.lights) squares.push_back(square_of(light, reach));
    if (snapshot.environment) squares.push_back(square_of(snapshot.environment, reach));
    return squares;
}

Ray LightSquare::ray(vec2 place, vec2 soft) const {
    if (environment) {
        const vec3 from = sample_environment(*environment, place).direction;
        vec3 x, y;
        make_frame(from, x, y);
        const vec2 at = on_disc(soft);
        return {center + radius * (from + at.x * x + at.y * y), -from};
    }
    if (is_distant(*light)) {
        const vec2 at = low + place * (high - low), disc = on_disc(soft) * std::tan(light->angle);
        const vec3 direction = light->angle > 0 ? glm::normalize(axis + disc.x * across + disc.y * up) : axis;
        return {at.x * across + at.y * up + start * axis, direction};
    }
    const float cosine = 1 - place.x * (1 - lowest_cosine), sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float angle = 2 * pi * place.y;
    const vec3 direction = glm::normalize(sine * (std::cos(angle) * across + std::sin(angle) * up) + cosine * axis);
    if (light->area && light->area->kind != LightKind::sphere) return {face_place(*light->area, soft), direction};
    vec3 x, y;
    make_frame(direction, x, y);
    const vec2 disc = on_disc(soft);
    return {light->position + light->radius * (direction + disc.x * x + disc.y * y), direction};
}

vec3 LightSquare::share(const Ray& ray) const {
    const vec3 direction = ray.direction;
    if (environment) {
        const float density = environment_density(*environment, -direction);
        if (!(density > 0)) return vec3(0);
        const vec3 mean = environment->mean();
        return environment_radiance(*environment, -direction) / glm::max(mean, 1e-30f) / (4 * pi * density);
    }
    vec3 share(has_cone(*light) ? cone_falloff(*light).at(glm::dot(direction, light->direction)) : 1.0f);
    if (light->filter) share *= vec3(filtered(*light->filter, dvec3(direction)));
    if (light->area) share *= face_texture(*light->area, ray.origin);
    return share;
}
}
