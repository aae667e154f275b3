// Which animations of a glTF play.
#include "support/expect.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
// A triangle with three clips: two that move it, one of which also turns it, and one that scales it.
std::string character() {
    GltfBuilder gltf = triangle_gltf();
    const int times = gltf.floats({0, 1}, "SCALAR"), turns = gltf.floats({0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
    const auto clip = [&](const std::string& name, int output, const char* path, const std::string& more_channels = "",
                          const std::string& more_samplers = "") {
        return R"({"name":")" + name + R"(","channels":[{"sampler":0,"target":{"node":0,"path":")" + path + "\"}}" +
               more_channels + R"(],"samplers":[{"input":)" + std::to_string(times) + R"(,"output":)" +
               std::to_string(output) + "}" + more_samplers + "]}";
    };
    const int still = gltf.floats({0, 0, 0, 1, 0, 0}, "VEC3"), far = gltf.floats({0, 0, 0, 9, 0, 0}, "VEC3");
    gltf.members["animations"] =
        "[" + clip("Idle", still, "translation") + "," +
        clip("Walk", far, "translation", R"(,{"sampler":1,"target":{"node":0,"path":"rotation"}})",
             R"(,{"input":)" + std::to_string(times) + R"(,"output":)" + std::to_string(turns) + "}") +
        "," + clip("Grow", far, "scale") + "]";
    return gltf.json();
}

TEST(GltfAnimations, AClipPlaysAsAWholeOrNotAtAll) {
    const TempFolder folder;
    const LoadResult answer = load(folder.put("character.gltf", character()));
    ASSERT_TRUE(answer.loaded) << answer.message;
    const Node& node = answer.scene.nodes.at(0);
    EXPECT_EQ(node.translation.at(1), vec3(1, 0, 0));
    EXPECT_TRUE(node.rotation.constant()) << "the turn belongs to a clip that does not play";
    EXPECT_EQ(node.scale.at(1).x, 9) << "a clip of other properties plays along";
    EXPECT_TRUE(has_warning(answer.scene, R"(animation "Walk" is not played: it animates what "Idle" animates)"));
    EXPECT_EQ(answer.scene.animations, (std::vector<std::string>{"Idle", "Walk", "Grow"}));
}

TEST(GltfAnimations, ASceneFileChooses) {
    const TempFolder folder;
    folder.put("character.gltf", character());
    const auto scene_with = [&](const std::string& chosen) {
        return load(folder.put("scene.json", R"({"tyndall": 1, )" + chosen + "}"));
    };
    const std::string gltf = R"("gltf": "character.gltf", )";
    const LoadResult walk = scene_with(gltf + R"("gltf_animations": ["Walk"])");
    ASSERT_TRUE(walk.loaded) << walk.message;
    const Node& node = walk.scene.nodes.at(0);
    EXPECT_EQ(node.translation.at(1), vec3(9, 0, 0));
    EXPECT_FALSE(node.rotation.constant());
    EXPECT_TRUE(node.scale.constant());
    EXPECT_FALSE(has_warning(walk.scene, "not played"));
    EXPECT_TRUE(scene_with(gltf + R"("gltf_animations": [])").scene.nodes.at(0).translation.constant());
    expect_refusal(scene_with(gltf + R"("gltf_animations": ["Walk", "Dance"])"),
                   "/gltf_animations/1: no animation 'Dance'; available: Idle, Walk, Grow");
    expect_refusal(scene_with(R"("gltf_animations": ["Walk"])"), "has no effect without a glTF");
}
}
}
