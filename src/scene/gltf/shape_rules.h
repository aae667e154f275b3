// One row per member of glTF 2.0 (and of the extensions that are read): its type, range and what it refers to.
#pragma once
#include <array>
#include <limits>
#include <span>
#include <string_view>

namespace tyndall::gltf_schema {
enum class ValueType {
    flag,
    text,
    integer,
    number,
    positive,
    numbers,
    one_of,
    words,
    index,
    indices,
    index_map,
    index_maps,
    object,
    objects
};

struct Rule {
    std::string_view name;
    ValueType type;
    bool required = false;
    double low = 0, high = 0;                     // integer, number, numbers
    size_t length = 0;                            // numbers: how many, 0 = any
    std::string_view collection = {};             // index, indices, index_map, index_maps
    std::span<const Rule> fields = {};            // object, objects
    std::span<const std::string_view> words = {}; // words
    std::span<const int> values = {};             // one_of
};

constexpr double largest_int = 2147483647, largest_offset = 9007199254740992, largest_float = 3.4e38;
constexpr bool required = true;

constexpr Rule flag(std::string_view name) { return {.name = name, .type = ValueType::flag}; }
constexpr Rule text(std::string_view name, bool needed = false) {
    return {.name = name, .type = ValueType::text, .required = needed};
}
constexpr Rule integer(std::string_view name, double low, double high, bool needed = false) {
    return {.name = name, .type = ValueType::integer, .required = needed, .low = low, .high = high};
}
constexpr Rule number(std::string_view name, double low, double high, bool needed = false) {
    return {.name = name, .type = ValueType::number, .required = needed, .low = low, .high = high};
}
constexpr Rule positive(std::string_view name, double high, bool needed = false) {
    return {.name = name, .type = ValueType::positive, .required = needed, .high = high};
}
constexpr Rule numbers(std::string_view name, size_t length, double low = -largest_float, double high = largest_float) {
    return {.name = name, .type = ValueType::numbers, .low = low, .high = high, .length = length};
}
constexpr Rule one_of(std::string_view name, std::span<const int> values, bool needed = false) {
    return {.name = name, .type = ValueType::one_of, .required = needed, .values = values};
}
constexpr Rule words(std::string_view name, std::span<const std::string_view> words, bool needed = false) {
    return {.name = name, .type = ValueType::words, .required = needed, .words = words};
}
constexpr Rule index(std::string_view name, std::string_view collection, bool needed = false) {
    return {.name = name, .type = ValueType::index, .required = needed, .collection = collection};
}
constexpr Rule indices(std::string_view name, std::string_view collection, bool needed = false) {
    return {.name = name, .type = ValueType::indices, .required = needed, .collection = collection};
}
constexpr Rule index_map(std::string_view name, std::string_view collection, bool needed = false) {
    return {.name = name, .type = ValueType::index_map, .required = needed, .collection = collection};
}
constexpr Rule index_maps(std::string_view name, std::string_view collection) {
    return {.name = name, .type = ValueType::index_maps, .collection = collection};
}
constexpr Rule object(std::string_view name, std::span<const Rule> fields, bool needed = false) {
    return {.name = name, .type = ValueType::object, .required = needed, .fields = fields};
}
constexpr Rule objects(std::string_view name, std::span<const Rule> fields, bool needed = false) {
    return {.name = name, .type = ValueType::objects, .required = needed, .fields = fields};
}

// Core: buffers and accessors.
constexpr int component_types[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr int index_types[] = {5121, 5123, 5125};
constexpr std::string_view element_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr Rule sparse_indices[] = {index("bufferView", "bufferViews", required), integer("byteOffset", 0, largest_int),
                                   one_of("componentType", index_types, required)};
constexpr Rule sparse_values[] = {index("bufferView", "bufferViews", required), integer("byteOffset", 0, largest_int)};
constexpr Rule sparse[] = {integer("count", 1, largest_int, required), object("indices", sparse_indices, required),
                           object("values", sparse_values, required)};
constexpr Rule accessor[] = {index("bufferView", "bufferViews"),
                             integer("byteOffset", 0, largest_offset),
                             one_of("componentType", component_types, required),
                             integer("count", 0, largest_offset, required),
                             words("type", element_types, required),
                             flag("normalized"),
                             object("sparse", sparse)};
constexpr Rule buffer_view[] = {index("buffer", "buffers", required), integer("byteOffset", 0, largest_offset),
                                integer("byteLength", 1, largest_offset, required), integer("byteStride", 4, 252)};
constexpr Rule buffer[] = {integer("byteLength", 1, largest_offset, required), text("uri")};

// Materials.
constexpr int filters[] = {9728, 9729, 9984, 9985, 9986, 9987}, wraps[] = {10497, 33071, 33648};
constexpr Rule image[] = {text("uri"), text("mimeType"), index("bufferView", "bufferViews")};
constexpr Rule other_source[] = {index("source", "images", required)};
constexpr Rule texture_extensions[] = {object("KHR_texture_basisu", other_source),
                                       object("EXT_texture_webp", other_source)};
constexpr Rule texture[] = {index("sampler", "samplers"), index("source", "images"),
                            object("extensions", texture_extensions)};
constexpr Rule sampler[] = {one_of("magFilter", filters), one_of("minFilter", filters), one_of("wrapS", wraps),
                            one_of("wrapT", wraps)};
constexpr Rule texture_transform[] = {numbers("offset", 2), numbers("scale", 2),
                                      number("rotation", -largest_float, largest_float), integer("texCoord", 0, 1000)};
constexpr Rule texture_info_extensions[] = {object("KHR_texture_transform", texture_transform)};
constexpr Rule texture_info[] = {index("index", "textures", required), integer("texCoord", 0, 1000),
                                 object("extensions", texture_info_extensions)};
constexpr Rule metallic_roughness[] = {numbers("baseColorFactor", 4, 0, 1e30),
                                       object("baseColorTexture", texture_info)};
constexpr Rule emissive_strength[] = {number("emissiveStrength", 0, 1e30)};
constexpr Rule specular_glossiness[] = {numbers("diffuseFactor", 4, 0, 1e30), object("diffuseTexture", texture_info)};
constexpr Rule transmission[] = {number("transmissionFactor", 0, 1e30), object("transmissionTexture", texture_info)};
constexpr Rule material_extensions[] = {object("KHR_materials_emissive_strength", emissive_strength),
                                        object("KHR_materials_transmission", transmission),
                                        object("KHR_materials_pbrSpecularGlossiness", specular_glossiness)};
constexpr std::string_view alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr Rule material[] = {text("name"),
                             object("pbrMetallicRoughness", metallic_roughness),
                             object("normalTexture", texture_info),
                             object("occlusionTexture", texture_info),
                             object("emissiveTexture", texture_info),
                             numbers("emissiveFactor", 3, 0, 1e30),
                             words("alphaMode", alpha_modes),
                             number("alphaCutoff", 0, largest_float),
                             flag("doubleSided"),
                             object("extensions", material_extensions)};

// Meshes and the hierarchy.
constexpr Rule primitive[] = {index_map("attributes", "accessors", required), index("indices", "accessors"),
                              index("material", "materials"), integer("mode", 0, 6),
                              index_maps("targets", "accessors")};
constexpr Rule mesh[] = {text("name"), objects("primitives", primitive, required), numbers("weights", 0)};
constexpr Rule node_light[] = {index("light", "lights", required)};
constexpr Rule node_instancing[] = {index_map("attributes", "accessors", required)};
constexpr Rule node_profile[] = {index("light", "profiles", required), number("multiplier", 0, 1e30),
                                 numbers("color", 3, 0, 1e30)};
constexpr Rule node_extensions[] = {object("KHR_lights_punctual", node_light), object("EXT_lights_ies", node_profile),
                                    object("EXT_mesh_gpu_instancing", node_instancing)};
constexpr Rule node[] = {text("name"),
                         index("camera", "cameras"),
                         indices("children", "nodes"),
                         index("skin", "skins"),
                         index("mesh", "meshes"),
                         numbers("matrix", 16),
                         numbers("rotation", 4),
                         numbers("scale", 3),
                         numbers("translation", 3),
                         numbers("weights", 0),
                         object("extensions", node_extensions)};
constexpr Rule scene[] = {text("name"), indices("nodes", "nodes")};
constexpr Rule skin[] = {indices("joints", "nodes", required), index("inverseBindMatrices", "accessors"),
                         index("skeleton", "nodes")};
constexpr Rule channel_target[] = {index("node", "nodes"), text("path", required)};
constexpr Rule channel[] = {integer("sampler", 0, largest_int, required), object("target", channel_target, required)};
constexpr std::string_view interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr Rule animation_sampler[] = {index("input", "accessors", required), index("output", "accessors", required),
                                      words("interpolation", interpolations)};
constexpr Rule animation[] = {text("name"), objects("channels", channel, required),
                              objects("samplers", animation_sampler, required)};

// Cameras and lights.
constexpr double right_angle = 1.5708; // slightly more than π/2: many exporters round up
constexpr Rule perspective[] = {positive("yfov", 1e30, required), positive("znear", 1e30, required),
                                positive("zfar", 1e30), positive("aspectRatio", 1e30)};
constexpr Rule orthographic[] = {number("xmag", -1e30, 1e30, required), number("ymag", -1e30, 1e30, required),
                                 number("znear", 0, 1e30, required), positive("zfar", 1e30, required)};
constexpr std::string_view camera_types[] = {"perspective", "orthographic"};
constexpr Rule camera[] = {text("name"), words("type", camera_types, required), object("perspective", perspective),
                           object("orthographic", orthographic)};
constexpr Rule spot[] = {number("innerConeAngle", 0, right_angle), number("outerConeAngle", 0, right_angle)};
constexpr Rule light[] = {text("name"),
                          text("type", required),
                          numbers("color", 3, 0, 1e30),
                          number("intensity", 0, 1e30),
                          positive("range", 1e30),
                          object("spot", spot)};
constexpr Rule lights[] = {objects("lights", light, required)};
constexpr Rule profile[] = {text("name"), text("uri"), text("mimeType"), index("bufferView", "bufferViews")};
constexpr Rule profiles[] = {objects("lights", profile, required)};
constexpr Rule root_extensions[] = {object("KHR_lights_punctual", lights), object("EXT_lights_ies", profiles)};

constexpr Rule asset[] = {text("version", required), text("minVersion")};
constexpr Rule root[] = {object("asset", asset, required), objects("accessors", accessor),
                         objects("animations", animation), objects("bufferViews", buffer_view),
                         objects("buffers", buffer),       objects("cameras", camera),
                         objects("images", image),         objects("materials", material),
                         objects("meshes", mesh),          objects("nodes", node),
                         objects("samplers", sampler),     objects("scenes", scene),
                         objects("skins", skin),           objects("textures", texture),
                         index("scene", "scenes"),         object("extensions", root_extensions)};
}
