// Triangle meshes, their materials and textures.
#pragma once
#include "scene/images/texels.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall {
enum class AlphaMode { opaque, mask, blend };

struct Texture {
    std::string name;
    std::shared_ptr<const Texels> texels; // shared by all textures of an image; null when it could not be used
    bool repeat_u = true, repeat_v = true, mirror_u = false, mirror_v = false, nearest = false;
    mat3 uv_transform{1}; // applied to uv first (KHR_texture_transform)
};

// Bilinear lookup (or nearest, if the texture asks for it); v runs down as in glTF.
vec4 sample_texture(const Texture& texture, vec2 uv);
float sample_alpha(const Texture& texture, vec2 uv);

struct Material {
    std::string name;
    vec3 base_color{1};
    float alpha = 1;
    int base_texture = -1; // index into Scene::textures
    vec3 emission{0};      // radiance (nits)
    int emission_texture = -1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
};

// Opacity at an alpha: 1 for opaque materials, 0 or 1 for masks.
inline float opacity_at(const Material& material, float alpha) {
    if (material.alpha_mode == AlphaMode::opaque) return 1;
    if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

// Whether it emits light, where textures and vertices do not prevent it.
inline bool can_emit(const Material& material) {
    return max_component(material.emission) > 0 && opacity_at(material, material.alpha) > 0;
}

// Offsets added to a mesh's vertices, times a weight; empty = none.
struct MorphTarget {
    std::vector<vec3> positions, normals;
};

// One material's triangles. Normals and uvs are empty or one per position.
struct Mesh {
    std::string name;
    std::vector<vec3> positions, normals;
    std::vector<vec2> uvs;
    std::vector<vec3> colors;  // vertex colors, times base_color; empty = white
    std::vector<float> alphas; // of vertices, times the material's; empty = 1
    std::vector<glm::uvec3> triangles;
    int material = -1; // -1 = white Lambert
    std::vector<MorphTarget> targets;
    // Skinning: each position follows `influences` joints, with weights that add up to 1.
    size_t influences = 0, joint_count = 0; // joint_count: joints that the skin must have
    std::vector<uint16_t> joints;
    std::vector<float> joint_weights;
};
}
