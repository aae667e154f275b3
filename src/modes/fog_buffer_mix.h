// Interpolation between pixels of a FogBuffer whose rays have similar length.
#pragma once
#include "modes/fog_buffer.h"
#include "scene/camera.h"

namespace tyndall {
inline constexpr float length_tolerance = 0.05f; // relative difference in length below which rays show the same fog
inline constexpr float min_weight = 0.2f;        // minimum total weight of similar neighbors

inline bool similar_length(float a, float b) { return std::abs(a - b) <= length_tolerance * std::max(a, b); }

inline Ray ray_through(const FogBuffer& buffer, ivec2 pixel) {
    return camera_ray(buffer.view.camera, buffer.fog.size, vec2(pixel) + 0.5f);
}

// The four pixels around a position, with their bilinear weights; clamped to the image.
struct Taps {
    ivec2 at[4];
    float weight[4];
};
inline Taps taps_at(ivec2 size, vec2 position) {
    const vec2 p = glm::clamp(position - 0.5f, vec2(0), vec2(size) - 1.0f);
    const ivec2 low = glm::min(ivec2(p), glm::max(size - 2, 0));
    const vec2 share = p - vec2(low);
    Taps taps;
    for (int k = 0; k < 4; ++k) {
        const ivec2 step(k & 1, k >> 1);
        taps.at[k] = glm::min(low + step, size - 1);
        taps.weight[k] = (step.x ? share.x : 1 - share.x) * (step.y ? share.y : 1 - share.y);
    }
    return taps;
}

inline void add(Scatter& sum, const Scatter& part, float weight) {
    sum.radiance += part.radiance * weight;
    sum.transmittance += part.transmittance * weight, sum.validity += part.validity * weight;
}

// The weighted mean of some neighbors, and their total weight.
struct Mixed {
    Scatter fog{vec3(0), 0, 0, 0, vec3(0)};
    float weight = 0;
};

// Mean of the taps whose rays have about this length; zeroes the other weights and renormalizes the rest.
inline Mixed mixed(const FogBuffer& buffer, Taps& taps, float length) {
    Mixed result;
    for (int k = 0; k < 4; ++k) {
        if (!similar_length(buffer.length.at(taps.at[k].x, taps.at[k].y), length)) taps.weight[k] = 0;
        add(result.fog, buffer.fog.at(taps.at[k].x, taps.at[k].y), taps.weight[k]);
        result.weight += taps.weight[k];
    }
    if (result.weight > 0) {
        Scatter mean{vec3(0), 0, 0, 0, vec3(0)};
        add(mean, result.fog, 1 / result.weight);
        result.fog = mean;
        for (float& weight : taps.weight) weight /= result.weight;
    }
    return result;
}

inline vec3 mixed_light(const Image<vec3>& part, const Taps& taps) {
    vec3 sum(0);
    for (int k = 0; k < 4; ++k) sum += part.at(taps.at[k].x, taps.at[k].y) * taps.weight[k];
    return sum;
}
}
