// Positions of lights in the image for the radial blur, and their estimated brightness.
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"

#include "integrate/style.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr float far_away = 1e5f; // distance, in scene extents, of the point that stands for a sun

float smoothstep(float x) {
    const float t = std::clamp(x, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Mean of the phase function over a disk around the sun, given the cosine of its angular radius. A single lobe is
// evaluated at the center.
float glow_of(const Phase& phase, double cosine) {
    if (!phase.shape) return phase_value(phase, 1);
    return static_cast<float>((1 - cosine_cdf(*phase.shape, cosine)) / (2 * std::numbers::pi * (1 - cosine)));
}

// Radiance of homogeneous fog along the line of sight straight at a sun: Σ albedo p (1 - e^-depth). `angle`: angular
// radius of its disk in the image.
vec3 sun_brightness(const Snapshot& snapshot, const Light& light, const Ray& towards, double angle) {
    vec3 sum(0);
    for (const Medium& medium : homogeneous_media(snapshot.media)) {
        const float depth = static_cast<float>(optical_depth(medium, towards));
        sum += medium.optics.albedo * (glow_of(medium.optics.phase, std::cos(angle)) * -std::expm1(-depth));
    }
    return sum * light.intensity * light.volume_scale;
}

// Mean radiance of fog over a lamp's disk. At a distance h from the lamp, isotropic fog shows I σs / (4 h), on average
// over the disk twice as much as at its edge; a spot has the fraction of that in its solid angle. σs and the
// attenuation are means of the segment to the eye.
vec3 lamp_brightness(const Snapshot& snapshot, const Light& light, const Ray& towards, float radius) {
    vec3 sum(0);
    float whole = 0;
    for (const Medium& medium : homogeneous_media(snapshot.media)) {
        const float depth = static_cast<float>(optical_depth(medium, towards));
        sum += medium.optics.albedo * depth, whole += depth;
    }
    const float share = has_cone(light) ? 0.5f * (1 - std::cos(light.outer_cone)) : 1.0f;
    const float at_edge = std::exp(-whole) / (std::max(towards.t_max, light.core) * 4 * radius);
    return sum * light.intensity * (light.volume_scale * share * 2 * at_edge);
}

float pixels_per_meter(const View& view, float depth) {
    return static_cast<float>(view.size.y) / view_height(view.camera, depth);
}
}

float blur_fade(vec2 position, ivec2 size, float fade) {
    const vec2 off = glm::abs(position / vec2(size) * 2.0f - 1.0f);
    return 1 - smoothstep((std::max(off.x, off.y) - 1) / fade);
}

std::vector<BlurLight> blur_lights(const View& view, const Snapshot& snapshot, const RadialBlurSettings& settings) {
    std::vector<BlurLight> lights;
    float total = 0;
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const Light& light = snapshot.lights[i];
        const bool sun = is_distant(light);
        if (sun && view.camera.ortho_height > 0) continue; // its rays are parallel in the image
        const float far = far_away * snapshot.extent;
        const vec3 at = sun ? view.camera.position - far * light.direction : light.position;
        const std::optional<vec2> position = pixel_of(view.camera, view.size, at);
        const float depth = glm::dot(at - view.camera.position, view.camera.forward);
        if (!position || !(depth > view.camera.near)) continue;
        const float fade = blur_fade(*position, view.size, settings.fade);
        if (!(fade > 0)) continue;
        const vec3 towards = at - view.camera.position;
        const float distance = glm::length(towards);
        BlurLight blur{i, *position, sun ? infinity : depth, 0, fade, vec3(0), 0};
        blur.radius = settings.size * static_cast<float>(view.size.y);
        if (!sun) blur.radius = settings.lamp_size * pixels_per_meter(view, depth);
        const Ray ray{view.camera.position, towards / distance, sun ? far : distance};
        const double disc = std::atan(2.0 * std::min(settings.size, 0.5f) * std::tan(0.5 * view.camera.vertical_fov));
        blur.color = sun ? sun_brightness(snapshot, light, ray, std::clamp(disc, 1e-3, 3.1))
                         : lamp_brightness(snapshot, light, ray, settings.lamp_size);
        blur.share = luminance(blur.color);
        total += blur.share;
        lights.push_back(blur);
    }
    for (BlurLight& light : lights) light.share = total > 0 ? light.share / total : 0;
    return lights;
}
}
