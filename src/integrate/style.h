// Artistic controls: those applied to a snapshot, and those that kernels apply.
#pragma once
#include "base/math.h"
#include "scene/camera.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;
struct Snapshot;

// Nonphysical artistic controls. Images rendered with any of them are marked as stylized.
struct StyleSettings {
    float light_depth = 1; // factor on the optical depth between light and fog: below 1, shafts reach farther
    float view_depth = 1;  // factor on the optical depth between fog and eye, only for the light of the fog
    float density = 1;     // factor on every medium's extinction
    float range = 1e9f;    // meters from the eye at which the fog's light has faded out
    vec3 tint{1};          // factor on the light of the fog
};

bool is_stylized(const StyleSettings& style);

// The snapshot with style.density applied to its media, and style.tint to lights, ambient light and their emission. The
// integrator must still tint surfaces' light and apply style_fade() and view_depth; LightDepth::scale is light_depth.
Snapshot stylized(const Snapshot& snapshot, const StyleSettings& style);

// True if the fog's light fades with distance; the default range is infinite.
inline bool fades(const StyleSettings& style) { return style.range < StyleSettings().range; }

// Share of the fog's light that remains at a distance from the eye according to style.range.
inline float style_fade(const StyleSettings& style, float distance) {
    if (!fades(style)) return 1;
    return std::clamp((style.range - distance) / (0.2f * style.range), 0.0f, 1.0f);
}

// The distance that style.range applies to: meters from the eye, or depth in front of an orthographic camera.
inline float eye_distance(const Camera& camera, vec3 point) {
    const vec3 offset = point - camera.position;
    return camera.ortho_height > 0 ? glm::dot(offset, camera.forward) : glm::length(offset);
}

// Replaces every grid by homogeneous fog of its mean density in its bounds, and drops media without extinction.
std::vector<Medium> homogeneous_media(std::span<const Medium> media);
}
