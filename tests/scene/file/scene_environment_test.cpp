// Environments of scene files: with a map of their own, or the background as a light.
#include "base/image.h"
#include "scene/scene.h"
#include "support/load_answer.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
Scene scene_with(const TempFolder& folder, const std::string& fields) {
    const LoadResult answer = load(folder.put("scene.json", R"({"tyndall": 1, )" + fields + "}"));
    EXPECT_TRUE(answer.loaded) << answer.message;
    return answer.scene;
}

// Two texels, red and green.
std::string small_map() {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    return text + std::string("\x80\x00\x00\x81\x00\x80\x00\x81", 8);
}

TEST(SceneEnvironment, IsSeenWhereThereIsNoBackground) {
    const TempFolder folder;
    folder.put("sky.hdr", small_map());
    const Scene scene = scene_with(folder, R"("lights": [{"type": "environment", "name": "dome", "image": "sky.hdr",
        "rotation": 90, "intensity": 2, "exposure": 1, "volume_scale": 0.5, "surface_scale": 0.25, "shadows": false}])");
    ASSERT_TRUE(scene.environment);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.environment->name, "dome");
    EXPECT_TRUE(scene.environment->map.lat_long);
    EXPECT_FLOAT_EQ(scene.environment->map.rotation.at(0), glm::radians(90.0f));
    EXPECT_EQ(scene.environment->map.image->at(0, 0), vec3(1, 0, 0));
    EXPECT_FLOAT_EQ(scene.environment->volume_scale.at(0), 0.5f);
    EXPECT_FLOAT_EQ(scene.environment->surface_scale.at(0), 0.25f);
    EXPECT_FALSE(scene.environment->shadows);
    EXPECT_TRUE(scene.background.stated);
    EXPECT_EQ(scene.background.image, scene.environment->map.image);
    EXPECT_FLOAT_EQ(scene.background.intensity.at(0), 2);
    EXPECT_FLOAT_EQ(scene.background.exposure.at(0), 1);
    EXPECT_EQ(scene.inputs.size(), 2u) << "the map counts among the files";
}

TEST(SceneEnvironment, IsHiddenOnRequestAndBehindABackground) {
    const TempFolder folder;
    EXPECT_FALSE(
        scene_with(folder, R"("lights": [{"type": "environment", "color": 1, "visible": false}])").background.stated);
    const Scene other =
        scene_with(folder, R"("lights": [{"type": "environment", "color": 1}], "background": {"color": 3})");
    EXPECT_EQ(other.background.color.at(0), vec3(3));
    EXPECT_EQ(other.environment->map.color.at(0), vec3(1));
}

TEST(SceneEnvironment, IsTheBackgroundWithoutAMapOfItsOwn) {
    const TempFolder folder;
    const Scene scene = scene_with(folder, R"("lights": [{"type": "environment", "intensity": 5}],
        "background": {"sky": {"zenith": 1, "horizon": [1, 2, 3], "ground": 0}})");
    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->map.kind, BackgroundKind::sky);
    EXPECT_EQ(scene.environment->map.color.at(0), vec3(1, 2, 3));
    EXPECT_FLOAT_EQ(scene.environment->intensity.at(0), 5);
    EXPECT_FLOAT_EQ(scene.background.intensity.at(0), 1) << "what is seen is as the background says";
}

TEST(SceneEnvironment, IsNotAPlate) {
    const TempFolder folder;
    folder.put("plate.hdr", small_map());
    const LoadResult answer = load(folder.put("scene.json", R"({"tyndall": 1, "lights": [{"type": "environment"}],
        "background": {"image": "plate.hdr"}})"));
    EXPECT_FALSE(answer.loaded);
    EXPECT_NE(answer.message.find("/lights/0: the background is a plate"), std::string::npos) << answer.message;
}
}
}
