// Versions and extensions: what can be read, what is left out with a warning, what makes a file unreadable.
#include "base/error.h"
#include "scene/gltf_document.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr std::array<std::string_view, 6> read = {
    "KHR_lights_punctual",   "KHR_texture_transform",   "KHR_materials_emissive_strength",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "KHR_materials_pbrSpecularGlossiness"};
constexpr std::array<std::string_view, 3> compressed = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                                        "KHR_meshopt_compression"};

// Extensions that change how things look, not what is there.
bool only_looks(std::string_view name) {
    return name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
           name.starts_with("MSFT_texture_");
}

template<class Names> bool holds(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_version_2(std::string_view version) { return version.starts_with("2.") && version.size() > 2; }
}

void check_gltf_extensions(GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    if (!is_version_2(model.asset.version))
        refuse(document.place("/asset/version"), "is \"" + model.asset.version + "\"; only glTF 2.0 can be read");
    if (!model.asset.minVersion.empty() && model.asset.minVersion != "2.0")
        refuse(document.place("/asset/minVersion"), "is \"" + model.asset.minVersion + "\"; only glTF 2.0 can be read");

    for (size_t i = 0; i < model.extensionsRequired.size(); ++i) {
        const std::string& name = model.extensionsRequired[i];
        const std::string place = document.place(gltf_pointer("extensionsRequired", i));
        if (holds(compressed, name))
            refuse(place, "the meshes are compressed with " + name + ", which cannot be read; export without it");
        if (!holds(read, name) && !only_looks(name))
            refuse(place, "needs the extension " + name + ", which is not known");
    }
    for (const std::string& name : model.extensionsUsed)
        if (!holds(read, name) && !holds(compressed, name)) document.warn("", "the extension " + name + " is left out");
}
}
