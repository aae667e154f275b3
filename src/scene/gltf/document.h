// A glTF on its way into a Scene: parsed, checked, with its buffers at hand. Private to the gltf_*.cpp files.
#pragma once
#include "base/json/json.h"
#include "scene/scene.h"

#include <tiny_gltf.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// What a .gltf or .glb consists of.
struct GltfContainer {
    std::string bytes; // of the whole file; the two views point into it
    std::string_view json, binary;
    bool has_binary = false;
    std::vector<std::string> warnings;
};

struct GltfImage {
    std::string uri;
    int buffer_view = -1;
};

struct GltfDocument {
    std::filesystem::path path, directory;
    std::string file;                 // as messages show it
    tinygltf::Model model;            // without buffers, images and extras
    std::vector<std::string> buffers; // empty where nothing refers to data
    std::vector<std::string> lacking; // per buffer: why it has no data; empty = it has
    std::vector<GltfImage> images;
    Scene* scene = nullptr;
    LoadOptions options;

    // What became of its parts in the scene; -1 = not used.
    std::vector<int> nodes;
    std::map<int, std::vector<int>> meshes;  // mesh index to one scene mesh per drawn primitive
    std::vector<std::vector<int>> instances; // of each node
    std::map<int, int> materials, skins;
    std::map<int, std::shared_ptr<const IesProfile>> profiles;
    std::map<std::string, int> textures; // by what makes one: image, sampler, transform
    std::map<std::string, int> counts;   // warnings said once with a number
    // So far:
    size_t texels = 0, triangles = 0;
    size_t morphed = 0; // vertices of morph targets
    size_t posed = 0;   // joints and morph targets of instances

    std::string place(std::string_view pointer) const;
    void warn(std::string_view pointer, std::string_view what);
    void count(const std::string& what, int times = 1) { counts[what] += times; }
};

// "/accessors/3", "/accessors/3/count"
std::string gltf_pointer(std::string_view collection, size_t index, std::string_view member = {});

// gltf_container.cpp: header and chunks of a .glb checked. Throws Error (refused, unreadable).
GltfContainer read_gltf_container(const std::filesystem::path& path);

// gltf_extensions.cpp: the version, and whether every required extension can be read.
void check_gltf_extensions(GltfDocument& document, const Json& json);

// gltf_files.cpp: bytes behind URIs. Nothing outside the document's directory is opened; only regular files are.
std::string gltf_uri_bytes(GltfDocument& document, const std::string& uri, const std::string& pointer, uint64_t most);
void load_gltf_buffers(GltfDocument& document, const Json& json, const GltfContainer& container);
void list_gltf_images(GltfDocument& document, const Json& json);

// gltf_parse.cpp: the JSON through tinygltf, which is given nothing it could open, decode or nest too deeply.
void parse_gltf(GltfDocument& document, const Json& json);

uint64_t gltf_element_bytes(const tinygltf::Accessor& accessor);

// gltf_ranges.cpp: accessors within buffer views within buffers, the node hierarchy a forest, animations consistent.
void check_gltf_ranges(const GltfDocument& document);

// gltf_accessor.cpp: elements as numbers, sparse ones filled in, normalised integers scaled.
enum class Scaling { as_declared, normalized }; // normalized: integers always become 0..1 or -1..1
std::vector<float> gltf_floats(GltfDocument& document, int accessor, int components, const std::string& pointer,
                               Scaling scaling = Scaling::as_declared);
std::vector<uint32_t> gltf_integers(GltfDocument& document, int accessor, const std::string& pointer);

// gltf_material.cpp, gltf_mesh.cpp, gltf_nodes.cpp, gltf_animation.cpp: parts into the scene.
int gltf_material(GltfDocument& document, int material, int& uv_set);
const std::vector<int>& gltf_mesh(GltfDocument& document, int mesh);
void add_gltf_nodes(GltfDocument& document);
void add_gltf_cameras_and_lights(GltfDocument& document);
// gltf_ies_lights.cpp: the light of EXT_lights_ies at a node, if it has one.
std::optional<LightSource> gltf_ies_light(GltfDocument& document, size_t node);
void add_gltf_animations(GltfDocument& document);
}
