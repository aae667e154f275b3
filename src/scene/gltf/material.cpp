// Materials and their textures: base color, emission and alpha; the rest of a material is ignored.
#include "scene/gltf/document.h"

namespace tyndall {
namespace {
double number_in(const tinygltf::Value& object, const char* name, double otherwise) {
    return object.Has(name) ? object.Get(name).GetNumberAsDouble() : otherwise;
}

vec2 pair_in(const tinygltf::Value& object, const char* name, vec2 otherwise) {
    if (!object.Has(name)) return otherwise;
    const tinygltf::Value& pair = object.Get(name);
    return {static_cast<float>(pair.Get(0).GetNumberAsDouble()), static_cast<float>(pair.Get(1).GetNumberAsDouble())};
}

// Offset, rotation and scale of KHR_texture_transform, as in its examples: a positive angle turns the image clockwise.
void add_transform(const tinygltf::Value& extension, GltfTextureUse& use) {
    const vec2 offset = pair_in(extension, "offset", vec2(0)), scale = pair_in(extension, "scale", vec2(1));
    const float angle = static_cast<float>(number_in(extension, "rotation", 0));
    const float c = std::cos(angle), s = std::sin(angle);
    const mat3 rotation(c, -s, 0, s, c, 0, 0, 0, 1), placed(scale.x, 0, 0, 0, scale.y, 0, 0, 0, 1);
    use.transform = rotation * placed;
    use.transform[2] = vec3(offset, 1);
    use.uv_set = static_cast<int>(number_in(extension, "texCoord", use.uv_set));
}

GltfTextureUse texture_use(int index, int uv_set, const tinygltf::ExtensionMap& extensions) {
    GltfTextureUse use{index, uv_set};
    const auto transform = extensions.find("KHR_texture_transform");
    if (transform != extensions.end() && transform->second.IsObject()) add_transform(transform->second, use);
    return use;
}

GltfTextureUse texture_use(const tinygltf::TextureInfo& info) {
    return texture_use(info.index, info.texCoord, info.extensions);
}

// Base color and its texture: of the metallic-roughness model, or the diffuse part of the older specular-glossiness.
GltfTextureUse base_color(const tinygltf::Material& source, Material& material) {
    const auto older = source.extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (older == source.extensions.end() || !older->second.IsObject()) {
        const std::vector<double>& factor = source.pbrMetallicRoughness.baseColorFactor;
        material.base_color = vec3(factor[0], factor[1], factor[2]);
        material.alpha = static_cast<float>(factor[3]);
        return texture_use(source.pbrMetallicRoughness.baseColorTexture);
    }
    if (older->second.Has("diffuseFactor")) {
        const tinygltf::Value& factor = older->second.Get("diffuseFactor");
        const auto part = [&](int i) { return static_cast<float>(factor.Get(i).GetNumberAsDouble()); };
        material.base_color = {part(0), part(1), part(2)}, material.alpha = part(3);
    }
    if (!older->second.Has("diffuseTexture")) return {};
    const tinygltf::Value& info = older->second.Get("diffuseTexture");
    GltfTextureUse use{info.Get("index").GetNumberAsInt(), static_cast<int>(number_in(info, "texCoord", 0))};
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
        add_transform(info.Get("extensions").Get("KHR_texture_transform"), use);
    return use;
}

vec3 emission_of(const tinygltf::Material& source) {
    const std::vector<double>& factor = source.emissiveFactor;
    double strength = 1;
    const auto extension = source.extensions.find("KHR_materials_emissive_strength");
    if (extension != source.extensions.end()) strength = number_in(extension->second, "emissiveStrength", 1);
    return vec3(glm::min(dvec3(factor[0], factor[1], factor[2]) * strength, dvec3(1e30)));
}

// An opaque material of glass is blended instead, so that light gets through. One that emits stays a mesh light.
void make_glass(GltfDocument& document, const tinygltf::Material& source, Material& material) {
    constexpr double min_alpha = 0.05; // keeps clear glass visible
    const auto found = source.extensions.find("KHR_materials_transmission");
    if (found == source.extensions.end() || material.alpha_mode != AlphaMode::opaque) return;
    const double factor = number_in(found->second, "transmissionFactor", 0);
    if (factor <= 0) return;
    if (found->second.Has("transmissionTexture") || material.emission != vec3(0))
        return document.count("transmissive materials with a texture of it, or with emission, stay opaque");
    material.alpha_mode = AlphaMode::blend;
    material.alpha = static_cast<float>(std::max(1 - factor, min_alpha));
    document.count("transmissive materials are shown as partly transparent, without refraction");
}
}

int gltf_material(GltfDocument& document, int index, int& uv_set) {
    const tinygltf::Material& source = document.model.materials[index];
    Material material;
    material.name = source.name.empty() ? "material " + std::to_string(index) : source.name;
    const GltfTextureUse base = base_color(source, material), emissive = texture_use(source.emissiveTexture);
    uv_set = base.texture >= 0 ? base.uv_set : emissive.uv_set;
    const auto [known, added] =
        document.materials.try_emplace(index, static_cast<int>(document.scene->materials.size()));
    if (!added) return known->second;

    if (max_component(material.base_color) > 1.001f) document.count("base colors above 1 are clamped to 1");
    material.base_color = glm::min(material.base_color, vec3(1)), material.alpha = std::min(material.alpha, 1.0f);
    material.base_texture = gltf_texture(document, base);
    material.emission = emission_of(source);
    if (emissive.texture >= 0 && max_component(material.emission) > 0) {
        material.emission_texture = gltf_texture(document, emissive);
        // Without its texture, which is dark nearly everywhere, the whole surface would emit light.
        if (material.emission_texture < 0) material.emission = vec3(0);
        if (base.texture >= 0 && base.uv_set != emissive.uv_set)
            document.warn(gltf_pointer("materials", index),
                          "the emission uses another set of texture coordinates; the base color's is used for both");
    }
    if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::mask;
    if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::blend;
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    make_glass(document, source, material);
    document.scene->materials.push_back(material);
    return known->second;
}
}
