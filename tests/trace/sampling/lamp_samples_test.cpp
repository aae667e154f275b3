// Where local lights show in a picture, and the beams of spots there.
#include "scene/light.h"
#include "scene/mesh.h"
#include "support/run_mode.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
std::vector<View::Lamp> seen(const Light& light, const View& view = view_of(vec3(0), {0, 0, -1}, {64, 32}, 1)) {
    Snapshot snapshot;
    snapshot.media.emplace_back();
    snapshot.lights = {light};
    return lamps_in(view, snapshot);
}

TEST(LampsIn, APointShinesAllAround) {
    Light light;
    light.position = {0, 0, -5}, light.radius = 0.5f;
    const std::vector<View::Lamp> lamps = seen(light);
    ASSERT_EQ(lamps.size(), 1u);
    EXPECT_NEAR(lamps[0].at.x, 32, 1e-4f);
    EXPECT_NEAR(lamps[0].at.y, 16, 1e-4f);
    EXPECT_NEAR(lamps[0].radius, 0.1f * 16 / std::tan(0.5f), 1e-3f); // of 5 m, 16 pixels to the edge
    EXPECT_EQ(lamps[0].half_angle, pi);
}

TEST(LampsIn, ABeamAcrossTheViewHasItsOwnAngle) {
    const std::vector<View::Lamp> lamps = seen(spot_light({0, 0, -5}, {0, -1, 0}, 1, 0, 0.2f));
    ASSERT_EQ(lamps.size(), 1u);
    EXPECT_NEAR(lamps[0].axis.y, 1, 1e-4f); // down, where rows grow
    EXPECT_NEAR(lamps[0].half_angle, 0.2f, 1e-4f);
}

TEST(LampsIn, ASlantedBeamLooksWider) {
    // sin ψ = sin 0.2 / sin 30°.
    const std::vector<View::Lamp> lamps = seen(spot_light({0, 0, -5}, {0.5f, 0, -std::sqrt(0.75f)}, 1, 0, 0.2f));
    EXPECT_NEAR(lamps[0].axis.x, 1, 1e-4f);
    EXPECT_NEAR(lamps[0].half_angle, std::asin(std::sin(0.2f) / 0.5f), 1e-4f);
}

// Points of the cone's surface lie within the beam of the picture, and some at its very edge.
TEST(LampsIn, TheBeamHoldsTheCone) {
    const View view = view_of(vec3(0), {0, 0, -1}, {64, 32}, 1);
    const Light light = spot_light({0, 0, -5}, {0.6f, -0.5f, 0.4f}, 1, 0, 0.3f);
    const View::Lamp lamp = seen(light)[0];
    const vec3 side = glm::normalize(glm::cross(light.direction, vec3(0, 0, 1)));
    const vec3 other = glm::cross(light.direction, side);
    float widest = 0;
    for (int i = 0; i < 3600; ++i) {
        const float a = static_cast<float>(i) * 2 * pi / 3600;
        const vec3 along =
            std::cos(0.3f) * light.direction + std::sin(0.3f) * (std::cos(a) * side + std::sin(a) * other);
        const std::optional<vec2> at = pixel_of(view.camera, view.size, light.position + 1e-2f * along);
        ASSERT_TRUE(at);
        const vec2 off = glm::normalize(*at - lamp.at);
        widest = std::max(widest, std::acos(std::min(glm::dot(off, lamp.axis), 1.0f)));
    }
    EXPECT_NEAR(widest, lamp.half_angle, 5e-3f);
}

TEST(LampsIn, FromInsideABeamItIsAllAround) {
    EXPECT_EQ(seen(spot_light({0, 0, -5}, {0.1f, 0, 1}, 1, 0, 0.2f))[0].half_angle, pi);
    EXPECT_EQ(seen(spot_light({0, 0, -5}, {0.1f, 0, -1}, 1, 0, 0.2f))[0].half_angle, pi);
    EXPECT_EQ(seen(spot_light({0, 0, -5}, {0, -1, 0}, 1, 0, pi / 2))[0].half_angle, pi);
}

TEST(LampsIn, NothingBehindTheCameraNorOfTheSun) {
    Light light;
    light.position = {0, 0, 5};
    EXPECT_TRUE(seen(light).empty());
    light.kind = LightKind::sun, light.position = {0, 0, -5};
    EXPECT_TRUE(seen(light).empty());
}
}
}
