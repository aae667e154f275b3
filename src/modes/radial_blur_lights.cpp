// Where the radial blur sees the lights, and how bright it takes them for.
#include "modes/radial_blur.h"

#include "modes/style.h"
#include "scene/light.h"

namespace tyndall {
namespace {
constexpr float far_away = 1e6f; // metres: a sun's place in the picture is where this point of it would be

float smooth(float x) {
    const float t = std::clamp(x, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Even fog's answer to the light along the line of sight straight at it: irradiance at the eye times
// Σ albedo p (1 - e^-depth), p for light that travels to the eye, or along a spot's axis. Only a scale: the blur itself
// knows no units.
vec3 brightness(const Snapshot& snapshot, const Light& light, const Ray& towards, float distance) {
    const bool spot = light.kind == LightKind::spot;
    const float cosine = spot ? glm::dot(light.direction, -towards.direction) : 1;
    const float squared = std::max(distance * distance, 1e-6f);
    const vec3 irradiance = light.kind == LightKind::sun ? light.intensity : light.intensity / squared;
    vec3 sum(0);
    for (const Medium& medium : even_media(snapshot.media)) {
        Ray ray = towards;
        ray.t_max = std::min(distance, far_away);
        const float depth = static_cast<float>(optical_depth(medium, ray));
        sum += medium.optics.albedo * (phase_value(medium.optics.phase, cosine) * -std::expm1(-depth));
    }
    return sum * irradiance * light.volume_scale;
}

float pixels_per_metre(const View& view, float depth) {
    const bool flat = view.camera.ortho_height > 0;
    const float height = flat ? view.camera.ortho_height : 2 * depth * std::tan(0.5f * view.camera.vertical_fov);
    return static_cast<float>(view.size.y) / height;
}
}

float blur_fade(vec2 position, ivec2 size, float fade) {
    const vec2 off = glm::abs(position / vec2(size) * 2.0f - 1.0f);
    return 1 - smooth((std::max(off.x, off.y) - 1) / fade);
}

std::vector<BlurLight> blur_lights(const View& view, const Snapshot& snapshot, const RadialBlurSettings& settings) {
    std::vector<BlurLight> lights;
    float total = 0;
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const Light& light = snapshot.lights[i];
        const bool sun = light.kind == LightKind::sun;
        if (sun && view.camera.ortho_height > 0) continue; // its rays are parallel in the picture
        const vec3 at = sun ? view.camera.position - far_away * light.direction : light.position;
        const std::optional<vec2> position = pixel_of(view.camera, view.size, at);
        const float depth = glm::dot(at - view.camera.position, view.camera.forward);
        if (!position || !(depth > view.camera.near)) continue;
        const float fade = blur_fade(*position, view.size, settings.fade);
        if (!(fade > 0)) continue;
        const vec3 towards = at - view.camera.position;
        const float distance = glm::length(towards);
        BlurLight blur{i, *position, sun ? infinity : depth, 0, fade, vec3(0), 0};
        blur.radius = settings.size * static_cast<float>(view.size.y);
        if (!sun) blur.radius = settings.lamp_size * pixels_per_metre(view, depth);
        blur.color = brightness(snapshot, light, {view.camera.position, towards / distance}, sun ? infinity : distance);
        blur.share = luminance(blur.color);
        total += blur.share;
        lights.push_back(blur);
    }
    for (BlurLight& light : lights) light.share = total > 0 ? light.share / total : 0;
    return lights;
}
}
