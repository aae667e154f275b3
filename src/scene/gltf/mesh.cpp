// Converts primitives to meshes: lists, strips and fans of triangles, with only the vertices they use and finite
// values.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <algorithm>
#include <map>

namespace tyndall {
namespace {
constexpr size_t max_triangles = size_t{1} << 29, max_morphed = size_t{1} << 25;
constexpr int max_influence_sets = 8;

// The attributes of a primitive as stored in the file.
struct Vertices {
    std::vector<float> positions, normals, uvs, colors;
    size_t color_parts = 3;
    struct Offsets {
        std::vector<float> positions, normals;
    };
    std::vector<Offsets> targets;
    struct Influences {
        std::vector<float> joints, weights; // four of each
    };
    std::vector<Influences> influences;
    size_t count() const { return positions.size() / 3; }
};

vec3 triple(const std::vector<float>& values, size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

std::vector<float> attribute(GltfDocument& document, const std::map<std::string, int>& attributes,
                             const std::string& name, int components, size_t count, const std::string& pointer,
                             Scaling scaling = Scaling::as_declared) {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return {};
    const std::string location = pointer + "/" + name;
    if (const size_t has = document.model.accessors[found->second].count; count && has != count)
        refuse(document.location(location),
               "has " + std::to_string(has) + " elements, POSITION has " + std::to_string(count));
    return gltf_floats(document, found->second, components, location, scaling);
}

// Morph targets, and joints and weights of a skin.
void read_shapes(GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& pointer,
                 Vertices& vertices) {
    const size_t count = vertices.count();
    for (size_t t = 0; t < primitive.targets.size(); ++t) {
        if ((document.morphed += count) > max_morphed)
            refuse(document.location(pointer + "/targets"), "the file has too many morph targets");
        const std::string location = pointer + "/targets/" + std::to_string(t);
        vertices.targets.push_back({attribute(document, primitive.targets[t], "POSITION", 3, count, location),
                                    attribute(document, primitive.targets[t], "NORMAL", 3, count, location)});
        if (vertices.normals.empty()) vertices.targets.back().normals.clear();
    }
    for (int set = 0; set < max_influence_sets; ++set) {
        const std::string number = std::to_string(set), location = pointer + "/attributes";
        Vertices::Influences here{attribute(document, primitive.attributes, "JOINTS_" + number, 4, count, location),
                                  attribute(document, primitive.attributes, "WEIGHTS_" + number, 4, count, location)};
        if (here.joints.empty() || here.weights.empty()) break;
        vertices.influences.push_back(std::move(here));
    }
}

Vertices read_vertices(GltfDocument& document, const tinygltf::Primitive& primitive, int uv_set,
                       const std::string& pointer) {
    const std::string location = pointer + "/attributes";
    Vertices vertices;
    vertices.positions = attribute(document, primitive.attributes, "POSITION", 3, 0, location);
    const size_t count = vertices.count();
    vertices.normals = attribute(document, primitive.attributes, "NORMAL", 3, count, location);
    const std::string uvs = "TEXCOORD_" + std::to_string(uv_set);
    vertices.uvs = attribute(document, primitive.attributes, uvs, 2, count, location);
    read_shapes(document, primitive, pointer, vertices);
    const auto color = primitive.attributes.find("COLOR_0");
    if (color == primitive.attributes.end()) return vertices;
    vertices.color_parts = document.model.accessors[color->second].type == TINYGLTF_TYPE_VEC4 ? 4 : 3;
    vertices.colors = attribute(document, primitive.attributes, "COLOR_0", static_cast<int>(vertices.color_parts),
                                count, location, Scaling::normalized);
    return vertices;
}

std::vector<uint32_t> read_indices(GltfDocument& document, const tinygltf::Primitive& primitive, size_t vertices,
                                   const std::string& pointer) {
    std::vector<uint32_t> indices;
    if (primitive.indices >= 0) {
        indices = gltf_integers(document, primitive.indices, pointer + "/indices");
        for (size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= vertices)
                refuse(document.location(pointer + "/indices"), "index " + std::to_string(i) + " is " +
                                                                    std::to_string(indices[i]) + "; there are only " +
                                                                    std::to_string(vertices) + " vertices");
        return indices;
    }
    if (vertices > max_triangles) refuse(document.location(pointer), "has too many vertices");
    indices.resize(vertices);
    for (size_t i = 0; i < vertices; ++i) indices[i] = static_cast<uint32_t>(i);
    return indices;
}

std::vector<glm::uvec3> triangles_of(const std::vector<uint32_t>& indices, int mode) {
    std::vector<glm::uvec3> triangles;
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (a != b && b != c && a != c) triangles.push_back({a, b, c});
    };
    if (mode == TINYGLTF_MODE_TRIANGLES)
        for (size_t i = 0; i + 2 < indices.size(); i += 3) add(indices[i], indices[i + 1], indices[i + 2]);
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        for (size_t i = 0; i + 2 < indices.size(); ++i) add(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        for (size_t i = 1; i + 1 < indices.size(); ++i) add(indices[i], indices[i + 1], indices[0]);
    return triangles;
}

// Removes triangles with a non-finite corner; returns how many.
size_t drop_non_finite(std::vector<glm::uvec3>& triangles, const std::vector<float>& positions) {
    return std::erase_if(triangles, [&](const glm::uvec3& triangle) {
        return !is_finite(triple(positions, triangle.x)) || !is_finite(triple(positions, triangle.y)) ||
               !is_finite(triple(positions, triangle.z));
    });
}

// Normalizes the normals; an invalid one is replaced by the normal of a triangle that uses it.
void mend_normals(Mesh& mesh) {
    std::vector<bool> bad(mesh.normals.size());
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        const float length = glm::length(mesh.normals[i]);
        bad[i] = !(length > 0) || !std::isfinite(length);
        mesh.normals[i] = bad[i] ? vec3(0, 1, 0) : mesh.normals[i] / length;
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        const vec3 a = mesh.positions[triangle.x];
        const vec3 face = glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a);
        const float length = glm::length(face);
        for (int corner = 0; corner < 3; ++corner)
            if (bad[triangle[corner]] && length > 0 && std::isfinite(length))
                mesh.normals[triangle[corner]] = face / length;
    }
}

vec3 finite_triple(const std::vector<float>& values, size_t i) {
    const vec3 value = triple(values, i);
    return is_finite(value) ? value : vec3(0);
}

// Copies a vertex's morph offsets, joints and weights; a vertex without valid weights follows its first joint.
void copy_shape(const Vertices& vertices, size_t from, Mesh& mesh) {
    for (size_t t = 0; t < vertices.targets.size(); ++t) {
        const auto& [positions, normals] = vertices.targets[t];
        if (!positions.empty()) mesh.targets[t].positions.push_back(finite_triple(positions, from));
        if (!normals.empty()) mesh.targets[t].normals.push_back(finite_triple(normals, from));
    }
    const size_t first = mesh.joint_weights.size();
    float sum = 0;
    for (const auto& [joints, weights] : vertices.influences)
        for (size_t i = 4 * from; i < 4 * from + 4; ++i) {
            const bool counts = weights[i] > 0 && std::isfinite(weights[i]);
            const bool known = joints[i] >= 0 && joints[i] < 65535;
            mesh.joints.push_back(!counts ? uint16_t{0} : known ? static_cast<uint16_t>(joints[i]) : uint16_t{65535});
            mesh.joint_weights.push_back(counts ? weights[i] : 0);
            mesh.joint_count = std::max<size_t>(mesh.joint_count, mesh.joints.back() + size_t{1});
            sum += mesh.joint_weights.back();
        }
    if (first == mesh.joint_weights.size()) return;
    if (!(sum > 0) || !std::isfinite(sum)) mesh.joint_weights[first] = sum = 1;
    for (size_t i = first; i < mesh.joint_weights.size(); ++i) mesh.joint_weights[i] /= sum;
}

// Copies the vertices the triangles use, in the order they are first used, and renumbers.
void compact(const Vertices& vertices, Mesh& mesh) {
    constexpr uint32_t unused = ~0u;
    std::vector<uint32_t> location(vertices.count(), unused);
    mesh.targets.resize(vertices.targets.size());
    mesh.influences = 4 * vertices.influences.size();
    const auto finite_or = [](float value, float otherwise) { return std::isfinite(value) ? value : otherwise; };
    for (glm::uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t from = triangle[corner];
            if (location[from] == unused) {
                location[from] = static_cast<uint32_t>(mesh.positions.size());
                mesh.positions.push_back(triple(vertices.positions, from));
                if (!vertices.normals.empty()) mesh.normals.push_back(triple(vertices.normals, from));
                copy_shape(vertices, from, mesh);
                if (!vertices.uvs.empty())
                    mesh.uvs.push_back(
                        {finite_or(vertices.uvs[2 * from], 0), finite_or(vertices.uvs[2 * from + 1], 0)});
                if (!vertices.colors.empty()) {
                    const float* color = &vertices.colors[from * vertices.color_parts];
                    mesh.colors.push_back({finite_or(color[0], 1), finite_or(color[1], 1), finite_or(color[2], 1)});
                    mesh.colors.back() = glm::clamp(mesh.colors.back(), vec3(0), vec3(1e6f));
                    if (vertices.color_parts == 4)
                        mesh.alphas.push_back(std::clamp(finite_or(color[3], 1), 0.0f, 1.0f));
                }
            }
            triangle[corner] = location[from];
        }
    if (std::ranges::all_of(mesh.alphas, [](float alpha) { return alpha == 1; })) mesh.alphas.clear();
    if (!mesh.normals.empty()) mend_normals(mesh);
}

// Whether all data a primitive refers to is present: a buffer may be a mere placeholder.
bool has_data(const GltfDocument& document, const tinygltf::Primitive& primitive) {
    const auto filled = [&](int accessor) {
        const int view = document.model.accessors[accessor].bufferView;
        return view < 0 || document.lacking[document.model.bufferViews[view].buffer].empty();
    };
    for (const auto& [name, accessor] : primitive.attributes)
        if (!filled(accessor)) return false;
    for (const auto& target : primitive.targets)
        for (const auto& [name, accessor] : target)
            if (!filled(accessor)) return false;
    return primitive.indices < 0 || filled(primitive.indices);
}

// Index of the scene's mesh; -1 when the primitive draws no triangle.
int scene_mesh(GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& name,
               const std::string& pointer) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES)
        return document.count("primitives of points or lines are ignored"), -1;
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return document.count("primitives without positions are ignored"), -1;
    for (const char* compression : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
        if (primitive.extensions.count(compression) && document.model.accessors[position->second].bufferView < 0)
            refuse(document.location(pointer), std::string("the mesh is compressed with ") + compression +
                                                   ", which cannot be read; export without it");
    if (!has_data(document, primitive)) return document.count("primitives whose buffer has no data are ignored"), -1;

    int uv_set = 0;
    Mesh mesh;
    mesh.name = name;
    if (primitive.material >= 0) mesh.material = gltf_material(document, primitive.material, uv_set);
    const Vertices vertices = read_vertices(document, primitive, uv_set, pointer);
    const std::vector<uint32_t> indices = read_indices(document, primitive, vertices.count(), pointer);
    if (indices.size() / 3 + document.triangles > max_triangles)
        refuse(document.location(pointer), "the file has more than " + std::to_string(max_triangles) + " triangles");
    mesh.triangles = triangles_of(indices, primitive.mode);
    if (const size_t dropped = drop_non_finite(mesh.triangles, vertices.positions))
        document.count("triangles with non-finite corners are ignored", static_cast<int>(dropped));
    if (mesh.triangles.empty()) return -1;

    document.triangles += mesh.triangles.size();
    compact(vertices, mesh);
    document.scene->meshes.push_back(std::move(mesh));
    return static_cast<int>(document.scene->meshes.size()) - 1;
}
}

const std::vector<int>& gltf_mesh(GltfDocument& document, int index) {
    const auto [known, added] = document.meshes.try_emplace(index);
    if (!added) return known->second;
    const tinygltf::Mesh& mesh = document.model.meshes[index];
    const std::string name = mesh.name.empty() ? "mesh " + std::to_string(index) : mesh.name;
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::string own_name = mesh.primitives.size() > 1 ? name + " " + std::to_string(i) : name;
        const int drawn = scene_mesh(document, mesh.primitives[i], own_name,
                                     gltf_pointer("meshes", index, "primitives/") + std::to_string(i));
        if (drawn >= 0) known->second.push_back(drawn);
    }
    return known->second;
}
}
