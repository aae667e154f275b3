// glTF objects that a scene file refers to: shadow casting, holdouts and light linking.
#include "base/text.h"
#include "scene/file/scene_file.h"

#include <algorithm>

namespace tyndall {
namespace {
// Whether a node is `top` or one of its descendants.
bool is_below(const Scene& scene, int node, int top) {
    while (node >= 0 && node != top) node = scene.nodes[static_cast<size_t>(node)].parent;
    return node == top;
}

std::vector<int> instances_below(const Scene& scene, int top) {
    std::vector<int> found;
    for (size_t i = 0; i < scene.instances.size(); ++i)
        if (is_below(scene, scene.instances[i].node, top)) found.push_back(static_cast<int>(i));
    return found;
}

// Names of nodes that have a mesh, and of meshes.
std::vector<std::string> object_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const Instance& instance : scene.instances) {
        if (instance.node >= 0) names.push_back(scene.nodes[static_cast<size_t>(instance.node)].name);
        names.push_back(scene.meshes[static_cast<size_t>(instance.mesh)].name);
    }
    std::ranges::sort(names);
    names.erase(std::ranges::unique(names).begin(), names.end());
    return names;
}

std::vector<int> instances_of(const Field& name, const Scene& scene) {
    std::vector<int> found = instances_named(scene, name.json->string);
    if (found.empty()) refuse(name, unknown_name("object with a mesh", name.json->string, object_names(scene)));
    return found;
}
}

std::vector<int> instances_named(const Scene& scene, const std::string& name) {
    std::vector<int> found;
    for (size_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].name != name) continue;
        const std::vector<int> below = instances_below(scene, static_cast<int>(node));
        found.insert(found.end(), below.begin(), below.end());
    }
    if (!found.empty()) return found;
    for (size_t i = 0; i < scene.instances.size(); ++i)
        if (scene.meshes[static_cast<size_t>(scene.instances[i].mesh)].name == name)
            found.push_back(static_cast<int>(i));
    return found;
}

std::vector<bool> read_link(const Field& field, const Scene& scene) {
    const Field include = field.member("include"), exclude = field.member("exclude");
    if (static_cast<bool>(include) == static_cast<bool>(exclude)) refuse(field, "needs either include or exclude");
    std::vector<bool> link(scene.instances.size(), !include);
    const Field names = include ? include : exclude;
    for (size_t i = 0; i < names.json->items.size(); ++i)
        for (const int instance : instances_of(names.item(i), scene))
            link[static_cast<size_t>(instance)] = static_cast<bool>(include);
    return link;
}

namespace {
// Links of the light that an object emits.
void read_links(const Field& object, const std::vector<int>& instances, Scene& scene) {
    for (const char* key : {"light_link", "shadow_link"}) {
        const Field field = object.member(key);
        if (!field) continue;
        const std::vector<bool> link = read_link(field, scene);
        bool emits = false;
        for (const int index : instances) {
            Instance& instance = scene.instances[static_cast<size_t>(index)];
            const int material = scene.meshes[static_cast<size_t>(instance.mesh)].material;
            if (material < 0 || !can_emit(scene.materials[static_cast<size_t>(material)])) continue;
            (std::string_view(key) == "light_link" ? instance.lit : instance.casters) = link;
            emits = true;
        }
        if (!emits) refuse(field, "links the light that the object emits, but it emits none");
    }
}
}

void read_objects(const Field& root, Scene& scene) {
    const Field objects = root.member("objects");
    if (!objects) return;
    if (!root.member("gltf")) refuse(objects, "has no effect without a glTF");
    std::vector<std::string> known;
    for (size_t i = 0; i < objects.json->items.size(); ++i) {
        const Field object = objects.item(i), name = object.member("name");
        if (std::ranges::count(known, name.json->string)) refuse(name, "another object already has this name");
        known.push_back(name.json->string);
        const std::vector<int> instances = instances_of(name, scene);
        for (const int index : instances) {
            Instance& instance = scene.instances[static_cast<size_t>(index)];
            if (object.member("casts_shadows")) instance.casts_shadows = object.json->boolean_or("casts_shadows", true);
            if (object.member("matte")) instance.matte = object.json->boolean_or("matte", false);
        }
        read_links(object, instances, scene);
    }
}
}
