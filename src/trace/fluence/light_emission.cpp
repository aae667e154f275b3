#include "trace/fluence/light_emission.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/light_filter.h"
#include "trace/fluence/light_paths.h"
#include "trace/lights/environment.h"
#include "trace/snapshot.h"

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

void fit_sun(const Box& reach, LightSquare& square) {
    square.low = vec2(infinity), square.high = vec2(-infinity), square.start = infinity;
    float end = -infinity;
    for (int i = 0; i < 8; ++i) {
        const vec3 point = reach.corner(i);
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

// The directions from a point to a ball; all if it is inside.
DirectionCone cone_around(vec3 center, float radius, vec3 from) {
    const vec3 towards = center - from;
    const float distance = glm::length(towards);
    if (!(distance > radius)) return {};
    const float square = radius / distance * (radius / distance);
    return {towards / distance, square / (1 + std::sqrt(1 - square))};
}

bool is_flat(const Light& light) { return light.area && light.area->kind != LightKind::sphere; }

// Of a light larger than the box, rays are chosen by where they cross the box.
bool dwarfs(const Light& light, float radius) {
    return (is_flat(light) ? glm::length(light.area->half) : light.radius) > radius;
}

DirectionCone own_cone(const Light& light) {
    if (!has_cone(light) || is_flat(light)) return {};
    const float half = std::sin(0.5f * std::min(light.outer_cone, pi));
    return {light.direction, 2 * half * half};
}

void fit_directions(LightSquare& square) {
    const Light& light = *square.light;
    const float reach = square.radius + (is_flat(light) ? glm::length(light.area->half) : light.radius);
    square.cone = cone_around(square.center, reach, light.position);
    if (const DirectionCone own = own_cone(light); own.span < square.cone.span) square.cone = own;
    square.power = light.intensity * (2 * pi * square.cone.span);
    if (!dwarfs(light, square.radius)) return;
    const float area = is_flat(light) ? face_area(*light.area) : pi * light.radius * light.radius;
    square.power *= pi * square.radius * square.radius / area;
}

LightSquare square_around(const Box& reach) {
    LightSquare square;
    square.center = reach.center(), square.radius = 0.5f * glm::length(reach.size());
    return square;
}

LightSquare square_of(const Light& light, const Box& reach) {
    LightSquare square = square_around(reach);
    square.light = &light;
    square.axis = light.direction;
    make_frame(square.axis, square.across, square.up);
    is_distant(light) ? fit_sun(reach, square) : fit_directions(square);
    return square;
}

LightSquare square_of(const std::shared_ptr<const Environment>& environment, const Box& reach) {
    Light light;
    light.name = environment->name, light.kind = LightKind::sun, light.shadows = environment->shadows;
    light.volume_scale = environment->volume_scale, light.surface_scale = environment->surface_scale;
    light.casters = environment->casters, light.lit = environment->lit;
    LightSquare square = square_around(reach);
    square.environment = environment, square.as_light = std::make_shared<const Light>(std::move(light));
    square.light = square.as_light.get();
    square.power = environment->mean() * (4 * pi * pi * square.radius * square.radius);
    return square;
}
}

namespace {
// Whether a ray of the same light lies in the square.
bool covers(const LightSquare& square, const Ray& ray) {
    if (square.environment) {
        const vec3 off = ray.origin - square.center;
        return glm::length(off - glm::dot(off, ray.direction) * ray.direction) < square.radius;
    }
    const float until = square.start - glm::dot(ray.origin, square.axis);
    const vec3 point = ray.at(until / glm::dot(ray.direction, square.axis));
    const vec2 at(glm::dot(point, square.across), glm::dot(point, square.up));
    return glm::all(glm::greaterThanEqual(at, square.low)) && glm::all(glm::lessThan(at, square.high));
}

// Adds a light's square around the box; for distant light also one around much smaller fog, with half of the paths.
template<class L>
void add_squares(const L& light, const Box& reach, const Box& fog, std::vector<LightSquare>& squares) {
    constexpr double much_smaller = 0.5, share_of_fog = 0.5;
    LightSquare whole = square_of(light, reach);
    whole.weight = luminance(whole.power);
    if (is_distant(*whole.light) && !fog.empty()) {
        LightSquare around_fog = square_of(light, fog);
        if (luminance(around_fog.power) < much_smaller * whole.weight) {
            around_fog.back = whole.environment ? glm::distance(around_fog.center, whole.center) + whole.radius
                                                : around_fog.start - whole.start;
            around_fog.weight = share_of_fog * whole.weight, whole.weight -= around_fog.weight;
            whole.left_out = std::make_shared<const LightSquare>(around_fog);
            squares.push_back(std::move(around_fog));
        }
    }
    squares.push_back(std::move(whole));
}
}

std::vector<LightSquare> squares_of(const Snapshot& snapshot, const Box& reach) {
    std::vector<LightSquare> squares;
    const Box fog = fog_bounds(snapshot, reach);
    for (const Light& light : snapshot.lights) add_squares(light, reach, fog, squares);
    if (snapshot.environment) add_squares(snapshot.environment, reach, fog, squares);
    return squares;
}

vec3 DirectionCone::direction(vec2 u) const {
    const float off = u.x * span, sine = std::sqrt(off * (2 - off)), angle = 2 * pi * u.y; // off: 1 - cosine
    vec3 x, y;
    make_frame(axis, x, y);
    return glm::normalize(sine * (std::cos(angle) * x + std::sin(angle) * y) + (1 - off) * axis);
}

namespace {
Ray local_ray(const LightSquare& square, vec2 place, vec2 soft) {
    const Light& light = *square.light;
    const bool crosses = dwarfs(light, square.radius);
    if (is_flat(light) && !crosses) {
        const vec3 origin = face_place(*light.area, soft);
        return {origin, cone_around(square.center, square.radius, origin).direction(place)};
    }
    const vec3 direction = square.cone.direction(place);
    vec3 x, y;
    make_frame(direction, x, y);
    const vec2 disc = on_disc(soft);
    const vec3 point = (crosses ? square.center : light.position) +
                       (crosses ? square.radius : light.radius) * (disc.x * x + disc.y * y);
    const vec3 off = point - light.position;
    const float along = glm::dot(off, direction);
    if (is_flat(light)) {
        const vec3& normal = light.area->normal;
        return {point - glm::dot(point - light.area->center, normal) / glm::dot(direction, normal) * direction,
                direction};
    }
    // A ball's rays start at its surface, those of other lights at a disc in front of it.
    const float beside = std::max(glm::dot(off, off) - along * along, 0.0f), squared = light.radius * light.radius;
    const float front = light.area ? std::sqrt(std::max(squared - beside, 0.0f)) : light.radius;
    return {point + (front - along) * direction, direction};
}
}

Ray LightSquare::ray(vec2 place, vec2 soft) const {
    if (environment) {
        const vec3 from = sample_environment(*environment, place).direction;
        vec3 x, y;
        make_frame(from, x, y);
        const vec2 at = on_disc(soft);
        return {center + radius * (from + at.x * x + at.y * y) + back * from, -from};
    }
    if (is_distant(*light)) {
        const vec2 at = low + place * (high - low), disc = on_disc(soft) * std::tan(light->angle);
        const vec3 direction = light->angle > 0 ? glm::normalize(axis + disc.x * across + disc.y * up) : axis;
        return {at.x * across + at.y * up + start * axis - back / glm::dot(direction, axis) * direction, direction};
    }
    return local_ray(*this, place, soft);
}

namespace {
bool is_on(const AreaShape& face, vec3 point) {
    const vec2 at = vec2(glm::dot(point - face.center, face.right), glm::dot(point - face.center, face.up)) / face.half;
    return face.kind == LightKind::disc ? glm::dot(at, at) <= 1 : std::max(std::abs(at.x), std::abs(at.y)) <= 1;
}

// Of a light larger than the box: 1 on it, 0 beside it; divided by the cosine with which a face emits.
float share_across(const Light& light, const Ray& ray) {
    const vec3 off = ray.origin - light.position;
    if (is_flat(light)) {
        const float cosine = std::abs(glm::dot(ray.direction, light.area->normal));
        return is_on(*light.area, ray.origin) && cosine > 1e-4f ? 1 / cosine : 0;
    }
    return glm::length(off - glm::dot(off, ray.direction) * ray.direction) <= light.radius ? 1 : 0;
}
}

vec3 LightSquare::share(const Ray& ray) const {
    const vec3 direction = ray.direction;
    if (left_out && covers(*left_out, ray)) return vec3(0);
    if (environment) {
        const float pdf = environment_pdf(*environment, -direction);
        if (!(pdf > 0)) return vec3(0);
        const vec3 mean = environment->mean();
        return environment_radiance(*environment, -direction) / glm::max(mean, 1e-30f) / (4 * pi * pdf);
    }
    vec3 share(has_cone(*light) ? cone_falloff(*light).at(glm::dot(direction, light->direction)) : 1.0f);
    if (light->filter) share *= vec3(filtered(*light->filter, dvec3(direction)));
    if (dwarfs(*light, radius))
        share *= share_across(*light, ray);
    else if (is_flat(*light))
        share *= cone_around(center, radius, ray.origin).span / cone.span;
    if (light->area) share *= face_texture(*light->area, ray.origin);
    return share;
}
}
