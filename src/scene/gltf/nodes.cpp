// The node hierarchy of the default scene: transforms, instances of meshes, cameras and lights.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <algorithm>
#include <set>

namespace tyndall {
namespace {
constexpr size_t max_instances = 1000000, max_posed = 4000000;

vec3 triple(const std::vector<double>& values, vec3 otherwise) {
    return values.size() == 3 ? vec3(values[0], values[1], values[2]) : otherwise;
}

quat turned(GltfDocument& document, float x, float y, float z, float w) {
    const float length = std::sqrt(x * x + y * y + z * z + w * w);
    if (length > 0 && std::isfinite(length)) return {w / length, x / length, y / length, z / length};
    document.count("rotations of zero or non-finite length are replaced by the identity");
    return {1, 0, 0, 0};
}

void read_transform(GltfDocument& document, const tinygltf::Node& source, Node& node) {
    if (source.matrix.size() == 16) {
        mat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<float>(source.matrix[i]);
        if (matrix[0].w != 0 || matrix[1].w != 0 || matrix[2].w != 0 || matrix[3].w != 1)
            document.count("perspective parts of matrices are ignored");
        matrix[0].w = matrix[1].w = matrix[2].w = 0, matrix[3].w = 1;
        if (std::abs(glm::determinant(glm::dmat3(matrix))) < 1e-30) document.count("nodes have a scale of 0");
        node.matrix = matrix;
        for (int axis = 0; axis < 3; ++axis) node.remainder[axis] = source.matrix[12 + axis] - matrix[3][axis];
        return;
    }
    node.translation = triple(source.translation, vec3(0));
    for (size_t axis = 0; axis < source.translation.size() && axis < 3; ++axis)
        node.remainder[static_cast<int>(axis)] =
            source.translation[axis] - node.translation.values[0][static_cast<int>(axis)];
    const vec3 scale = triple(source.scale, vec3(1));
    if (scale.x * scale.y * scale.z == 0) document.count("nodes have a scale of 0");
    node.scale = scale;
    if (source.rotation.size() == 4)
        node.rotation = turned(document, static_cast<float>(source.rotation[0]), static_cast<float>(source.rotation[1]),
                               static_cast<float>(source.rotation[2]), static_cast<float>(source.rotation[3]));
}

int add_node(GltfDocument& document, int index, int parent) {
    const tinygltf::Node& source = document.model.nodes[index];
    Node node;
    node.name = source.name.empty() ? "node " + std::to_string(index) : source.name;
    node.parent = parent;
    read_transform(document, source, node);
    document.scene->nodes.push_back(std::move(node));
    return document.nodes[index] = static_cast<int>(document.scene->nodes.size()) - 1;
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) return model.scenes[std::max(model.defaultScene, 0)].nodes;
    std::vector<bool> is_child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) is_child[child] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < model.nodes.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

// Index of the scene's skin; -1 if not all of its joints are in the scene or a matrix is not finite.
int gltf_skin(GltfDocument& document, int index) {
    const auto [known, added] = document.skins.try_emplace(index, -1);
    if (!added) return known->second;
    const tinygltf::Skin& source = document.model.skins[index];
    Skin skin;
    for (const int joint : source.joints) {
        if (document.nodes[joint] < 0) return -1;
        skin.joints.push_back(document.nodes[joint]);
    }
    skin.inverse_bind.assign(skin.joints.size(), mat4(1));
    if (source.inverseBindMatrices >= 0) {
        const std::string pointer = gltf_pointer("skins", index, "inverseBindMatrices");
        const std::vector<float> values = gltf_floats(document, source.inverseBindMatrices, 16, pointer);
        if (values.size() < 16 * skin.joints.size())
            refuse(document.location(pointer), "has " + std::to_string(values.size() / 16) + " matrices for " +
                                                   std::to_string(skin.joints.size()) + " joints");
        for (size_t i = 0; i < 16 * skin.joints.size(); ++i) {
            if (!std::isfinite(values[i])) return -1;
            skin.inverse_bind[i / 16][static_cast<int>(i / 4 % 4)][static_cast<int>(i % 4)] = values[i];
        }
    }
    document.scene->skins.push_back(std::move(skin));
    return known->second = static_cast<int>(document.scene->skins.size()) - 1;
}

// Weights of a mesh's morph targets: the node's, or else the mesh's.
std::vector<Keyed<float>> target_weights(const tinygltf::Model& model, int node, int mesh, size_t targets) {
    const std::vector<double>& own = model.nodes[node].weights;
    const std::vector<double>& weights = own.empty() ? model.meshes[mesh].weights : own;
    std::vector<Keyed<float>> result(targets, Keyed<float>(0.0f));
    for (size_t i = 0; i < std::min(targets, weights.size()); ++i)
        if (std::isfinite(weights[i])) result[i] = static_cast<float>(weights[i]);
    return result;
}

// Adds instances of the mesh of a glTF node at a node of the scene.
void add_instances(GltfDocument& document, int index, int node, const std::string& pointer) {
    const tinygltf::Node& source = document.model.nodes[index];
    const int skin = source.skin >= 0 ? gltf_skin(document, source.skin) : -1;
    Scene& scene = *document.scene;
    for (const int drawn : gltf_mesh(document, source.mesh)) {
        if (scene.instances.size() >= max_instances)
            refuse(document.location(pointer),
                   "the scene has more than " + std::to_string(max_instances) + " instances");
        const Mesh& mesh = scene.meshes[drawn];
        const size_t joints = skin >= 0 ? scene.skins[skin].joints.size() : 0;
        if ((document.posed += joints + mesh.targets.size()) > max_posed)
            refuse(document.location(pointer),
                   "the scene's instances have more than " + std::to_string(max_posed) + " joints and morph targets");
        Instance instance{node, drawn};
        instance.target_weights = target_weights(document.model, index, source.mesh, mesh.targets.size());
        if (mesh.influences > 0 && mesh.joint_count <= joints)
            instance.skin = skin;
        else if (source.skin >= 0)
            document.count("skinned meshes without usable joints are not deformed");
        document.instances[index].push_back(static_cast<int>(scene.instances.size()));
        scene.instances.push_back(std::move(instance));
    }
}

// EXT_mesh_gpu_instancing: a child node for every instance.
void add_gpu_instances(GltfDocument& document, int index, const tinygltf::Value& attributes) {
    const std::string pointer = gltf_pointer("nodes", index, "extensions/EXT_mesh_gpu_instancing/attributes");
    size_t count = 0;
    const auto values = [&](const char* name, int components) {
        std::vector<float> result;
        if (!attributes.Has(name)) return result;
        result = gltf_floats(document, attributes.Get(name).GetNumberAsInt(), components, pointer + "/" + name);
        const size_t here = result.size() / components;
        if (count && here != count)
            refuse(document.location(pointer), "the attributes differ in their number of elements");
        count = here;
        return result;
    };
    const std::vector<float> moves = values("TRANSLATION", 3), turns = values("ROTATION", 4),
                             sizes = values("SCALE", 3);
    if (count > max_instances) refuse(document.location(pointer), "has too many instances");
    for (size_t i = 0; i < count; ++i) {
        Node node;
        node.name = document.scene->nodes[document.nodes[index]].name + " " + std::to_string(i);
        node.parent = document.nodes[index];
        if (!moves.empty()) node.translation = vec3(moves[3 * i], moves[3 * i + 1], moves[3 * i + 2]);
        if (!turns.empty())
            node.rotation = turned(document, turns[4 * i], turns[4 * i + 1], turns[4 * i + 2], turns[4 * i + 3]);
        if (!sizes.empty()) node.scale = vec3(sizes[3 * i], sizes[3 * i + 1], sizes[3 * i + 2]);
        if (!is_finite(node.translation.values[0]) || !is_finite(node.scale.values[0])) {
            document.count("instances with a non-finite translation or scale are ignored");
            continue;
        }
        document.scene->nodes.push_back(std::move(node));
        add_instances(document, index, static_cast<int>(document.scene->nodes.size()) - 1, pointer);
    }
}

std::string unique_name(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = wanted;
    for (int number = 2; !taken.insert(name).second; ++number) name = wanted + "." + std::to_string(number);
    return name;
}

// The name that users know: the node's, without the suffix of the helper node that Blender's exporter inserts.
std::string object_name(const tinygltf::Node& node, const std::string& own, const std::string& otherwise) {
    constexpr std::string_view helper = "_Orientation";
    if (node.name.ends_with(helper) && node.name.size() > helper.size())
        return node.name.substr(0, node.name.size() - helper.size());
    return !node.name.empty() ? node.name : !own.empty() ? own : otherwise;
}

CameraSource camera_source(GltfDocument& document, const tinygltf::Camera& source) {
    CameraSource camera;
    if (source.type == "orthographic") {
        camera.ortho_height = static_cast<float>(2 * std::abs(source.orthographic.ymag));
        camera.near = static_cast<float>(source.orthographic.znear);
        camera.far = static_cast<float>(source.orthographic.zfar);
        return camera;
    }
    const float widest = glm::radians(170.0f);
    if (source.perspective.yfov > widest)
        document.count("vertical fields of view above 170 degrees are clamped to 170");
    camera.vertical_fov = std::min(static_cast<float>(source.perspective.yfov), widest);
    camera.near = static_cast<float>(source.perspective.znear);
    if (source.perspective.zfar > 0) camera.far = static_cast<float>(source.perspective.zfar);
    return camera;
}

// Blender writes candela and lux, or omits 683 lm/W, or writes watts, which points and spots spread over the sphere.
float unit_factor(LightUnits units, LightKind kind) {
    if (units == LightUnits::spec) return 1;
    return units == LightUnits::raw && !traits_of(kind).distant ? 683 / (4 * pi) : 683.0f;
}

bool known_light(std::string_view type) { return type == "point" || type == "spot" || type == "directional"; }

LightSource light_source(GltfDocument& document, int index) {
    const tinygltf::Light& source = document.model.lights[index];
    LightSource light;
    if (source.type == "spot") light.kind = LightKind::spot;
    if (source.type == "directional") light.kind = LightKind::sun;
    if (source.color.size() == 3) light.color = vec3(source.color[0], source.color[1], source.color[2]);
    light.intensity = static_cast<float>(source.intensity) * unit_factor(document.options.light_units, light.kind);
    if (source.range > 0 && !is_distant(light)) light.range = static_cast<float>(source.range);
    if (!has_cone(light)) return light;
    if (source.spot.innerConeAngle > source.spot.outerConeAngle)
        refuse(document.location("/extensions/KHR_lights_punctual/lights/" + std::to_string(index) + "/spot"),
               "innerConeAngle is greater than outerConeAngle");
    light.inner_cone = std::min(static_cast<float>(source.spot.innerConeAngle), pi / 2);
    if (source.spot.outerConeAngle < 0.999 * narrowest_cone)
        document.count("spots narrower than 0.05 degrees are widened to it");
    light.outer_cone = std::clamp(static_cast<float>(source.spot.outerConeAngle), narrowest_cone, pi / 2);
    return light;
}

int light_index(const tinygltf::Node& node) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light")) return -1;
    return extension->second.Get("light").GetNumberAsInt();
}
}

void add_gltf_nodes(GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    document.nodes.assign(model.nodes.size(), -1), document.instances.resize(model.nodes.size());
    std::vector<std::pair<int, int>> open; // node, parent in the scene
    for (const int root : root_nodes(model)) open.push_back({root, -1});
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
        const auto [index, parent] = open.back();
        open.pop_back();
        if (document.nodes[index] >= 0) continue; // a scene may list a node twice
        const int node = add_node(document, index, parent);
        const std::vector<int>& children = model.nodes[index].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({*child, node});
    }

    for (size_t i = 0; i < model.nodes.size(); ++i) {
        if (document.nodes[i] < 0 || model.nodes[i].mesh < 0) continue;
        const int index = static_cast<int>(i);
        const auto instancing = model.nodes[i].extensions.find("EXT_mesh_gpu_instancing");
        if (instancing != model.nodes[i].extensions.end())
            add_gpu_instances(document, index, instancing->second.Get("attributes"));
        else
            add_instances(document, index, document.nodes[i], gltf_pointer("nodes", i));
    }
}

void add_gltf_cameras_and_lights(GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    std::set<std::string> camera_names, light_names;
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        if (document.nodes[i] < 0) continue;
        const tinygltf::Node& node = model.nodes[i];
        if (node.camera >= 0) {
            CameraSource camera = camera_source(document, model.cameras[node.camera]);
            camera.name = unique_name(object_name(node, model.cameras[node.camera].name, "camera"), camera_names);
            camera.node = document.nodes[i];
            document.scene->cameras.push_back(camera);
        }
        if (const int index = light_index(node); index >= 0) {
            if (!known_light(model.lights[index].type)) {
                document.count("lights of unknown types are ignored");
                continue;
            }
            LightSource light = light_source(document, index);
            light.name = unique_name(object_name(node, model.lights[index].name, "light"), light_names);
            light.node = document.nodes[i];
            document.scene->lights.push_back(light);
        }
        if (std::optional<LightSource> light = gltf_ies_light(document, i)) {
            light->name = unique_name(object_name(node, "", "light"), light_names);
            light->node = document.nodes[i];
            document.scene->lights.push_back(*light);
        }
    }
}
}
