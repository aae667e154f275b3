#include "base/random.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "viewer/editing/light_handles.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// At (0,0,10) looking along -Z, 90 degrees high: at depth d a picture of 200 rows is 2d meters high.
const Camera eye = look_at(vec3(0, 0, 10), vec3(0), vec3(0, 1, 0), pi / 2);
constexpr ivec2 size{400, 200};

LightSource lamp(LightKind kind, vec3 position, vec3 direction = vec3(0, -1, 0)) {
    LightSource light;
    light.kind = kind, light.position = position, light.direction = direction;
    return light;
}

Scene scene_of(std::vector<LightSource> lights) {
    Scene scene;
    scene.lights = std::move(lights);
    return scene;
}

LightIcon icon_of(const Camera& camera, const Scene& scene, size_t light = 0) {
    for (const LightIcon& icon : light_icons(camera, size, scene, 0))
        if (icon.light == light) return icon;
    ADD_FAILURE();
    return {};
}
}

TEST(LightHandles, IconsStandWhereTheLightsAre) {
    const Scene scene = scene_of(
        {lamp(LightKind::point, {2, 1, 0}), lamp(LightKind::point, {0, 0, 11}), lamp(LightKind::sun, {0, 0, 0})});
    const std::vector<LightIcon> icons = light_icons(eye, size, scene, 0, vec3(0, 5, 5));
    ASSERT_EQ(icons.size(), 2u) << "the second is behind the eye";
    EXPECT_NEAR(icons[0].pixel.x, 220, 1e-3f);
    EXPECT_NEAR(icons[0].pixel.y, 90, 1e-3f); // 10 pixels per meter
    EXPECT_EQ(icons[0].depth, 10);
    EXPECT_EQ(icons[1].place, vec3(0, 5, 5)) << "a sun without a place";
    EXPECT_NEAR(pixel_size(eye, size, vec3(2, 1, 0)), 0.1f, 1e-6f);
}

TEST(LightHandles, PicksTheNearestIconWithinReach) {
    const Scene scene = scene_of({lamp(LightKind::point, {0, 0, 0}), lamp(LightKind::point, {1.5f, 0, 0}),
                                  lamp(LightKind::spot, {0, 0, 5}), lamp(LightKind::point, {0, 0, -5})});
    const auto pick = [&](vec2 pixel) { return pick_light(eye, size, pixel, scene, 0, 12); };
    EXPECT_EQ(pick({208, 100}), 1u) << "7 pixels from the second, 8 from the first";
    EXPECT_EQ(pick({205, 104}), 2u) << "behind one another: the nearer";
    EXPECT_EQ(pick({226, 100}), 1u);
    EXPECT_EQ(pick({228, 100}), std::nullopt);
}

TEST(LightHandles, AcrossTheViewALightStaysUnderThePointer) {
    Camera tilted = look_at(vec3(3, 4, 6), vec3(0, 1, 0), vec3(0, 1, 0), 0.7f);
    Camera flat = tilted;
    flat.ortho_height = 5;
    for (uint32_t i = 0; i < 200; ++i) {
        const auto random = [&](uint32_t k) { return to_unit(hash(i, k, 5u)); };
        const vec3 place(2 * random(0) - 1, 2 * random(1) - 1, 2 * random(2) - 1);
        for (const Camera& camera : {tilted, flat}) {
            const vec2 from = *pixel_of(camera, size, place), to(400 * random(3), 200 * random(4));
            const vec3 moved = place + drag_across_view(camera, size, place, from, to);
            EXPECT_LT(glm::distance(*pixel_of(camera, size, moved), to), 2e-2f);
            EXPECT_NEAR(glm::dot(moved - place, camera.forward), 0, 1e-5f) << "same depth";
        }
    }
    // Taken beside its middle it stays beside the pointer: 10 pixels are a meter.
    expect_near(drag_across_view(eye, size, vec3(0), {204, 100}, {214, 90}), vec3(1, 1, 0), 1e-5f);
}

TEST(LightHandles, AlongAnAxisALightGoesWhereThePointerMeetsIt) {
    expect_near(drag_along_axis(eye, size, vec3(0), vec3(1, 0, 0), {200, 100}, {230, 100}), vec3(3, 0, 0), 1e-5f);
    expect_near(drag_along_axis(eye, size, vec3(0), vec3(0, 1, 0), {200, 100}, {230, 80}), vec3(0, 2, 0), 1e-5f);
    EXPECT_EQ(drag_along_axis(eye, size, vec3(0), vec3(0, 0, 1), {200, 100}, {200, 90}), vec3(0))
        << "points at the eye";
    // An axis seen askew: to the pixel of every point of it, and back.
    const Camera camera = look_at(vec3(3, 4, 6), vec3(0, 1, 0), vec3(0, 1, 0), 0.7f);
    const vec3 place(0.3f, 0.2f, -0.4f);
    for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
        for (const float s : {-0.8f, -0.1f, 0.5f, 1.2f}) {
            const vec2 from = *pixel_of(camera, size, place), to = *pixel_of(camera, size, place + s * axis);
            expect_near(drag_along_axis(camera, size, place, axis, from, to), s * axis, 2e-4f);
        }
}

TEST(LightHandles, ADirectionFollowsThePointerOnItsSideOfTheSphere) {
    const vec3 place(0);
    for (const vec3 towards : {vec3(0.2f, 0.3f, 0.9f), vec3(0.2f, 0.3f, -0.9f), vec3(-0.5f, -0.5f, 0.4f)}) {
        const vec3 direction = glm::normalize(towards);
        const vec2 tip = *pixel_of(eye, size, place + 2.0f * direction);
        const vec3 side = direction.z > 0 ? vec3(0, 0, 1) : vec3(0, 0, -1);
        expect_near(drag_direction(eye, size, place, side, 2, tip), direction, 1e-4f);
    }
    // Beside the sphere: at a right angle to the pointer's ray, in the pointer's half of the picture.
    const vec3 beside = drag_direction(eye, size, place, vec3(0, 0, 1), 2, {360, 100});
    EXPECT_NEAR(glm::dot(beside, camera_ray(eye, size, {360, 100}).direction), 0, 1e-5f);
    EXPECT_NEAR(glm::length(beside), 1, 1e-6f);
    EXPECT_GT(beside.x, 0);
}

TEST(LightHandles, ALightShowsTheHandlesItHas) {
    const Scene scene = scene_of({lamp(LightKind::point, {0, 0, 0}), lamp(LightKind::spot, {0, 0, 0}, {1, 0, 0}),
                                  lamp(LightKind::sun, {0, 0, 0}, {0, -1, 0})});
    const auto names = [&](size_t light) {
        std::vector<Handle> handles;
        for (const HandlePoint& point : light_handles(eye, size, icon_of(eye, scene, light), scene, 0))
            handles.push_back(point.handle);
        return handles;
    };
    EXPECT_EQ(names(0), (std::vector{Handle::view, Handle::x, Handle::y})) << "z points at the eye";
    EXPECT_EQ(names(1), (std::vector{Handle::view, Handle::x, Handle::y, Handle::direction}));
    EXPECT_EQ(names(2), (std::vector{Handle::direction}));
    const auto points = light_handles(eye, size, icon_of(eye, scene), scene, 0, 50);
    EXPECT_NEAR(points[1].pixel.x, 250, 1e-3f);
    EXPECT_NEAR(points[2].pixel.y, 50, 1e-3f);
    EXPECT_EQ(pick_handle(points, {248, 103}), Handle::x);
    EXPECT_EQ(pick_handle(points, {225, 100}), std::nullopt);
}

TEST(LightHandles, DragsBecomeEdits) {
    Scene scene = scene_of({lamp(LightKind::spot, {0, 1, 0}, {0, -1, 0})});
    const auto drag = [&](Handle handle, vec2 from, vec2 to) {
        return drag_light(eye, size, scene, icon_of(eye, scene), handle, from, to, 0, 50);
    };
    auto edits = drag(Handle::x, {200, 90}, {220, 90});
    ASSERT_EQ(edits.size(), 1u);
    EXPECT_EQ(edits[0].property, "position");
    expect_near(edits[0].value, vec3(2, 1, 0), 1e-4f);
    EXPECT_EQ(drag(Handle::view, {200, 90}, {200, 90})[0].value, vec3(0, 1, 0)) << "nothing moved";

    edits = drag(Handle::direction, {203, 141}, {203, 141}); // taken beside the tip
    EXPECT_EQ(edits[0].property, "direction");
    expect_near(edits[0].value, vec3(0, -1, 0), 2e-3f); // near the outline the sphere is steep: √(rounding)

    // The tip of a target's direction turns it about the light, as far away as it was.
    scene.lights[0].target = vec3(0, -2, 0);
    scene.lights[0].direction = vec3(0, -3, 0);
    edits = drag(Handle::direction, {200, 140}, {240, 90});
    EXPECT_EQ(edits[0].property, "target");
    EXPECT_NEAR(glm::distance(edits[0].value, vec3(0, 1, 0)), 3, 1e-5f);
    const vec3 tip = vec3(0, 1, 0) + 5.0f * glm::normalize(edits[0].value - vec3(0, 1, 0)); // 50 pixels are 5 m
    EXPECT_LT(glm::distance(*pixel_of(eye, size, tip), vec2(240, 90)), 1e-2f);
    apply(scene, edits[0]);
    EXPECT_EQ(scene.lights[0].direction.at(0), edits[0].value - vec3(0, 1, 0));
    EXPECT_TRUE(
        drag_light(eye, size, scene_of({lamp(LightKind::sun, {0, 0, 0})}), LightIcon{}, Handle::view, {0, 0}, {9, 9}, 0)
            .empty());
}
}
