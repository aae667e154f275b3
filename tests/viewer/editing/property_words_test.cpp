#include "scene/scene.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/property_words.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
TEST(PropertyWords, EveryPropertyHasItsOwnShortLabel) {
    const SceneFolder studio;
    const Scene scene = load_scene(studio.file);
    ASSERT_GT(all_properties().size(), 30u);
    for (const Property& property : all_properties()) {
        const PropertyWords& words = words_of(property);
        EXPECT_LE(std::string(words.label).size(), 16u) << property.name;
        EXPECT_GT(std::string(words.help).size(), 15u) << property.name;
    }
    for (const Part part : {Part::light, Part::medium, Part::camera, Part::scene})
        for (size_t i = 0; i < count_of(scene, part); ++i) {
            std::set<std::string> labels;
            EXPECT_FALSE(properties_of(scene, part, i).empty());
            for (const Property* property : properties_of(scene, part, i))
                EXPECT_TRUE(labels.insert(words_of(*property).label).second) << property->name;
        }
}

TEST(PropertyWords, MessagesSpeakOfLabels) {
    EXPECT_EQ(with_labels(Part::light, "outer_cone must not be less than inner_cone, at any moment"),
              "outer cone must not be less than inner cone, at any moment");
    EXPECT_EQ(with_labels(Part::medium, "outer_cone"), "outer_cone");
}

TEST(PropertyWords, SunsStandWhereTheirLightComesFrom) {
    EXPECT_NEAR(sun_angles({0, -3, 0}).height, 90, 1e-3f);
    EXPECT_NEAR(sun_angles({0, 0, -2}).height, 0, 1e-3f);
    EXPECT_NEAR(sun_angles({0, 0, -2}).azimuth, 0, 1e-3f);
    EXPECT_NEAR(sun_angles({-1, -1, 0}).height, 45, 1e-3f);
    EXPECT_NEAR(sun_angles({-1, -1, 0}).azimuth, 90, 1e-3f);
    EXPECT_NEAR(sun_angles({1, 1, 0}).height, -45, 1e-3f);
    for (const vec3 direction : {vec3(0.78f, -0.42f, 0.15f), vec3(-0.1f, -0.9f, -0.4f), vec3(0.3f, 0.2f, -0.9f)}) {
        const vec3 again = direction_from(sun_angles(direction));
        EXPECT_LT(glm::distance(again, glm::normalize(direction)), 1e-5f);
    }
}

TEST(PropertyWords, SlidersHoldTheirValuesAndStayInRange) {
    int sliders = 0;
    for (const Property& property : all_properties()) {
        if (property.kind != ValueKind::number) continue;
        for (const float value : {property.min_value, property.slider_low, property.slider_high, property.max_value,
                                  0.5f * (property.slider_low + property.slider_high), 3 * property.slider_high}) {
            if (!(value >= property.min_value && value <= property.max_value)) continue;
            const SliderRange range = slider_range(property, value);
            EXPECT_LE(range.low, value) << property.name;
            EXPECT_GE(range.high, value) << property.name;
            EXPECT_GE(range.low, property.min_value) << property.name;
            EXPECT_LE(range.high, property.max_value) << property.name;
            EXPECT_LT(range.low, range.high) << property.name;
            EXPECT_TRUE(!range.logarithmic || range.low >= 0) << property.name;
            ++sliders;
        }
    }
    EXPECT_GT(sliders, 60);
}
}
