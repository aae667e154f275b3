#include "scene/gltf/gltf.h"

#include "base/error.h"
#include "base/json/json_pointer.h"
#include "base/memory.h"
#include "scene/file/scene_file.h"
#include "scene/gltf/document.h"
#include "scene/gltf/shape.h"

#include <algorithm>

namespace tyndall {
std::string gltf_pointer(std::string_view collection, size_t index, std::string_view member) {
    std::string pointer = "/" + std::string(collection) + "/" + std::to_string(index);
    return member.empty() ? pointer : pointer + "/" + std::string(member);
}

std::string GltfDocument::location(std::string_view pointer) const { return json_location(file, pointer); }

void GltfDocument::warn(std::string_view pointer, std::string_view what) {
    tyndall::warn(*scene, location(pointer) + ": " + std::string(what));
}

namespace {
// Models of many parts have many values; memory is the limit.
size_t max_values() {
    constexpr uint64_t bytes_each = 400, least = uint64_t{1} << 20, most = uint64_t{64} << 20;
    return std::clamp(available_memory() / bytes_each, least, most);
}
}

void load_gltf(const std::filesystem::path& file, const LoadOptions& options, Scene& scene) {
    GltfDocument document;
    document.path = file, document.file = file.string();
    document.directory = file.has_parent_path() ? file.parent_path() : ".";
    document.scene = &scene, document.options = options;
    {
        // This scope frees the text and its tree before the meshes are made.
        const GltfContainer container = read_gltf_container(file);
        add_input(scene, file, container.bytes);
        for (const std::string& warning : container.warnings) document.warn("", warning);
        const Json json = parse_json(container.json, document.file, max_values());
        check_gltf_schema(json, document.file);
        check_gltf_extensions(document, json);
        check_gltf_needs(json, document.file);
        parse_gltf(document, json);
        load_gltf_buffers(document, json, container);
        list_gltf_images(document, json);
    }
    check_gltf_ranges(document);
    add_gltf_nodes(document);
    add_gltf_cameras_and_lights(document);
    add_gltf_animations(document);
    note_reduced_textures(document);
    for (const auto& [what, times] : document.counts) document.warn("", what + " (" + std::to_string(times) + ")");
}
}
