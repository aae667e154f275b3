// A light at one time, as in KHR_lights_punctual plus soft edges, and the light it sends to a point.
#pragma once
#include "base/math.h"
#include "scene/lights/light_kind.h"

#include <memory>
#include <string>

namespace tyndall {
struct AreaShape;
struct LightFilter;

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    vec3 position{0};                          // point, spot
    vec3 direction{0, -1, 0};                  // unit, direction of travel: spot axis, sun
    vec3 intensity{1};                         // candela (point, spot) or lux (sun), including color
    float volume_scale = 1;                    // multiplies the light in fog
    float surface_scale = 1;                   // multiplies the light on surfaces
    float inner_cone = 0, outer_cone = pi / 4; // half angles of a spot
    float range = infinity;                    // meters; the light fades to 0 there
    float radius = 0;                          // meters; point, spot: soft shadows, and 1/r² is capped inside
    float core = 1e-4f;                        // meters; 1/r² is always capped inside this
    float angle = 0;                           // radians, half angle of the sun's disc
    std::shared_ptr<const LightFilter> filter; // point, spot: directional factors on the intensity; null = none
    // Rectangle, disc, sphere: the emitting shape; null = none. All other members then describe the light that
    // approximates it (make_punctual() in scene/lights/area_shape.h), for callers to which its size does not matter.
    std::shared_ptr<const AreaShape> area;
    bool shadows = true;
    int casters = -1, lit = -1; // surfaces that shadow it and that it lights: indices of snapshot sets; -1 = all
};

// Whether its shadows have soft edges: each shadow ray then goes to a different point of the light.
bool is_soft(const Light& light);

// The light's contribution to the scene's bounds: its position; empty for suns.
Box light_bounds(const Light& light);

// Unoccluded light at a point: irradiance on a surface facing the light (or lux for fog).
struct LightSample {
    vec3 irradiance{0};
    vec3 to_light{0, 1, 0};    // unit
    float distance = infinity; // meters, infinite for the sun
};
LightSample arrival(const Light& light, const vec3& point);

// Shadow rays end at this share of the distance to the light, just before it.
template<class T> inline constexpr T shadow_reach = static_cast<T>(0.9999);

// The shadow ray to a point on the light, sampled from u in [0,1)²: uniform over the solid angle of the light's sphere
// or disc, or its center for a point light.
Ray ray_to_light(const Light& light, vec3 point, vec2 u);

// The radius inside which 1/r² is capped.
inline float capped_radius(const Light& light) { return std::max(light.radius, light.core); }

// KHR_lights_punctual's range window: 1 near the light, 0 at the range.
inline float range_window(float distance, float range) {
    if (std::isinf(range)) return 1;
    const float x = distance / range, x4 = x * x * x * x;
    return std::clamp(1 - x4, 0.0f, 1.0f);
}

// Least width, in cosines, of the soft edge of a cone. KHR_lights_punctual's 0.001 against division by zero would dim
// cones under 2.6°; this is below any cone's own width.
inline double min_cone_edge(double outer_cone) {
    const double half = std::sin(0.5 * outer_cone);
    return std::clamp(0.5 * half * half, 1e-12, 1e-6);
}

// KHR_lights_punctual's cone: clamp(cosine · scale + offset, 0, 1)², 1 inside inner_cone, 0 outside outer_cone.
struct ConeFalloff {
    float scale, offset;
    float at(float cosine) const {
        const float x = std::clamp(cosine * scale + offset, 0.0f, 1.0f);
        return x * x;
    }
};
inline ConeFalloff cone_falloff(const Light& light) {
    const float outer = std::cos(light.outer_cone), least = static_cast<float>(min_cone_edge(light.outer_cone));
    const float scale = 1 / std::max(std::cos(light.inner_cone) - outer, least);
    return {scale, -outer * scale};
}
}
