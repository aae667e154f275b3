// Morph targets and skins of glTF: where their vertices are at a moment.
#include "scene/pose.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
LoadResult answer_of(const GltfBuilder& gltf) {
    const TempFolder folder;
    return load(folder.put("scene.gltf", gltf.json()));
}
Scene scene_of(const GltfBuilder& gltf) {
    const LoadResult answer = answer_of(gltf);
    EXPECT_TRUE(answer.loaded) << answer.message;
    return answer.scene;
}

vec3 place(const Scene& scene, double seconds, size_t vertex) {
    const Instance& instance = scene.instances[0];
    const vec3 local = posed_position(scene.meshes[0], pose_of(scene, instance, seconds), vertex);
    return vec3(instance_matrix(scene, instance, seconds) * vec4(local, 1));
}

void expect_near(vec3 is, vec3 wanted) {
    EXPECT_LT(glm::distance(is, wanted), 1e-6f)
        << is.x << " " << is.y << " " << is.z << ", not " << wanted.x << " " << wanted.y << " " << wanted.z;
}

// A triangle whose tip one target raises, and which another moves aside.
GltfBuilder morphed() {
    GltfBuilder gltf = triangle_gltf();
    const std::string raised = std::to_string(gltf.floats({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3"));
    const std::string moved = std::to_string(gltf.floats({4, 0, 0, 4, 0, 0, 4, 0, 0}, "VEC3"));
    const std::string normals = std::to_string(gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"));
    const std::string turned = std::to_string(gltf.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3"));
    gltf.members["meshes"] = R"([{"weights":[0.25,0],"primitives":[{"attributes":{"POSITION":0,"NORMAL":)" + normals +
                             R"(},"indices":1,"targets":[{"POSITION":)" + raised + R"(},{"POSITION":)" + moved +
                             R"(,"NORMAL":)" + turned + "}]}]}]";
    return gltf;
}

TEST(Pose, TargetsAddUpByTheWeightsOfMeshOrNode) {
    GltfBuilder gltf = morphed();
    Scene scene = scene_of(gltf);
    expect_near(place(scene, 0, 2), {0, 1.5f, 0});
    EXPECT_FALSE(is_moving(scene, scene.instances[0]));
    scene.media.clear(); // whose haze goes on
    EXPECT_EQ(scene_bounds(scene, 0).high, vec3(1, 1.5f, 0));

    gltf.members["nodes"] = R"([{"mesh":0,"weights":[0.5,0.25],"translation":[0,0,3]}])";
    scene = scene_of(gltf);
    expect_near(place(scene, 0, 2), {1, 2, 3});
    expect_near(place(scene, 0, 0), {1, 0, 3});
    expect_near(posed_normal(scene.meshes[0], pose_of(scene, scene.instances[0], 0), 1), {0.25f, 0, 1});
}

TEST(Pose, WeightsAreAnimatedEachByItself) {
    GltfBuilder gltf = morphed();
    const std::string times = std::to_string(gltf.floats({0, 2}, "SCALAR"));
    const std::string linear = std::to_string(gltf.floats({0, 0, 1, 0.5f}, "SCALAR"));
    const std::string cubic = std::to_string(gltf.floats({0, 0, 0, 0, 0, 0, 0, 0, 1, 0.5f, 0, 0}, "SCALAR"));
    const auto animated = [&](const std::string& output, const char* interpolation) {
        gltf.members["animations"] = R"([{"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}],"samplers":[)"
                                     R"({"input":)" +
                                     times + R"(,"output":)" + output + R"(,"interpolation":")" + interpolation +
                                     "\"}]}]";
    };
    animated(linear, "LINEAR");
    Scene scene = scene_of(gltf);
    EXPECT_TRUE(is_moving(scene, scene.instances[0]));
    expect_near(place(scene, 0, 2), {0, 1, 0});
    expect_near(place(scene, 1, 2), {1, 2, 0});
    expect_near(place(scene, 2, 2), {2, 3, 0});
    animated(cubic, "CUBICSPLINE");
    scene = scene_of(gltf);
    expect_near(place(scene, 0.5, 2), {2 * 0.15625f, 1 + 2 * 0.15625f, 0}); // 3t² - 2t³ at a quarter
    animated(times, "LINEAR");
    expect_refusal(answer_of(gltf), "/animations/0/samplers/0/output");
}

// Three vertices: the first follows the first joint, the third the second, the one in between both; the second joint
// turns by a quarter about z within a second.
GltfBuilder skinned() {
    GltfBuilder gltf = triangle_gltf();
    const std::string joints =
        std::to_string(gltf.numbers<uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 9, 0, 0}, 5121, "VEC4"));
    const std::string weights = std::to_string(gltf.floats({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 3, 0, 0, 0}, "VEC4"));
    const std::string bind = std::to_string(gltf.floats(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4"));
    const std::string times = std::to_string(gltf.floats({0, 1}, "SCALAR"));
    const float half = std::sqrt(0.5f);
    const std::string turns = std::to_string(gltf.floats({0, 0, 0, 1, 0, 0, half, half}, "VEC4"));
    gltf.members["meshes"] = R"([{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":)" + joints +
                             R"(,"WEIGHTS_0":)" + weights + R"(},"indices":1}]}])";
    gltf.members["nodes"] =
        R"([{"mesh":0,"skin":0,"translation":[50,0,0]},{"translation":[0,2,0]},{"translation":[0,0,1]}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1,2]}])";
    gltf.members["skins"] = R"([{"joints":[1,2],"inverseBindMatrices":)" + bind + "}]";
    gltf.members["animations"] = R"([{"channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}}],"samplers":[)"
                                 R"({"input":)" +
                                 times + R"(,"output":)" + turns + "}]}]";
    return gltf;
}

TEST(Pose, SkinsFollowTheirJoints) {
    Scene scene = scene_of(skinned());
    EXPECT_TRUE(is_moving(scene, scene.instances[0]));
    // By the first joint: one up. By the second: one along z, and turned. The node's own place does not count.
    expect_near(place(scene, 0, 0), {0, 1, 0});
    expect_near(place(scene, 0, 1), {1, 0.5f, 0.5f});
    expect_near(place(scene, 0, 2), {0, 1, 1});
    expect_near(place(scene, 1, 0), {0, 1, 0});
    expect_near(place(scene, 1, 1), {0.5f, 1, 0.5f});
    expect_near(place(scene, 1, 2), {-1, 0, 1});
    scene.media.clear(); // whose haze goes on
    EXPECT_LT(glm::distance(scene_bounds(scene, 1).low, vec3(-1, 0, 0)), 1e-6f);
}

TEST(Pose, SkinsThatDoNotFitLeaveTheMeshWhereItsNodeIs) {
    GltfBuilder gltf = skinned();
    gltf.members["skins"] = R"([{"joints":[1]}])";
    Scene scene = scene_of(gltf);
    EXPECT_EQ(place(scene, 0, 0), vec3(50, 0, 0));
    EXPECT_TRUE(has_warning(scene, "without usable joints"));

    gltf = skinned();
    gltf.members["scenes"] = R"([{"nodes":[0,1]}])";
    EXPECT_EQ(place(scene_of(gltf), 0, 0), vec3(50, 0, 0)) << "a joint that is not in the scene";

    gltf = skinned();
    const int one = gltf.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
    gltf.members["skins"] = R"([{"joints":[1,2],"inverseBindMatrices":)" + std::to_string(one) + "}]";
    expect_refusal(answer_of(gltf), "/skins/0/inverseBindMatrices");
}
}
}
