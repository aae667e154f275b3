// A parsed and checked glTF with its buffers, while it is converted into a Scene. Private to scene/gltf.
#pragma once
#include "base/json/json.h"
#include "scene/scene.h"

#include <tiny_gltf.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// The contents of a .gltf or .glb.
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

// A material's reference to a texture.
struct GltfTextureUse {
    int texture = -1, uv_set = 0;
    mat3 transform{1};
};

// A decoded image: shared by all textures that show it, and reduced in place.
struct GltfTexels {
    std::shared_ptr<Texels> texels; // null = cannot be used
    int side = 0;                   // the longer one in the file
};

inline constexpr int largest_texture_side = 8192;

struct GltfDocument {
    std::filesystem::path path, directory;
    std::string file;                 // path for messages
    tinygltf::Model model;            // without buffers, images and extras
    std::vector<std::string> buffers; // bytes of each; empty if it has no data
    std::vector<std::string> lacking; // per buffer: why it has no data; empty = it has
    std::vector<GltfImage> images;
    Scene* scene = nullptr;
    LoadOptions options;

    // Indices of its parts in the scene; -1 = not used.
    std::vector<int> nodes;
    std::map<int, std::vector<int>> meshes;  // mesh index to one scene mesh per drawn primitive
    std::vector<std::vector<int>> instances; // of each node
    std::map<int, int> materials, skins;
    std::map<int, std::shared_ptr<const IesProfile>> profiles;
    std::map<std::string, int> textures;     // keyed by image, sampler and transform
    std::map<int, GltfTexels> decoded;       // by image
    int texture_side = largest_texture_side; // no image is larger
    std::map<std::string, int> counts;       // warnings given once, with a count
    // Totals so far:
    size_t triangles = 0;
    size_t morphed = 0; // vertices of morph targets
    size_t posed = 0;   // joints and morph targets of instances

    std::string location(std::string_view pointer) const;
    void warn(std::string_view pointer, std::string_view what);
    void count(const std::string& what, int times = 1) { counts[what] += times; }
};

// "/accessors/3", "/accessors/3/count"
std::string gltf_pointer(std::string_view collection, size_t index, std::string_view member = {});

// container.cpp: reads the file and checks the header and chunks of a .glb. Throws Error (refused, unreadable).
GltfContainer read_gltf_container(const std::filesystem::path& path);

// extensions.cpp: checks the version and that every required extension can be read.
void check_gltf_extensions(GltfDocument& document, const Json& json);

// files.cpp: the bytes behind URIs. Opens only regular files inside the document's directory.
std::string gltf_uri_bytes(GltfDocument& document, const std::string& uri, const std::string& pointer, uint64_t most);
void load_gltf_buffers(GltfDocument& document, const Json& json, const GltfContainer& container);
void list_gltf_images(GltfDocument& document, const Json& json);

// parse.cpp: parses the JSON with tinygltf, without anything that it could open, decode or nest too deeply.
void parse_gltf(GltfDocument& document, const Json& json);

uint64_t gltf_element_bytes(const tinygltf::Accessor& accessor);

// ranges.cpp: checks that accessors lie within buffer views and these within buffers, that nodes form a forest, and
// that animations are consistent.
void check_gltf_ranges(const GltfDocument& document);

// accessor.cpp: elements as numbers, with sparse elements applied and normalized integers scaled.
enum class Scaling { as_declared, normalized }; // normalized: integers always become 0..1 or -1..1
std::vector<float> gltf_floats(GltfDocument& document, int accessor, int components, const std::string& pointer,
                               Scaling scaling = Scaling::as_declared);
std::vector<uint32_t> gltf_integers(GltfDocument& document, int accessor, const std::string& pointer);

// material.cpp, mesh.cpp, nodes.cpp, animation.cpp: add parts to the scene.
int gltf_material(GltfDocument& document, int material, int& uv_set);
// textures.cpp: index of the scene's texture; -1 when it cannot be used.
int gltf_texture(GltfDocument& document, const GltfTextureUse& use);
void note_reduced_textures(GltfDocument& document);
const std::vector<int>& gltf_mesh(GltfDocument& document, int mesh);
void add_gltf_nodes(GltfDocument& document);
void add_gltf_cameras_and_lights(GltfDocument& document);
// ies_lights.cpp: the light of EXT_lights_ies at a node, if it has one.
std::optional<LightSource> gltf_ies_light(GltfDocument& document, size_t node);
void add_gltf_animations(GltfDocument& document);
}
