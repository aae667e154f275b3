#include "viewer/editing/editing.h"

#include "base/io/file.h"
#include "scene/scene.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/recipe/recipe.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>

#include <bit>

namespace tyndall::test {
GltfBuilder model() {
    GltfBuilder gltf = triangle_gltf();
    const int times = gltf.floats({0, 2}, "SCALAR"), places = gltf.floats({0, 1, 0, 1, 1, 0}, "VEC3");
    gltf.members["extensionsUsed"] = R"(["KHR_lights_punctual"])";
    gltf.members["extensions"] = R"({"KHR_lights_punctual":{"lights":[
        {"type":"spot","intensity":300,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}},
        {"type":"directional","intensity":2},{"type":"point","intensity":50}]}})";
    gltf.members["nodes"] = R"([{"name":"thing","mesh":0},
        {"name":"Spot/1","translation":[1,2.3,0.7],"rotation":[-0.5,0.1,0.2,0.8336666],
         "extensions":{"KHR_lights_punctual":{"light":0}}},
        {"name":"Sun","rotation":[-0.6,0,0,0.8],"extensions":{"KHR_lights_punctual":{"light":1}}},
        {"name":"Moving","extensions":{"KHR_lights_punctual":{"light":2}}}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1,2,3]}])";
    gltf.members["animations"] =
        R"([{"channels":[{"sampler":0,"target":{"node":3,"path":"translation"}}],"samplers":[{"input":)" +
        std::to_string(times) + R"(,"output":)" + std::to_string(places) + "}]}]";
    return gltf;
}

const std::string rich_scene = R"(// made by hand
{
  "tyndall": 1, "gltf": "room.gltf", "frame_rate": 24, "frames": "1-48",
  "exposure": 0.50, /* stops */
  "camera": { "name": "eye", "position": [0.25, 1.0, 4], "target": [0, 1, 0], "vertical_fov": 40 },
  "lights": [
    { "name": "lamp \"\u00e4\"", "type": "point", "position": [0, 1.50, 0], "color": [1.0, 0.62, 0.28],
      "intensity": { "keys": [[0, 10], [0.5, 1.2e1], [1, 9.70], [2, 10]], "interpolation": "smooth", "loop": true } }, // flame
    { "name": "stage", "type": "spot", "position": { "keys": [[0, [-1, 3, 0]], [1, [1, 3, 0]]] },
      "target": { "keys": [[0, [0, 0, 0]], [0.5, [1, 0, 0]]] }, "intensity": 900,
      "inner_cone": 5, "outer_cone": { "keys": [[0, 8], [1, 16]], "interpolation": "step" } },
    { "type": "spot", "position": [2, 3, 1], "direction": [0, -2, -1], "intensity": 70, "inner_cone": 10, "outer_cone": 30 },
    { "name": "evening", "type": "sun", "direction": [0.78, -0.42, 0.15], "color": 1, "intensity": 3, "angle": 0.27 }
  ],
  "ambient": 0.02,
  "media": [
    { "name": "fog", "type": "homogeneous", "extinction": 0.20, "bounds": { "low": [-4, 0, -4], "high": [4, 4, 4] } },
    { "name": "fog", "type": "height", "extinction": { "keys": [[0, 0.1], [2, 0.3]] }, "falloff": 1.5, "g": 0.3,
      "rotate": { "keys": [[0, [0, 0, 0]], [2, [0, 90, 0]]] }, "scale": 1,
      "bounds": { "low": [-3, -1, -3], "high": [3, 3, 3] } },
    { "name": "dust", "type": "noise", "recipe": "fog/dust.json" },
    { "name": "air", "type": "homogeneous", "extinction": 0.01, "phase": "rayleigh", "bounds": { "low": [-4, 0, -4], "high": [4, 4, 4] } }
  ],
  "background": { "sky": { "zenith": [0.1, 0.2, 0.4], "horizon": [0.5, 0.5, 0.5] } }
}
)";

const std::string dust = R"({ "bounds": { "low": [-1, 0, -1], "high": [1, 2, 1] }, "voxel_size": 0.25,
  "wind": [0.1, 0, 0], "optics": { "extinction": 0.4, "albedo": [0.9, 0.8, 0.7], "g": 0.2 } })";

SceneFolder::SceneFolder(std::string_view text) {
    put("room.gltf", model().json());
    put("fog/dust.json", dust);
    file = put("scene.json", text);
}

void write_ball(const std::filesystem::path& file) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(0.25));
    Leaf leaf;
    leaf.values.fill(0.5f);
    volume.leaves.push_back(leaf);
    volume.active_low = ivec3(0), volume.active_high = ivec3(7);
    write_vdb(file, volume);
}

namespace {
std::string bits(float value) { return std::to_string(std::bit_cast<uint32_t>(value)) + " "; }
std::string bits(vec3 value) { return bits(value.x) + bits(value.y) + bits(value.z); }
std::string bits(quat value) { return bits(value.x) + bits(value.y) + bits(value.z) + bits(value.w); }

template<class T> std::string bits(const Keyed<T>& keyed) {
    std::string text = "[";
    for (const float time : keyed.times) text += bits(time);
    for (const T& value : keyed.values) text += bits(value);
    if (!keyed.constant()) text += std::to_string(static_cast<int>(keyed.interpolation)) + (keyed.loop ? " loop" : "");
    return text + "]";
}
}

std::vector<std::string> state_of(const Scene& scene) {
    std::vector<std::string> lines;
    for (const LightSource& l : scene.lights)
        lines.push_back(l.name + " " + std::to_string(l.node) + bits(l.position) + bits(l.direction) +
                        bits(l.target.value_or(vec3(0))) + bits(l.color) + bits(l.intensity) + bits(l.volume_scale) +
                        bits(l.surface_scale) + bits(l.inner_cone) + bits(l.outer_cone) + bits(l.radius) +
                        bits(l.angle) + bits(l.range) + (l.shadows ? "shadows" : ""));
    for (const MediumSource& m : scene.media)
        lines.push_back(m.name + " " + bits(m.extinction) + bits(m.g) + bits(m.albedo) + bits(m.emission) +
                        bits(m.translation) + bits(m.scale) + bits(m.rotate) + bits(m.rotation) + bits(m.height_base) +
                        bits(m.height_falloff) + bits(m.bounds.low) + bits(m.bounds.high) +
                        (m.recipe ? recipe_hash(*m.recipe) : ""));
    for (const CameraSource& c : scene.cameras)
        lines.push_back(c.name + " " + std::to_string(c.node) + bits(c.position) + bits(c.target) + bits(c.up) +
                        bits(c.vertical_fov) + bits(c.near) + bits(c.far) + bits(c.ortho_height) + bits(c.aperture) +
                        bits(c.focus.value_or(0.0f)));
    const Background& b = scene.background;
    lines.push_back("scene " + bits(scene.exposure) + bits(scene.ambient) + bits(b.color) + bits(b.zenith) +
                    bits(b.ground) + bits(b.intensity) + std::to_string(scene.camera));
    return lines;
}
}
