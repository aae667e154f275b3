// What scene files say of objects of the glTF, and the links of lights to them.
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
// A lamp of glass and cap below one node, and a table that has its mesh's name from nobody: instances glass, cap,
// table.
void put_room(const TempFolder& folder) {
    GltfBuilder gltf = triangle_gltf();
    const std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
    gltf.members["meshes"] =
        R"([{"name":"Sphere","primitives":[)" + primitive + R"(]},{"name":"Top","primitives":[)" + primitive + "]}]";
    gltf.members["nodes"] = R"([{"name":"Lamp","children":[1,2]},{"name":"Glass","mesh":0},{"name":"Cap","mesh":0},
                                {"name":"Table","mesh":1}])";
    gltf.members["scenes"] = R"([{"nodes":[0,3]}])";
    folder.put("room.gltf", gltf.json());
}

std::string scene_text(const std::string& more) {
    return R"({"tyndall": 1, "gltf": "room.gltf", "lights": [{"name": "sun", "type": "sun", "intensity": 1,
        "direction": [0, -1, 0])" +
           more + "}";
}

Scene loaded(const TempFolder& folder, const std::string& more) {
    const LoadResult answer = load(folder.put("scene.json", scene_text(more)));
    EXPECT_TRUE(answer.loaded) << answer.message;
    return answer.scene;
}

using Flags = std::vector<bool>;
Flags casting(const Scene& scene) {
    Flags flags;
    for (const Instance& instance : scene.instances) flags.push_back(instance.casts_shadows);
    return flags;
}

TEST(Objects, FlagsReachAllBelowANodeOrAMesh) {
    const TempFolder folder;
    put_room(folder);
    const auto flags = [&](const std::string& objects) {
        return casting(loaded(folder, R"(}], "objects": [)" + objects + "]"));
    };
    EXPECT_EQ(flags(""), (Flags{true, true, true}));
    EXPECT_EQ(flags(R"({"name": "Glass", "casts_shadows": false})"), (Flags{false, true, true}));
    EXPECT_EQ(flags(R"({"name": "Lamp", "casts_shadows": false})"), (Flags{false, false, true}));
    EXPECT_EQ(flags(R"({"name": "Sphere", "casts_shadows": false})"), (Flags{false, false, true}));
    EXPECT_EQ(flags(R"({"name": "Lamp", "casts_shadows": false}, {"name": "Cap", "casts_shadows": true})"),
              (Flags{false, true, true}));
}

TEST(Objects, MattesAndShadowsAreApart) {
    const TempFolder folder;
    put_room(folder);
    const Scene scene =
        loaded(folder, R"(}], "objects": [{"name": "Lamp", "matte": true}, {"name": "Cap", "casts_shadows": false}])");
    Flags mattes;
    for (const Instance& instance : scene.instances) mattes.push_back(instance.matte);
    EXPECT_EQ(mattes, (Flags{true, true, false}));
    EXPECT_EQ(casting(scene), (Flags{true, false, true}));
}

TEST(Objects, LinksOfLights) {
    const TempFolder folder;
    put_room(folder);
    const auto light = [&](const std::string& links) { return loaded(folder, ", " + links + "}]").lights[0]; };
    EXPECT_TRUE(loaded(folder, "}]").lights[0].lit.empty());
    EXPECT_EQ(light(R"("light_link": {"include": ["Table"]})").lit, (Flags{false, false, true}));
    EXPECT_EQ(light(R"("light_link": {"exclude": ["Table"]})").lit, (Flags{true, true, false}));
    EXPECT_EQ(light(R"("shadow_link": {"exclude": ["Glass", "Top"]})").casters, (Flags{false, true, false}));
    EXPECT_EQ(light(R"("shadow_link": {"include": []})").casters, (Flags{false, false, false}));
}

TEST(Objects, LinksOfEmissiveObjects) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    const std::string primitive = R"({"primitives":[{"attributes":{"POSITION":0},"indices":1)";
    gltf.members["materials"] = R"([{"emissiveFactor":[1,1,1]}])";
    gltf.members["meshes"] = "[" + primitive + R"(,"material":0}]},)" + primitive + "}]}]";
    gltf.members["nodes"] = R"([{"name":"Neon","mesh":0},{"name":"Wall","mesh":1}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1]}])";
    folder.put("room.gltf", gltf.json());
    const Scene scene = loaded(
        folder,
        R"(}], "objects": [{"name": "Neon", "light_link": {"exclude": ["Wall"]}, "shadow_link": {"include": ["Wall"]}}])");
    EXPECT_EQ(scene.instances[0].lit, (Flags{true, false}));
    EXPECT_EQ(scene.instances[0].casters, (Flags{false, true}));
    EXPECT_TRUE(scene.instances[1].lit.empty());

    const LoadResult answer = load(folder.put(
        "scene.json", scene_text(R"(}], "objects": [{"name": "Wall", "light_link": {"exclude": ["Neon"]}}])")));
    expect_refusal(answer, "/objects/0/light_link");
    EXPECT_NE(answer.message.find("emits none"), std::string::npos) << answer.message;
}

TEST(Objects, NamesThatAreNotThereAreAnswered) {
    const TempFolder folder;
    put_room(folder);
    const auto refused = [&](const std::string& more, const char* pointer, const char* hint) {
        const LoadResult answer = load(folder.put("scene.json", scene_text(more)));
        expect_refusal(answer, pointer);
        EXPECT_NE(answer.message.find(hint), std::string::npos) << answer.message;
    };
    refused(R"(}], "objects": [{"name": "Glas", "casts_shadows": false}])", "/objects/0/name", "did you mean Glass?");
    refused(R"(, "shadow_link": {"exclude": ["Table", "Tabel"]}}])", "/lights/0/shadow_link/exclude/1",
            "did you mean Table?");
    refused(R"(}], "objects": [{"name": "Cap", "casts_shadows": false}, {"name": "Cap", "casts_shadows": true}])",
            "/objects/1/name", "already");
}
}
}
