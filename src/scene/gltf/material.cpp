// Materials and their textures: base color, emission and alpha; the rest of a material is ignored.
#include "base/error.h"
#include "base/text.h"
#include "scene/gltf/document.h"
#include "scene/images/image_file.h"

namespace tyndall {
namespace {
constexpr int largest_texture_side = 4096;
constexpr size_t max_texels = size_t{64} << 20; // 1 GiB

// A material's reference to a texture.
struct TextureUse {
    int texture = -1, uv_set = 0;
    mat3 transform{1};
};

double number_in(const tinygltf::Value& object, const char* name, double otherwise) {
    return object.Has(name) ? object.Get(name).GetNumberAsDouble() : otherwise;
}

vec2 pair_in(const tinygltf::Value& object, const char* name, vec2 otherwise) {
    if (!object.Has(name)) return otherwise;
    const tinygltf::Value& pair = object.Get(name);
    return {static_cast<float>(pair.Get(0).GetNumberAsDouble()), static_cast<float>(pair.Get(1).GetNumberAsDouble())};
}

// Offset, rotation and scale of KHR_texture_transform, as in its examples: a positive angle turns the image clockwise.
void add_transform(const tinygltf::Value& extension, TextureUse& use) {
    const vec2 offset = pair_in(extension, "offset", vec2(0)), scale = pair_in(extension, "scale", vec2(1));
    const float angle = static_cast<float>(number_in(extension, "rotation", 0));
    const float c = std::cos(angle), s = std::sin(angle);
    const mat3 rotation(c, -s, 0, s, c, 0, 0, 0, 1), placed(scale.x, 0, 0, 0, scale.y, 0, 0, 0, 1);
    use.transform = rotation * placed;
    use.transform[2] = vec3(offset, 1);
    use.uv_set = static_cast<int>(number_in(extension, "texCoord", use.uv_set));
}

TextureUse texture_use(int index, int uv_set, const tinygltf::ExtensionMap& extensions) {
    TextureUse use{index, uv_set};
    const auto transform = extensions.find("KHR_texture_transform");
    if (transform != extensions.end() && transform->second.IsObject()) add_transform(transform->second, use);
    return use;
}

TextureUse texture_use(const tinygltf::TextureInfo& info) {
    return texture_use(info.index, info.texCoord, info.extensions);
}

// The encoded bytes of an image. The caller tolerates a missing file, but not a forbidden path.
std::string image_bytes(GltfDocument& document, int index, const std::string& pointer) {
    const GltfImage& image = document.images[index];
    if (image.buffer_view < 0) return gltf_uri_bytes(document, image.uri, pointer + "/uri", uint64_t{1} << 30);
    const tinygltf::BufferView& view = document.model.bufferViews[image.buffer_view];
    if (const std::string& why = document.lacking[view.buffer]; !why.empty())
        fail(ExitCode::unreadable, document.location(pointer), why);
    return document.buffers[view.buffer].substr(view.byteOffset, view.byteLength);
}

std::string format_name(std::string_view bytes) {
    if (bytes.starts_with("RIFF") && bytes.substr(0, 16).find("WEBP") != bytes.npos) return "WebP";
    if (bytes.starts_with("\xABKTX 20")) return "KTX2";
    return "neither PNG nor JPEG";
}

Image<vec4> decoded_image(GltfDocument& document, int index) {
    const std::string pointer = gltf_pointer("images", index);
    std::string bytes;
    try {
        bytes = image_bytes(document, index, pointer);
    } catch (const Error& error) {
        if (error.code == ExitCode::refused) throw;
        const std::string text = error.what(), location = pointer + "/uri: ";
        const size_t at = text.find(location); // strips the place, which the warning repeats
        document.warn(pointer, "the material's color is used instead: " +
                                   (at == text.npos ? text : text.substr(at + location.size())));
        return {};
    }
    const ImageFormat format = image_format(bytes);
    if (format != ImageFormat::png && format != ImageFormat::jpeg) {
        document.warn(pointer, "the image is " + format_name(bytes) + "; the material's color is used instead");
        return {};
    }
    try {
        return decode_texture(bytes, "");
    } catch (const Error& error) {
        document.warn(pointer, std::string(error.what()) + "; the material's color is used instead");
        return {};
    }
}

// Halves an image until it fits the limits for textures.
Image<vec4> fitted(GltfDocument& document, Image<vec4> image, int index) {
    const ivec2 before = image.size;
    while (std::max(image.size.x, image.size.y) > largest_texture_side ||
           (image.pixels.size() > 1 && document.texels + image.pixels.size() > max_texels))
        image = halved(image);
    document.texels += image.pixels.size();
    if (image.size != before)
        document.warn(gltf_pointer("images", index),
                      "the image is reduced from " + std::to_string(before.x) + "x" + std::to_string(before.y) +
                          " to " + std::to_string(image.size.x) + "x" + std::to_string(image.size.y));
    return image;
}

void set_sampler(const tinygltf::Model& model, int index, Texture& texture) {
    if (index < 0) return;
    const tinygltf::Sampler& sampler = model.samplers[index];
    texture.repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.mirror_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.mirror_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

std::string key_of(const TextureUse& use, const tinygltf::Texture& texture) {
    const mat3& m = use.transform;
    return formatted("%d %d %a %a %a %a %a %a", texture.source, texture.sampler, m[0].x, m[0].y, m[1].x, m[1].y, m[2].x,
                     m[2].y);
}

// Index of the scene's texture; -1 when it cannot be used.
int scene_texture(GltfDocument& document, const TextureUse& use) {
    if (use.texture < 0) return -1;
    const tinygltf::Texture& source = document.model.textures[use.texture];
    if (source.source < 0) {
        document.warn(gltf_pointer("textures", use.texture),
                      "has no PNG or JPEG; the material's color is used instead");
        return -1;
    }
    const auto [known, added] = document.textures.try_emplace(key_of(use, source), -1);
    if (!added) return known->second;

    Texture texture;
    texture.texels = decoded_image(document, source.source);
    if (texture.texels.empty()) return -1;
    texture.texels = fitted(document, std::move(texture.texels), source.source);
    texture.name = source.name;
    texture.uv_transform = use.transform;
    set_sampler(document.model, source.sampler, texture);
    known->second = static_cast<int>(document.scene->textures.size());
    document.scene->textures.push_back(std::move(texture));
    return known->second;
}

// Base color and its texture: of the metallic-roughness model, or the diffuse part of the older specular-glossiness.
TextureUse base_color(const tinygltf::Material& source, Material& material) {
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
    TextureUse use{info.Get("index").GetNumberAsInt(), static_cast<int>(number_in(info, "texCoord", 0))};
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
}

int gltf_material(GltfDocument& document, int index, int& uv_set) {
    const tinygltf::Material& source = document.model.materials[index];
    Material material;
    material.name = source.name.empty() ? "material " + std::to_string(index) : source.name;
    const TextureUse base = base_color(source, material), emissive = texture_use(source.emissiveTexture);
    uv_set = base.texture >= 0 ? base.uv_set : emissive.uv_set;
    const auto [known, added] =
        document.materials.try_emplace(index, static_cast<int>(document.scene->materials.size()));
    if (!added) return known->second;

    if (max_component(material.base_color) > 1.001f) document.count("base colors above 1 are clamped to 1");
    material.base_color = glm::min(material.base_color, vec3(1)), material.alpha = std::min(material.alpha, 1.0f);
    material.base_texture = scene_texture(document, base);
    material.emission = emission_of(source);
    if (emissive.texture >= 0 && max_component(material.emission) > 0) {
        material.emission_texture = scene_texture(document, emissive);
        // Without its texture, which is dark nearly everywhere, the whole surface would emit light.
        if (material.emission_texture < 0) material.emission = vec3(0);
        if (base.texture >= 0 && base.uv_set != emissive.uv_set)
            document.warn(gltf_pointer("materials", index),
                          "the emission uses another set of texture coordinates; the base color's is used for both");
    }
    if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::mask;
    if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::blend;
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    document.scene->materials.push_back(material);
    return known->second;
}
}
