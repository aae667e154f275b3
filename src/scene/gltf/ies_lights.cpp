// EXT_lights_ies: lights with IES profiles, aimed along -Z of their nodes.
#include "base/error.h"
#include "scene/file/scene_file.h"
#include "scene/gltf/document.h"

namespace tyndall {
namespace {
constexpr const char* extension_name = "EXT_lights_ies";

// The JSON pointer of a light profile.
std::string pointer_to(int index) {
    return "/extensions/" + std::string(extension_name) + "/lights/" + std::to_string(index);
}

std::string profile_bytes(GltfDocument& document, const tinygltf::Value& light, const std::string& pointer) {
    if (light.Has("uri") == light.Has("bufferView"))
        refuse(document.location(pointer), "needs exactly one of uri and bufferView");
    if (light.Has("uri"))
        return gltf_uri_bytes(document, light.Get("uri").Get<std::string>(), pointer + "/uri", largest_ies_file);
    const tinygltf::BufferView& view = document.model.bufferViews[light.Get("bufferView").GetNumberAsInt()];
    if (const std::string& why = document.lacking[view.buffer]; !why.empty())
        fail(ExitCode::unreadable, document.location(pointer), why);
    return document.buffers[view.buffer].substr(view.byteOffset, view.byteLength);
}

std::shared_ptr<const IesProfile> profile_at(GltfDocument& document, int index) {
    std::shared_ptr<const IesProfile>& profile = document.profiles[index];
    if (profile) return profile;
    const std::string pointer = pointer_to(index);
    const tinygltf::Value& light = document.model.extensions.at(extension_name).Get("lights").Get(index);
    return profile = read_profile(profile_bytes(document, light, pointer), document.location(pointer), *document.scene);
}
}

std::optional<LightSource> gltf_ies_light(GltfDocument& document, size_t node) {
    const auto& extensions = document.model.nodes[node].extensions;
    const auto extension = extensions.find(extension_name);
    if (extension == extensions.end() || !extension->second.Has("light")) return {};
    const tinygltf::Value& instance = extension->second;
    LightSource light;
    light.profile = profile_at(document, instance.Get("light").GetNumberAsInt());
    light.unit = LightUnit::profile;
    if (instance.Has("multiplier"))
        light.intensity = static_cast<float>(instance.Get("multiplier").GetNumberAsDouble());
    if (!instance.Has("color")) return light;
    vec3 color;
    for (int c = 0; c < 3; ++c) color[c] = static_cast<float>(instance.Get("color").Get(c).GetNumberAsDouble());
    light.color = glm::clamp(color, 0.0f, 1.0f);
    return light;
}
}
