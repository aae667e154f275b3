#include "base/error.h"
#include "scene/scene.h"
#include "viewer/editing/editing.h"
#include "viewer/editing/key_place.h"
#include "viewer/editing/scene_edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using testing::ElementsAre;

void set(Scene& scene, std::string_view path, std::string_view value, double seconds = 0) {
    apply(scene, parse_edit(scene, path, value, seconds));
}

vec3 now(const Scene& scene, std::string_view path, double seconds = 0) {
    const bool several = path.starts_with("lights") || path.starts_with("media") || path.starts_with("cameras");
    const Edit edit = parse_edit(scene, path, several && path.ends_with("shadows") ? "on" : "1", seconds);
    return value_at(scene, find_property(scene, edit.part, edit.index, edit.property), edit.index, seconds);
}

std::string refusal(Scene& scene, std::string_view path, std::string_view value, double seconds = 0) {
    const std::vector<std::string> before = state_of(scene);
    try {
        set(scene, path, value, seconds);
    } catch (const Error& error) {
        EXPECT_EQ(state_of(scene), before) << path;
        return error.what();
    }
    return "";
}
}

TEST(KeyPlace, FindsTheKeyAtAMomentOrTheGapForANewOne) {
    const std::vector<float> times{0, 1, 2};
    const auto at = [&](double seconds, bool loop) { return find_key(times, loop, seconds, 24); };
    EXPECT_EQ(at(1, false).index, 1u);
    EXPECT_TRUE(at(1, false).exists);
    EXPECT_TRUE(at(1.002, false).exists);
    EXPECT_TRUE(at(0.998, false).exists); // 0.05 / 24 = 0.0021
    EXPECT_EQ(at(0.998, false).index, 1u);
    EXPECT_FALSE(at(1.003, false).exists);
    EXPECT_EQ(at(1.003, false).index, 2u);
    EXPECT_EQ(at(1.003, false).time, 1.003f);
    EXPECT_EQ(at(-1, false).index, 0u);
    EXPECT_EQ(at(-1, false).time, -1.0f);
    EXPECT_FALSE(at(-1, false).exists);
    EXPECT_EQ(at(5, false).index, 3u);
    EXPECT_FALSE(at(5, false).exists);
    for (const double seconds : {0.0, 2.0, 4.0, -2.0, 1.999, 2.001}) EXPECT_TRUE(at(seconds, true).seam) << seconds;
    EXPECT_EQ(at(5, true).index, 1u);
    EXPECT_TRUE(at(5, true).exists);
    EXPECT_FALSE(at(5, true).seam);
    EXPECT_EQ(at(-0.5, true).index, 2u);
    EXPECT_EQ(at(-0.5, true).time, 1.5f);
    EXPECT_FALSE(find_key(std::vector<float>{3}, true, 4, 24).exists);
    // Of two keys within reach the nearer one.
    const std::vector<float> close{1, 1.003f};
    EXPECT_EQ(find_key(close, false, 1.002, 24).index, 1u);
    EXPECT_EQ(find_key(close, false, 1.0012, 24).index, 0u);
    // Where floats are further apart than the reach, a moment that rounds onto a key is that key.
    const std::vector<float> late{999999.9375f, 1e6f};
    EXPECT_TRUE(find_key(late, false, 999999.95, 1000).exists);
}

TEST(SceneEdit, ReachesTheNumbersOfPhaseFunctions) {
    const SceneFolder studio(R"({"tyndall": 1, "media": [
        {"name": "cloud", "type": "homogeneous", "extinction": 1, "phase": {"type": "mie", "droplet_diameter": 10}},
        {"name": "dust", "type": "homogeneous", "extinction": 1, "phase": {"type": "draine", "g": 0.5, "alpha": 1}},
        {"name": "both", "type": "homogeneous", "extinction": 1, "phase": {"type": "mix", "weight": 0.5,
            "lobes": [{"type": "rayleigh"}, {"type": "isotropic"}]}}]})");
    Scene scene = load_scene(studio.file);
    set(scene, "media/cloud/phase/droplet_diameter", "20");
    set(scene, "media/dust/phase/alpha", "2");
    set(scene, "media/dust/phase/g", "-0.25");
    set(scene, "media/both/phase/weight", "0.75");
    EXPECT_EQ(now(scene, "media/cloud/phase/droplet_diameter").x, 20);
    EXPECT_EQ(scene.media[1].phase.alpha.at(0), 2);
    EXPECT_EQ(scene.media[1].phase.g.at(0), -0.25f);
    EXPECT_EQ(scene.media[2].phase.weight.at(0), 0.75f);
    EXPECT_NE(refusal(scene, "media/cloud/phase/droplet_diameter", "51"), "");
    EXPECT_NE(refusal(scene, "media/cloud/g", "0.5"), "") << "it has none";
    EXPECT_NE(refusal(scene, "media/both/phase/alpha", "1"), "");
}

TEST(SceneEdit, ListsWhatEachThingHas) {
    const SceneFolder studio;
    const Scene scene = load_scene(studio.file);
    const auto names = [&](Part part, size_t index) {
        std::vector<std::string> result;
        for (const Property* property : properties_of(scene, part, index)) {
            result.push_back(property->name);
            EXPECT_LE(property->min_value, property->slider_low);
            EXPECT_LT(property->slider_low, property->slider_high);
            EXPECT_LE(property->slider_high, property->max_value);
            EXPECT_GT(std::string(property->doc).size(), 5u);
        }
        return result;
    };
    ASSERT_EQ(scene.lights.size(), 7u); // three of the model
    EXPECT_THAT(names(Part::light, 2), ElementsAre("position", "color", "intensity", "exposure", "volume_scale",
                                                   "surface_scale", "range", "radius", "shadows"));
    EXPECT_THAT(names(Part::light, 4),
                ElementsAre("position", "target", "color", "intensity", "exposure", "volume_scale", "surface_scale",
                            "inner_cone", "outer_cone", "range", "radius", "shadows"));
    EXPECT_THAT(names(Part::light, 6), ElementsAre("direction", "color", "intensity", "exposure", "volume_scale",
                                                   "surface_scale", "angle", "shadows"));
    EXPECT_THAT(names(Part::medium, 1), ElementsAre("extinction", "albedo", "g", "emission", "base", "falloff",
                                                    "translate", "rotate", "scale", "bounds/low", "bounds/high"));
    EXPECT_THAT(names(Part::medium, 2),
                ElementsAre("extinction", "albedo", "g", "emission", "wind", "translate", "rotate", "scale"));
    EXPECT_THAT(names(Part::medium, 3), ElementsAre("extinction", "albedo", "emission", "translate", "rotate", "scale",
                                                    "bounds/low", "bounds/high"));
    EXPECT_THAT(names(Part::camera, 0), ElementsAre("position", "target", "vertical_fov", "aperture_radius"));
    EXPECT_THAT(names(Part::scene, 0), ElementsAre("exposure", "ambient", "background/sky/zenith",
                                                   "background/sky/horizon", "background/sky/ground"));
}

TEST(SceneEdit, ValuesAreThoseOfTheFile) {
    const SceneFolder studio;
    const Scene scene = load_scene(studio.file);
    EXPECT_EQ(now(scene, "lights/lamp \"\u00e4\"/intensity", 0.5), vec3(12, 0, 0));
    EXPECT_NEAR(now(scene, "lights/stage/inner_cone").x, 5, 1e-6f);
    EXPECT_EQ(now(scene, "lights/5/direction"), vec3(0, -2, -1)) << "as written";
    EXPECT_EQ(now(scene, "media/dust/wind"), vec3(0.1f, 0, 0));
    EXPECT_EQ(now(scene, "media/dust/albedo"), vec3(0.9f, 0.8f, 0.7f));
    EXPECT_EQ(now(scene, "exposure").x, 0.5f);
    EXPECT_EQ(now(scene, "lights/Spot~11/position"), vec3(1, 2.3f, 0.7f)) << "of its node";
    EXPECT_NEAR(glm::length(now(scene, "lights/Sun/direction")), 1, 1e-6f);
    EXPECT_TRUE(is_keyed(scene, find_property(scene, Part::medium, 1, "extinction"), 1));
    EXPECT_FALSE(is_keyed(scene, find_property(scene, Part::medium, 0, "extinction"), 0));
}

TEST(SceneEdit, AValueWithoutKeysIsReplaced) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    set(scene, "lights/evening/intensity", "400", 1.7);
    EXPECT_EQ(scene.lights[6].intensity.values, std::vector<float>{400});
    EXPECT_TRUE(scene.lights[6].intensity.times.empty());
    set(scene, "lights/evening/angle", "2");
    EXPECT_EQ(scene.lights[6].angle.values[0], glm::radians(2.0f));
    set(scene, "lights/evening/shadows", "off");
    EXPECT_FALSE(scene.lights[6].shadows);
    set(scene, "lights/2/range", "30");
    EXPECT_EQ(scene.lights[2].range.at(0), 30);
    set(scene, "media/2/wind", "0 0 -0.5");
    EXPECT_EQ(scene.media[2].recipe->wind, vec3(0, 0, -0.5f));
    set(scene, "ambient", "-0");
    EXPECT_FALSE(std::signbit(scene.ambient.values[0].x));
}

TEST(SceneEdit, ALensIsFocusedOnTheTargetUntilItIsSaid) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    EXPECT_NE(refusal(scene, "cameras/eye/focus_distance", "2"), "") << "a pinhole has none";
    set(scene, "cameras/eye/aperture_radius", "0.1");
    EXPECT_FLOAT_EQ(now(scene, "cameras/eye/focus_distance").x, std::hypot(0.25f, 4.0f));
    set(scene, "cameras/eye/focus_distance", "2");
    EXPECT_EQ(now(scene, "cameras/eye/focus_distance").x, 2);
    EXPECT_EQ(scene.cameras[0].focus->values, std::vector<float>{2});
}

TEST(SceneEdit, AValueWithKeysGetsOneAtTheMoment) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    Keyed<float>& extinction = scene.media[1].extinction;
    set(scene, "media/1/extinction", "0.7", 2);
    EXPECT_EQ(extinction.times, (std::vector<float>{0, 2}));
    EXPECT_EQ(extinction.values, (std::vector<float>{0.1f, 0.7f}));
    set(scene, "media/1/extinction", "0.5", 1);
    EXPECT_EQ(extinction.times, (std::vector<float>{0, 1, 2}));
    EXPECT_EQ(extinction.values, (std::vector<float>{0.1f, 0.5f, 0.7f}));
    set(scene, "media/1/extinction", "0.9", 3);
    EXPECT_EQ(extinction.times.back(), 3);
    EXPECT_NEAR(extinction.at(2.5), 0.8f, 1e-6f);
    EXPECT_EQ(now(scene, "media/1/extinction", 1).x, 0.5f);
}

TEST(SceneEdit, AClosedLoopStaysClosedAndAnOpenOneOpen) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    Keyed<float>& flame = scene.lights[3].intensity;
    set(scene, "lights/3/intensity", "20", 2);
    EXPECT_EQ(flame.values, (std::vector<float>{20, 12, 9.7f, 20})) << "first and last were equal";
    flame.values.back() = 5;
    set(scene, "lights/3/intensity", "30", 4);
    EXPECT_EQ(flame.values, (std::vector<float>{30, 12, 9.7f, 5}));
    set(scene, "lights/3/intensity", "7", 2.5); // 0.5 of the next turn
    EXPECT_EQ(flame.values, (std::vector<float>{30, 7, 9.7f, 5}));
    EXPECT_EQ(flame.times.size(), 4u);
}

TEST(SceneEdit, ALightKeepsAimingAtItsTarget) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    set(scene, "lights/stage/position", "0 4 0", 0);
    EXPECT_EQ(scene.lights[4].direction.at(0), vec3(0, -4, 0));
    set(scene, "lights/stage/target", "3 0 0", 0);
    EXPECT_EQ(scene.lights[4].direction.at(0), vec3(3, -4, 0));
    EXPECT_NE(refusal(scene, "lights/stage/direction", "0 -1 0"), "") << "has a target";
}

TEST(SceneEdit, AProfileKeepsItsOrientationWhenItsLightIsMoved) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    scene.lights[0].gobo.emplace();
    Node& node = scene.nodes[static_cast<size_t>(scene.lights[0].node)];
    node.rotation = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)));
    const LightPlacement before = light_placement(scene, 0, 0);
    ASSERT_EQ(apply(scene, parse_edit(scene, "lights/0/position", "5 6 7", 0)).size(), 3u);
    EXPECT_NEAR(glm::distance(light_placement(scene, 0, 0).direction, before.direction), 0, 1e-6f);
    EXPECT_NEAR(glm::distance(light_placement(scene, 0, 0).up, before.up), 0, 1e-6f);
}

TEST(SceneEdit, ALightOfTheModelLeavesItsNodeWithPlaceAndDirection) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    const LightPlacement before = light_placement(scene, 0, 0);
    const std::vector<Edit> singles = apply(scene, parse_edit(scene, "lights/0/position", "5 6 7", 0));
    ASSERT_EQ(singles.size(), 2u);
    EXPECT_EQ(scene.lights[0].node, -1);
    EXPECT_EQ(light_placement(scene, 0, 0).position, vec3(5, 6, 7));
    EXPECT_NEAR(glm::distance(light_placement(scene, 0, 0).direction, before.direction), 0, 1e-6f);
    EXPECT_EQ(apply(scene, parse_edit(scene, "lights/0/position", "5 6 8", 0)).size(), 1u);
    EXPECT_NE(refusal(scene, "lights/Moving/position", "0 0 0").find("animated"), std::string::npos);
    set(scene, "lights/Moving/intensity", "3");
    EXPECT_GE(scene.lights[2].node, 0) << "still moves";
}

TEST(SceneEdit, TheGroundGoesWithTheHorizonUntilItHasItsOwn) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    set(scene, "background/sky/horizon", "1 2 3");
    EXPECT_EQ(scene.background.ground.values[0], vec3(1, 2, 3));
    set(scene, "background/sky/ground", "0");
    set(scene, "background/sky/horizon", "4");
    EXPECT_EQ(scene.background.ground.values[0], vec3(0));
    EXPECT_EQ(scene.background.color.values[0], vec3(4));
}

TEST(SceneEdit, FarScenesShowPlacesOfTheWorldAndKeepThem) {
    Scene scene;
    scene.origin = dvec3(1 << 20, 64, 0);
    LightSource lamp;
    lamp.name = "lamp", lamp.position = vec3(1, 2, 3);
    scene.lights = {lamp};
    EXPECT_EQ(now(scene, "lights/lamp/radius"), vec3(0));
    const Property& position = find_property(scene, Part::light, 0, "position");
    EXPECT_EQ(value_at(scene, position, 0, 0), vec3((1 << 20) + 1, 66, 3));
    EXPECT_THAT(refusal(scene, "lights/lamp/position", "[0, 0, 0]"),
                testing::HasSubstr("too far from the world origin"));
}

TEST(SceneEdit, RefusesWhatASceneFileMayNotSayAndChangesNothing) {
    const SceneFolder studio;
    Scene scene = load_scene(studio.file);
    EXPECT_NE(refusal(scene, "lights/evening/intensity", "-1").find("is not between 0"), std::string::npos);
    EXPECT_NE(refusal(scene, "media/0/albedo", "0.5 1.1 0.5"), "");
    EXPECT_NE(refusal(scene, "media/0/g", "nan"), "");
    EXPECT_NE(refusal(scene, "lights/5/outer_cone", "9").find("inner_cone"), std::string::npos);
    EXPECT_NE(refusal(scene, "lights/stage/inner_cone", "9", 0).find("outer_cone"), std::string::npos);
    EXPECT_NE(refusal(scene, "lights/5/direction", "0 0 0"), "");
    EXPECT_NE(refusal(scene, "media/0/scale", "1 0 1"), "");
    EXPECT_NE(refusal(scene, "media/0/bounds/low", "-4 4 -4").find("upper"), std::string::npos);
    EXPECT_NE(refusal(scene, "cameras/eye/position", "0 1 0"), "");
    EXPECT_NE(refusal(scene, "media/3/g", "0.1").find("available: extinction"), std::string::npos);
    EXPECT_NE(refusal(scene, "lights/nobody/intensity", "1").find("available: "), std::string::npos);
    EXPECT_NE(refusal(scene, "media/fog/g", "0").find("several"), std::string::npos);
    EXPECT_NE(refusal(scene, "lights/evening", "1"), "");
    EXPECT_NE(refusal(scene, "lights/evening/intensity", "1 2 3"), "");
    EXPECT_NE(refusal(scene, "lights/evening/color", "1 2"), "");
    EXPECT_NE(refusal(scene, "lights/evening/shadows", "maybe"), "");
    EXPECT_NE(refusal(scene, "media/1/extinction", "1", 2e6), "");
    EXPECT_NE(refusal(scene, "wind", "1"), "");
}
}
