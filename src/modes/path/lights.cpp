// Sampling of lights, and of distances along lines.
#include "modes/path/lights.h"

#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/light_filter.h"
#include "scene/lights/light_reach.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
// Estimated mean transmission of a light's filter along a line, never 0: probabilities may be small where no light
// arrives, but 0 only where none can.
float filter_mean(const Light& light, const Ray& line, const LineLight& along) {
    constexpr int places = 8;
    constexpr float certain = 0.05f;
    if (!light.filter) return 1;
    double sum = 0;
    for (int i = 0; i < places; ++i) {
        const vec3 offset = line.at(along.distance((static_cast<float>(i) + 0.5f) / places)) - light.position;
        const float distance = glm::length(offset);
        if (distance > 0) sum += luminance(vec3(filtered(*light.filter, dvec3(offset) / double{distance})));
    }
    return certain + (1 - certain) * static_cast<float>(sum / places);
}

float volume_brightness(const Light& light) { return luminance(light.intensity) * light.volume_scale; }

// From the first fog to the last; unbounded fog counts up to 8 optical depths or the end of the scene.
Interval<float> fog_on(const Snapshot& snapshot, const Ray& line) {
    return fog_interval(snapshot.media, line, [&](const Medium& medium, const Interval<float>& inside) {
        const Interval<float> scene = clip(snapshot.bounds, line.origin, line.direction, inside);
        return std::max(scene.empty() ? 0 : scene.high, inside.low + 8 / medium.majorant());
    });
}

// Estimated irradiance at a point, for picking lights.
LightSample expected(const Light& light, vec3 point) {
    LightSample arriving = arrival(light, point);
    if (light.area) arriving.irradiance = rough_irradiance(light, point);
    return arriving;
}

// Upper bound on a surface's cosine to any point of a light; `cosine`: that to its center.
float expected_cosine(const Light& light, vec3 point, float cosine) {
    if (!light.area) return std::max(0.0f, cosine);
    const float reach = glm::length(light.area->half), distance = glm::distance(point, light.area->center);
    return distance > reach ? std::clamp(cosine + reach / distance, 0.0f, 1.0f) : 1.0f;
}

LineLight light_on_line(const Light& light, const Ray& line, Interval<float> stretch) {
    LineLight along;
    along.reach = stretch;
    if (is_distant(light)) {
        along.probability = volume_brightness(light) * along.reach.length();
        return along;
    }
    const dvec3 offset = dvec3(light.position) - dvec3(line.origin), direction(line.direction);
    const double nearest = glm::dot(offset, direction), radius = capped_radius(light);
    along.reach = light_reach(light, line, stretch);
    if (along.reach.empty()) return along;
    along.angles = equi_angular<double>(nearest, std::max(glm::length(offset - nearest * direction), radius),
                                        along.reach.low, along.reach.high);
    const double angle = along.angles.to - along.angles.from;
    if (angle > 0)
        along.probability = static_cast<float>(volume_brightness(light) * angle / along.angles.height) *
                            filter_mean(light, line, along);
    return along;
}

template<class Irradiance> LightPick pick(size_t count, float u, const Irradiance& irradiance) {
    double total = 0;
    for (size_t i = 0; i < count; ++i) total += luminance(irradiance(i).irradiance);
    if (!(total > 0)) return {};
    double left = u * total;
    LightPick result;
    for (size_t i = 0; i < count; ++i) {
        const LightSample arriving = irradiance(i);
        const double share = luminance(arriving.irradiance);
        if (!(share > 0)) continue;
        result = {static_cast<int>(i), static_cast<float>(share / total), arriving.irradiance, arriving.to_light};
        if ((left -= share) < 0) break;
    }
    return result;
}
}

float LineLight::distance(float u) const {
    if (angles.height == 0) return reach.low + u * reach.length();
    return std::clamp(static_cast<float>(angles.at(u).t), reach.low, reach.high);
}

float LineLight::pdf(float t) const {
    if (!(probability > 0) || !(t >= reach.low && t <= reach.high)) return 0;
    return angles.height == 0 ? 1 / reach.length() : static_cast<float>(angles.pdf(t));
}

void lights_on_line(const Snapshot& snapshot, const Ray& line, std::vector<LineLight>& lights) {
    lights.clear();
    const Interval<float> stretch = fog_on(snapshot, line);
    double total = 0;
    for (const Light& light : snapshot.lights) {
        lights.push_back(stretch.empty() ? LineLight{} : light_on_line(light, line, stretch));
        total += lights.back().probability;
    }
    if (total > 0)
        for (LineLight& along : lights) along.probability = static_cast<float>(along.probability / total);
}

LightPick pick_light(const Snapshot& snapshot, vec3 point, float u) {
    return pick(snapshot.lights.size(), u, [&](size_t i) {
        LightSample arriving = expected(snapshot.lights[i], point);
        arriving.irradiance *= snapshot.lights[i].volume_scale;
        return arriving;
    });
}

LightPick pick_light(const Snapshot& snapshot, const SurfacePoint& surface, float u) {
    return pick(snapshot.lights.size(), u, [&](size_t i) {
        const Light& light = snapshot.lights[i];
        LightSample arriving = expected(light, surface.position);
        const float cosine = expected_cosine(light, surface.position, glm::dot(surface.normal, arriving.to_light));
        arriving.irradiance *= is_lit(light, snapshot, surface.instance) ? light.surface_scale * cosine : 0.0f;
        return arriving;
    });
}

float pick_probability(const Snapshot& snapshot, vec3 point, int light) {
    double total = 0, wanted = 0;
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const double share =
            luminance(expected(snapshot.lights[i], point).irradiance) * snapshot.lights[i].volume_scale;
        total += share;
        if (static_cast<int>(i) == light) wanted = share;
    }
    return total > 0 ? static_cast<float>(wanted / total) : 0;
}
}
