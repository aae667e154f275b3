// Triangles and what they are made of.
#pragma once
#include "base/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall {
enum class AlphaMode { opaque, mask, blend };

struct Texture {
    std::string name;
    Image<vec4> texels; // linear colour, straight alpha; empty when the file could not be used
    bool repeat_u = true, repeat_v = true, mirror_u = false, mirror_v = false, nearest = false;
    mat3 uv_transform{1}; // applied to uv first (KHR_texture_transform)
};

// Bilinear texel (nearest when asked); v runs down as in glTF.
vec4 sample_texture(const Texture& texture, vec2 uv);

struct Material {
    std::string name;
    vec3 base_color{1};
    float alpha = 1;
    int base_texture = -1; // index into Scene::textures
    vec3 emission{0};      // radiance (nits)
    int emission_texture = -1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false; // only shading normals care; every face casts shadows
};

// What a mesh's vertices get besides, times a weight; empty = nothing.
struct MorphTarget {
    std::vector<vec3> positions, normals;
};

// One material's triangles. Normals and uvs are empty or one per position.
struct Mesh {
    std::string name;
    std::vector<vec3> positions, normals;
    std::vector<vec2> uvs;
    std::vector<vec3> colors; // vertex colours times base_color; empty = white
    std::vector<glm::uvec3> triangles;
    int material = -1; // -1 = white Lambert
    std::vector<MorphTarget> targets;
    // Of each position, so many joints of a skin and how much it follows each: weights that add up to 1.
    size_t influences = 0, joint_count = 0; // joint_count: of the skin, at least
    std::vector<uint16_t> joints;
    std::vector<float> joint_weights;
};
}
