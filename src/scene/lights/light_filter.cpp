#include "scene/lights/light_filter.h"

#include "scene/light.h"
#include "scene/lights/gobo.h"
#include "scene/photometry/ies_profile.h"

#include <algorithm>

namespace tyndall {
LightAxes light_axes(vec3 direction, vec3 up, float turn) {
    vec3 right(0);
    for (const vec3 upright : {up, vec3(0, 0, -1), vec3(1, 0, 0)}) {
        right = glm::cross(direction, upright);
        if (glm::dot(right, right) > 1e-8f * glm::dot(upright, upright)) break;
    }
    right = glm::normalize(right);
    const vec3 upwards = glm::cross(right, direction);
    const float c = std::cos(turn), s = std::sin(turn);
    return {c * right + s * upwards, c * upwards - s * right};
}

dvec3 filtered(const LightFilter& filter, dvec3 direction) {
    const double along = glm::dot(direction, dvec3(filter.direction));
    const auto across = [&](const LightAxes& axes) {
        return dvec3(glm::dot(direction, dvec3(axes.right)), glm::dot(direction, dvec3(axes.up)), along);
    };
    dvec3 factors(1);
    if (filter.profile) factors *= profile_factor(*filter.profile, across(filter.profile_axes));
    if (!filter.gobo) return factors;
    if (!(along > 0)) return dvec3(0);
    const dvec3 at = across(filter.gobo_axes) / along;
    return factors * gobo_at(*filter.gobo, 0.5 + 0.5 * at.x / double{filter.gobo_half.x},
                             0.5 - 0.5 * at.y / double{filter.gobo_half.y});
}

bool has_colors(const LightFilter& filter) { return filter.gobo && filter.gobo->planes > 1; }

float finest_detail(const LightFilter& filter) {
    float detail = filter.profile ? filter.profile->detail : pi;
    if (filter.gobo) detail = std::min(detail, 2 * filter.gobo_half.x / filter.gobo->levels[0].texels.x);
    return detail;
}

FactorMean mean_factor(const Light& light) {
    constexpr int rings = 64, around = 64;
    const ConeFalloff cone = cone_falloff(light);
    const float lowest = has_cone(light) ? std::cos(light.outer_cone) : -1;
    vec3 x, y;
    make_frame(light.direction, x, y);
    dvec3 sum(0);
    double all = 0, squares = 0;
    for (int ring = 0; ring < rings; ++ring) {
        const float cosine = 1 - (1 - lowest) * (static_cast<float>(ring) + 0.5f) / rings;
        const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
        const double weight = has_cone(light) ? double{cone.at(cosine)} : 1.0;
        for (int k = 0; k < around; ++k) {
            const float angle = 2 * pi * (static_cast<float>(k) + 0.5f) / around;
            const vec3 direction = cosine * light.direction + sine * (std::cos(angle) * x + std::sin(angle) * y);
            const dvec3 factors = light.filter ? filtered(*light.filter, dvec3(direction)) : dvec3(1);
            const double brightness = luminance(vec3(factors));
            sum += weight * factors, squares += weight * brightness * brightness, all += weight;
        }
    }
    if (!(all > 0)) return {};
    const vec3 mean(sum / all);
    const double brightness = luminance(mean);
    if (!(brightness > 0)) return {mean, 0};
    return {mean, static_cast<float>(std::sqrt(std::max(squares / all - brightness * brightness, 0.0)) / brightness)};
}

float cone_angle(const Light& light) { return has_cone(light) ? 2 * light.outer_cone : 2 * pi; }

int gobo_mip_level(const LightFilter& filter, float angle) {
    return filter.gobo ? gobo_level(*filter.gobo, angle / (2 * std::atan(filter.gobo_half.x))) : 0;
}
}
