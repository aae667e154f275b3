// glTF versions and extensions: which are read, which are ignored with a warning, and which make a file unreadable.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr std::array<std::string_view, 8> read = {
    "KHR_lights_punctual",   "KHR_texture_transform",     "KHR_materials_emissive_strength",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",   "KHR_materials_pbrSpecularGlossiness",
    "EXT_lights_ies",        "KHR_materials_transmission"};
constexpr std::array<std::string_view, 3> compressed = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                                        "KHR_meshopt_compression"};

// Extensions that affect only appearance, not geometry.
bool only_looks(std::string_view name) {
    return name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
           name.starts_with("MSFT_texture_");
}

template<class Names> bool holds(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_version_2(std::string_view version) { return version.starts_with("2.") && version.size() > 2; }

std::vector<std::string> names_in(const GltfDocument& document, const Json& json, std::string_view list) {
    std::vector<std::string> names;
    const Json* array = json.find(list);
    if (!array) return names;
    if (array->kind != Json::Kind::array)
        refuse(document.location("/" + std::string(list)), "expected an array of names");
    for (const Json& item : array->items) {
        if (item.kind != Json::Kind::string)
            refuse(document.location(gltf_pointer(list, names.size())), "expected the name of an extension");
        names.push_back(item.string);
    }
    return names;
}
}

void check_gltf_extensions(GltfDocument& document, const Json& json) {
    const Json& asset = *json.find("asset");
    const std::string version = asset.string_or("version", ""), least = asset.string_or("minVersion", "2.0");
    if (!is_version_2(version))
        refuse(document.location("/asset/version"), "is " + quote_json(version) + "; only glTF 2.0 can be read");
    if (least != "2.0")
        refuse(document.location("/asset/minVersion"), "is " + quote_json(least) + "; only glTF 2.0 can be read");

    const std::vector<std::string> required = names_in(document, json, "extensionsRequired");
    for (size_t i = 0; i < required.size(); ++i) {
        const std::string location = document.location(gltf_pointer("extensionsRequired", i)), &name = required[i];
        if (holds(compressed, name))
            refuse(location, "the meshes are compressed with " + name + ", which cannot be read; export without it");
        if (!holds(read, name) && !only_looks(name))
            refuse(location, "needs the extension " + name + ", which is not supported");
    }
    for (const std::string& name : names_in(document, json, "extensionsUsed"))
        if (!holds(read, name) && !holds(compressed, name)) document.warn("", "the extension " + name + " is ignored");
}
}
