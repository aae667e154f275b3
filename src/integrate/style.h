// Artist's controls applied to a snapshot, and what kernels need besides.
#pragma once
#include "base/math.h"
#include "scene/camera.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;
struct Snapshot;

// Departures from physics that artists ask for. Pictures made with any of them are stylised.
struct StyleSettings {
    float light_depth = 1; // factor on the optical depth between light and fog: below 1 shafts reach further
    float view_depth = 1;  // factor on the optical depth between fog and eye, for the light of the fog only
    float density = 1;     // factor on every medium's extinction
    float range = 1e9f;    // metres from the eye at which the fog's light has faded out
    vec3 tint{1};          // factor on the light of the fog
};

bool is_stylised(const StyleSettings& style);

// The snapshot with style.density on its media and style.tint on its lights, ambient light and emission in fog. What a
// march through it still has to do: style_fade() and view_depth; LightDepth::scale carries light_depth.
Snapshot stylised(const Snapshot& snapshot, const StyleSettings& style);

// Whether the fog's light fades out with the distance: a range as by default has no end.
inline bool fades(const StyleSettings& style) { return style.range < StyleSettings().range; }

// Share of the fog's light that style.range leaves at a distance from the eye.
inline float style_fade(const StyleSettings& style, float distance) {
    if (!fades(style)) return 1;
    return std::clamp((style.range - distance) / (0.2f * style.range), 0.0f, 1.0f);
}

// What style.range counts: metres from the eye, or in front of an orthographic camera.
inline float eye_distance(const Camera& camera, vec3 point) {
    const vec3 offset = point - camera.position;
    return camera.ortho_height > 0 ? glm::dot(offset, camera.forward) : glm::length(offset);
}

// Every grid as homogeneous fog of its mean density in its bounds: media left are homogeneous or height fog only.
std::vector<Medium> homogeneous_media(std::span<const Medium> media);
}
