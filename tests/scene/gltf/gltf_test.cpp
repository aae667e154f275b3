// What a glTF holds arrives in the scene.
#include "scene/images.h"
#include "support/expect.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
Scene loaded(const GltfBuilder& gltf, const LoadOptions& options = {}) {
    const TempFolder folder;
    const LoadResult answer = load(folder.put("scene.gltf", gltf.json()), options);
    EXPECT_TRUE(answer.loaded) << answer.message;
    const LoadResult same = load(folder.put("scene.glb", glb_of(gltf.json(false), gltf.binary)), options);
    EXPECT_TRUE(same.loaded) << same.message;
    EXPECT_EQ(same.scene.meshes.size(), answer.scene.meshes.size());
    EXPECT_EQ(same.scene.nodes.size(), answer.scene.nodes.size());
    return answer.scene;
}

TEST(Gltf, ATriangleWithWhatItLacks) {
    const Scene scene = loaded(triangle_gltf());
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    EXPECT_EQ(scene.meshes[0].material, -1);
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.nodes[scene.instances[0].node].name, "thing");
    // A bare glTF is made visible, and says so.
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.media.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    for (const char* part : {"no light", "no fog", "no camera"}) EXPECT_TRUE(has_warning(scene, part)) << part;
    // The camera frames the triangle, not the fog: a sphere around the triangle fills most of the image's height.
    const float distance = glm::distance(scene.cameras[0].position.at(0), vec3(0.5f, 0.5f, 0));
    const float across = 2 * std::asin(std::sqrt(0.5f) / distance), vertical_fov = scene.cameras[0].vertical_fov.at(0);
    EXPECT_LE(across, vertical_fov);
    EXPECT_GT(across, 0.9f * vertical_fov);
    // Its fog has no edge to be seen nearby, yet lets light in, from above and from the side.
    EXPECT_EQ(scene.media[0].kind, MediumKind::height);
    const float reach = scene.media[0].bounds.high.x;
    EXPECT_NEAR(scene.media[0].extinction.at(0) * reach, 1.1f, 0.4f);
    EXPECT_EQ(scene.media[0].height_base.at(0), 0);
    EXPECT_NEAR(scene.media[0].extinction.at(0) * scene.media[0].height_falloff.at(0), 0.175f, 1e-4f); // depth above
}

TEST(Gltf, StripsFansAndPoints) {
    for (const auto& [mode, expected] :
         std::map<int, std::vector<glm::uvec3>>{{4, {{0, 1, 2}}}, // two left-over indices draw nothing
                                                {5, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}},
                                                {6, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}},
                                                {0, {}},
                                                {3, {}}}) {
        GltfBuilder gltf;
        gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0}, "VEC3");
        gltf.members["meshes"] =
            R"([{"primitives":[{"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + "}]}]";
        gltf.members["nodes"] = R"([{"mesh":0}])";
        const Scene scene = loaded(gltf);
        std::vector<std::vector<vec3>> corners, wanted;
        if (!scene.meshes.empty())
            for (const glm::uvec3& t : scene.meshes[0].triangles)
                corners.push_back(
                    {scene.meshes[0].positions[t.x], scene.meshes[0].positions[t.y], scene.meshes[0].positions[t.z]});
        const vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}};
        for (const glm::uvec3& t : expected) wanted.push_back({points[t.x], points[t.y], points[t.z]});
        EXPECT_EQ(corners, wanted) << "mode " << mode;
        EXPECT_EQ(has_warning(scene, "points or lines"), mode < 4);
    }
}

TEST(Gltf, IntegersInterleavedAndSparse) {
    GltfBuilder gltf;
    // Interleaved: three signed normalized bytes and one of padding, then two unsigned normalized shorts.
    const unsigned char bytes[] = {0,   0,   0, 0, 0, 0,   0,   0, 127, 0, 0,   0,
                                   255, 255, 0, 0, 0, 127, 129, 0, 0,   0, 255, 255};
    gltf.view({reinterpret_cast<const char*>(bytes), sizeof bytes}, R"(,"byteStride":8)");
    gltf.accessors = {
        R"({"bufferView":0,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"})",
        R"({"bufferView":0,"byteOffset":4,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"})"};
    gltf.numbers<uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 51, 0}, 5121, "VEC4");
    // Sparse without a base: zeros but for element 1.
    const int where = gltf.view(std::string("\x01\0", 2)), values = gltf.view({"\0\0\x80\x3f\0\0\0\0\0\0\0\0", 12});
    gltf.accessors.push_back(
        R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":)" +
        std::to_string(where) + R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}}");
    gltf.members["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2,"NORMAL":3}}]}])";
    gltf.members["nodes"] = R"([{"mesh":0}])";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions[1], vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, -1)) << "-127 and below are -1";
    EXPECT_EQ(mesh.uvs[1], vec2(1, 0));
    EXPECT_EQ(mesh.uvs[2], vec2(0, 1));
    EXPECT_EQ(mesh.colors[1], vec3(0, 1, 0));
    EXPECT_FLOAT_EQ(mesh.colors[2].z, 0.2f);
    EXPECT_EQ(mesh.alphas, (std::vector<float>{1, 1, 0}));
    EXPECT_EQ(mesh.normals[1], vec3(1, 0, 0));
    EXPECT_NEAR(glm::length(mesh.normals[0]), 1, 1e-6) << "a normal of length 0 is replaced";
}

TEST(Gltf, OnlyUsedVerticesAreKept) {
    GltfBuilder gltf;
    gltf.floats({9, 9, 9, 0, 0, 0, 8, 8, 8, 1, 0, 0, 0, 1, 0}, "VEC3");
    gltf.indices({4, 1, 3});
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
    gltf.members["nodes"] = R"([{"mesh":0}])";
    const Scene scene = loaded(gltf);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
}

TEST(Gltf, TrianglesWithoutNumbersAreDroppedAndCounted) {
    GltfBuilder gltf;
    gltf.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, 0, 0, 0, infinity, 0}, "VEC3");
    gltf.indices({0, 1, 2, 1, 2, 3, 0, 4, 1, 2, 1, 0});
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])";
    gltf.members["nodes"] = R"([{"mesh":0}])";
    const Scene scene = loaded(gltf);
    EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
    for (const vec3 position : scene.meshes[0].positions) EXPECT_TRUE(is_finite(position));
    EXPECT_TRUE(has_warning(scene, "non-finite corners are ignored (2)"));
}

TEST(Gltf, HierarchyMultipliesAndScenesChoose) {
    GltfBuilder gltf = triangle_gltf();
    gltf.members["nodes"] = R"([{"children":[1],"translation":[1,0,0],"rotation":[0,0,0.70710678,0.70710678]},
        {"children":[2],"scale":[2,2,2]}, {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,3,0,1]}, {"mesh":0}])";
    gltf.members["scenes"] = R"([{"nodes":[3]},{"nodes":[0]}])";
    EXPECT_EQ(loaded(gltf).nodes.size(), 1u) << "without `scene` the first";
    gltf.members["scene"] = "1";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.instances.size(), 1u);
    for (size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, static_cast<int>(i));
    // Up by 3, twice as large, a quarter turn to the left, one to the right.
    const vec3 origin(node_matrix(scene, scene.instances[0].node, 0) * vec4(0, 0, 0, 1));
    EXPECT_LE(glm::length(origin - vec3(-5, 0, 0)), 1e-5f);
    gltf.members.erase("scene"), gltf.members.erase("scenes");
    EXPECT_EQ(loaded(gltf).instances.size(), 2u) << "without scenes every root";
}

TEST(Gltf, GpuInstancesBecomeInstances) {
    GltfBuilder gltf = triangle_gltf();
    const int moves = gltf.floats({1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3"),
              sizes = gltf.floats({1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3");
    gltf.members["extensionsRequired"] = gltf.members["extensionsUsed"] = R"(["EXT_mesh_gpu_instancing"])";
    gltf.members["nodes"] =
        R"([{"mesh":0,"translation":[0,1,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
        std::to_string(moves) + R"(,"SCALE":)" + std::to_string(sizes) + "}}}}]";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    const mat4 last = node_matrix(scene, scene.instances[2].node, 0);
    EXPECT_EQ(vec3(last[3]), vec3(3, 1, 0));
    EXPECT_EQ(last[0].x, 3);
}

TEST(Gltf, AnimationsMoveNodes) {
    GltfBuilder gltf = triangle_gltf();
    const int times = gltf.floats({0, 1, 2}, "SCALAR");
    const int moves = gltf.floats({0, 0, 0, 2, 0, 0, 2, 4, 0}, "VEC3");
    const float h = std::sqrt(0.5f);
    const int turns = gltf.floats({0, 0, 0, 1, 0, h, 0, h, 0, 1, 0, 0}, "VEC4");
    const int splines =
        gltf.floats({0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 3, 3, 3, 0, 0, 0, 0, 0, 0, 5, 5, 5, 0, 0, 0}, "VEC3");
    const int other = gltf.floats({9, 9, 9, 9, 9, 9, 9, 9, 9}, "VEC3");
    const auto sampler = [&](int output, const char* kind) {
        return R"({"input":)" + std::to_string(times) + R"(,"output":)" + std::to_string(output) +
               R"(,"interpolation":")" + kind + "\"}";
    };
    const auto channel = [](int index, const char* path) {
        return R"({"sampler":)" + std::to_string(index) + R"(,"target":{"node":0,"path":")" + path + "\"}}";
    };
    gltf.members["animations"] = R"([{"channels":[)" + channel(0, "translation") + "," + channel(1, "rotation") + "," +
                                 channel(2, "scale") + R"(],"samplers":[)" + sampler(moves, "LINEAR") + "," +
                                 sampler(turns, "STEP") + "," + sampler(splines, "CUBICSPLINE") +
                                 R"(]},{"channels":[)" + channel(0, "translation") + R"(],"samplers":[)" +
                                 sampler(other, "LINEAR") + "]}]";
    const Scene scene = loaded(gltf);
    const Node& node = scene.nodes[0];
    EXPECT_EQ(node.translation.at(1.5), vec3(2, 2, 0));
    EXPECT_EQ(node.rotation.at(0.9), quat(1, 0, 0, 0));
    EXPECT_NEAR(node.rotation.at(1.5).y, h, 1e-6);
    EXPECT_NEAR(node.scale.at(0.5).x, 2, 1e-6) << "without slopes half way in value";
    EXPECT_EQ(node.scale.at(2).x, 5);
    EXPECT_TRUE(has_warning(scene, "is not played")) << "the first animation plays";
}

TEST(Gltf, CamerasKeepTheirVerticalAngle) {
    GltfBuilder gltf = triangle_gltf();
    gltf.members["cameras"] = R"([{"type":"perspective","perspective":{"yfov":0.5,"aspectRatio":3,"znear":0.2}},
        {"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0,"zfar":50}}])";
    gltf.members["nodes"] = R"([{"name":"A","camera":0},{"name":"A","camera":1}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1]}])";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].vertical_fov.at(0), 0.5f);
    EXPECT_EQ(scene.cameras[0].far, infinity);
    EXPECT_EQ(scene.cameras[1].ortho_height.at(0), 4);
    EXPECT_EQ(scene.cameras[1].far, 50);
    EXPECT_NE(scene.cameras[0].name, scene.cameras[1].name);
    EXPECT_FALSE(has_warning(scene, "no camera"));
}

TEST(Gltf, LightsHiddenByScaleAreNoted) {
    GltfBuilder gltf = triangle_gltf();
    gltf.members["extensions"] = R"({"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{}}]}})";
    gltf.members["nodes"] = R"([{"mesh":0},{"name":"gone","scale":[0,0,0],"children":[2]},
        {"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1]}])";
    EXPECT_TRUE(has_warning(loaded(gltf), "light lamp is off: its node has a scale of 0"));

    gltf.members["nodes"] = replaced(gltf.members["nodes"], "[0,0,0]", "[1,1,1]");
    EXPECT_FALSE(has_warning(loaded(gltf), "light lamp is off"));
    const int times = gltf.floats({0, 1, 2}, "SCALAR");
    const int sizes = gltf.floats({1, 1, 1, 0, 0, 0, 1, 1, 1}, "VEC3");
    gltf.members["animations"] = R"([{"samplers":[{"input":)" + std::to_string(times) + R"(,"output":)" +
                                 std::to_string(sizes) +
                                 R"(}],"channels":[{"sampler":0,"target":{"node":1,"path":"scale"}}]}])";
    EXPECT_TRUE(has_warning(loaded(gltf), "light lamp is off while its node has a scale of 0"));
}

// Values a little outside their range, as single precision rounds them, are no reason to refuse a file.
TEST(Gltf, RoundedLimitsAreAccepted) {
    GltfBuilder gltf = triangle_gltf();
    gltf.members["extensions"] =
        R"({"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{"innerConeAngle":1.5707963705062866,
        "outerConeAngle":1.5707963705062866}},{"type":"area"},{"type":"spot","spot":{"outerConeAngle":1e-6}}]}})";
    gltf.members["nodes"] = R"([{"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}},{"camera":0},
        {"extensions":{"KHR_lights_punctual":{"light":1}}},{"extensions":{"KHR_lights_punctual":{"light":2}}}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1,2,3]}])";
    gltf.members["cameras"] = R"([{"type":"perspective","perspective":{"yfov":4,"znear":0.1}}])";
    gltf.members["materials"] = R"([{"pbrMetallicRoughness":{"baseColorFactor":[1.0000001,2,0.5,1]}}])";
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}])";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].outer_cone.at(0), pi / 2);
    EXPECT_FLOAT_EQ(scene.lights[1].outer_cone.at(0), glm::radians(0.05f));
    EXPECT_EQ(scene.materials.at(0).base_color, vec3(1, 1, 0.5f));
    EXPECT_LT(scene.cameras.at(0).vertical_fov.at(0), pi);
    for (const char* part : {"170 degrees", "above 1 are clamped to 1", "unknown types", "widened to it (1)"})
        EXPECT_TRUE(has_warning(scene, part)) << part;
}

TEST(Gltf, UnusedMembersMayHoldAnything) {
    GltfBuilder gltf;
    gltf.numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", R"(,"min":[null,0,"x"],"max":{})");
    gltf.accessors.push_back(R"({"componentType":5126,"count":0,"type":"SCALAR"})");
    gltf.accessors.push_back(R"({"bufferView":0,"byteOffset":36,"componentType":5126,"count":0,"type":"VEC3"})");
    gltf.members["materials"] =
        R"([{"pbrMetallicRoughness":{"metallicFactor":1.5,"roughnessFactor":-1,"metallicRoughnessTexture":null}}])";
    gltf.members["meshes"] =
        R"([{"primitives":[{"attributes":{"POSITION":0},"material":0},{"attributes":{"POSITION":2}}]}])";
    gltf.members["nodes"] = R"([{"mesh":0}])";
    gltf.members["animations"] = R"([{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
        "samplers":[{"input":1,"output":2}]}])";
    const Scene scene = loaded(gltf);
    EXPECT_EQ(scene.meshes.size(), 1u) << "the other one has no vertices";
    EXPECT_EQ(scene.nodes.at(0).translation.at(0), vec3(0));
    EXPECT_TRUE(has_warning(scene, "animations without keys are ignored (1)"));
}

// CAD models have tens of thousands of parts.
TEST(Gltf, ManyPartsMakeManyValues) {
    GltfBuilder gltf = triangle_gltf();
    std::string nodes, roots;
    for (int i = 0; i < 62000; ++i) {
        nodes += std::string(i ? "," : "") + R"({"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1],"scale":[1,1,1]})";
        roots += (i ? "," : "") + std::to_string(i);
    }
    gltf.members["nodes"] = "[" + nodes + "]";
    gltf.members["scenes"] = R"([{"nodes":[)" + roots + "]}]";
    const TempFolder folder;
    const LoadResult answer = load(folder.put("parts.gltf", gltf.json()));
    EXPECT_TRUE(answer.loaded) << answer.message;
    EXPECT_EQ(answer.scene.instances.size(), 62000u);
}

// Blender 3.4 writes a point of 1000 W as 54351.4, 79.577 or 1000, and a sun of 3 as 2049, 3 or 3.
TEST(Gltf, LightUnits) {
    for (const auto& [units, point, sun] :
         {std::tuple(LightUnits::spec, 54351.4, 2049.0), std::tuple(LightUnits::unitless, 79.5775, 3.0),
          std::tuple(LightUnits::raw, 1000.0, 3.0)}) {
        GltfBuilder gltf;
        gltf.members["extensionsUsed"] = R"(["KHR_lights_punctual"])";
        gltf.members["extensions"] = R"({"KHR_lights_punctual":{"lights":[{"type":"point","intensity":)" +
                                     std::to_string(point) + R"(,"range":7},{"type":"directional","intensity":)" +
                                     std::to_string(sun) + "}]}}";
        gltf.members["nodes"] =
            R"([{"name":"Lamp","children":[1]},{"name":"Lamp_Orientation","extensions":{"KHR_lights_punctual":{"light":0}}},
            {"name":"Sun","extensions":{"KHR_lights_punctual":{"light":1}}}])";
        LoadOptions options;
        options.light_units = units;
        const Scene scene = loaded(gltf, options);
        ASSERT_EQ(scene.lights.size(), 2u);
        EXPECT_NEAR(scene.lights[0].intensity.at(0), 54351.4, 1);
        EXPECT_NEAR(scene.lights[1].intensity.at(0), 2049, 0.1);
        EXPECT_EQ(scene.lights[0].name, "Lamp");
        EXPECT_EQ(scene.lights[0].range.at(0), 7);
        EXPECT_EQ(scene.lights[1].kind, LightKind::sun);
    }
}

TEST(Gltf, MaterialsAndTextures) {
    GltfBuilder gltf = triangle_gltf();
    const int uv = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2"), other_uv = gltf.floats({5, 5, 6, 5, 5, 6}, "VEC2");
    const int image = gltf.view(png_of({2, 1}, {{255, 0, 0, 255}, {0, 255, 0, 0}}));
    gltf.members["images"] = R"([{"bufferView":)" + std::to_string(image) + R"(,"mimeType":"image/png"},
        {"uri":"missing.png"},{"uri":"data:image/webp;base64,)" +
                             base64(std::string("RIFF\0\0\0\0WEBPVP8 ", 16)) + R"("}])";
    gltf.members["samplers"] = R"([{"wrapS":33071,"wrapT":33648,"magFilter":9728}])";
    gltf.members["textures"] = R"([{"source":0,"sampler":0},{"source":1},{"source":2}])";
    gltf.members["materials"] = R"([
        {"name":"glass","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.75],"baseColorTexture":{"index":0,"texCoord":1,
         "extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.5707963,"scale":[0.5,0.5]}}}},"alphaMode":"BLEND","doubleSided":true},
        {"alphaMode":"MASK","alphaCutoff":0.3,"emissiveFactor":[1,0.5,0],"emissiveTexture":{"index":0},
         "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":20}}},
        {"pbrMetallicRoughness":{"baseColorTexture":{"index":1}},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":2}},
        {"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.1,0.2,0.3,1],"diffuseTexture":{"index":0}}}}])";
    std::string primitives;
    for (int material = 0; material < 4; ++material)
        primitives += (material ? "," : "") + (R"({"attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv)) +
                      R"(,"TEXCOORD_1":)" + std::to_string(other_uv) + R"(},"indices":1,"material":)" +
                      std::to_string(material) + "}";
    gltf.members["meshes"] = R"([{"primitives":[)" + primitives + "]}]";
    const Scene scene = loaded(gltf);
    ASSERT_EQ(scene.meshes.size(), 4u);
    ASSERT_EQ(scene.materials.size(), 4u);

    const Material& glass = scene.materials[scene.meshes[0].material];
    EXPECT_EQ(glass.name, "glass");
    EXPECT_EQ(glass.base_color, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(glass.alpha, 0.75f);
    EXPECT_EQ(glass.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.meshes[0].uvs[0], vec2(5, 5)) << "the set its texture asks for";
    const Texture& texture = scene.textures[glass.base_texture];
    EXPECT_FALSE(texture.repeat_u);
    EXPECT_TRUE(texture.mirror_v);
    EXPECT_TRUE(texture.nearest);
    EXPECT_EQ(texel_at(*texture.texels, 1, 0), vec4(0, 1, 0, 0));
    // The extension's own example: the lower left quadrant, turned clockwise by a quarter.
    const auto moved = [&](vec2 from) { return vec2(texture.uv_transform * vec3(from, 1)); };
    EXPECT_LE(glm::length(moved({0, 0}) - vec2(0, 1)), 1e-6f);
    EXPECT_LE(glm::length(moved({1, 1}) - vec2(0.5f, 0.5f)), 1e-6f);
    EXPECT_LE(glm::length(moved({0, 1}) - vec2(0.5f, 1)), 1e-6f);

    const Material& lamp = scene.materials[scene.meshes[1].material];
    EXPECT_EQ(lamp.alpha_mode, AlphaMode::mask);
    EXPECT_FLOAT_EQ(lamp.alpha_cutoff, 0.3f);
    EXPECT_EQ(lamp.emission, vec3(20, 10, 0));
    EXPECT_GE(lamp.emission_texture, 0);

    const Material& broken = scene.materials[scene.meshes[2].material];
    EXPECT_EQ(broken.base_texture, -1);
    EXPECT_EQ(broken.emission, vec3(0)) << "a surface whose mask is missing must not glow all over";
    EXPECT_TRUE(has_warning(scene, "missing.png"));
    EXPECT_TRUE(has_warning(scene, "WebP"));

    const Material& older = scene.materials[scene.meshes[3].material];
    EXPECT_EQ(older.base_color, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_GE(older.base_texture, 0);
}

TEST(Gltf, NamesInUris) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const std::string name = "b\xc3\xa4 r 100%.bin";
    folder.put("parts/" + name, gltf.binary);
    folder.put("100%25.bin", gltf.binary);
    for (const char* uri :
         {"parts/b%C3%A4%20r%20100%25.bin", "parts/b\xc3\xa4 r 100%.bin", "./parts/../x", "100%25.bin"}) {
        gltf.members["buffers"] =
            R"([{"byteLength":)" + std::to_string(gltf.binary.size()) + R"(,"uri":")" + uri + "\"}]";
        const LoadResult answer = load(folder.put("scene.gltf", gltf.json()));
        if (std::string_view(uri).find("..") != std::string_view::npos) {
            expect_refusal(answer, "/buffers/0/uri");
            continue;
        }
        EXPECT_TRUE(answer.loaded) << answer.message;
        EXPECT_EQ(answer.scene.inputs.size(), 2u);
    }
}
}
}
