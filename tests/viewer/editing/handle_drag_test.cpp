#include "viewer/editing/editing.h"
#include "viewer/editing/handle_drag.h"
#include "viewer/editing/scene_session.h"
#include "viewer/fixtures.h"
#include "viewer/state/edit_actions.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
LightSource light_of(const char* name, LightKind kind, vec3 position) {
    LightSource light;
    light.name = name, light.kind = kind;
    light.position = Keyed<vec3>(position);
    return light;
}

// A camera at (0, 1, 4) that looks along -z; 64 x 40 pixels.
ViewState lit_state() {
    ViewState state;
    Scene scene = *small_scene();
    scene.lights.push_back(light_of("lamp", LightKind::point, {0, 1, 0}));
    scene.lights.push_back(light_of("moon", LightKind::sun, {0, 0, 0}));
    scene.lights.push_back(light_of("spot", LightKind::spot, {0.5f, 1, 1}));
    take_scene(state, std::make_shared<Scene>(scene));
    return state;
}

constexpr ivec2 picture{64, 40};
}

TEST(HandleDrag, SunsStandSideBySideAndEveryLightIsFound) {
    const ViewState state = lit_state();
    const std::vector<LightIcon> icons = icons_in_view(state, picture, 9);
    ASSERT_EQ(icons.size(), 4u);
    EXPECT_NEAR(icons[0].pixel.x, 32, 1e-3f);
    EXPECT_NEAR(icons[0].pixel.y, 0.14f * 40, 1e-3f);
    EXPECT_NEAR(icons[2].pixel.x - icons[0].pixel.x, 9, 1e-3f);
    const Camera camera = viewpoint(state).camera;
    for (const LightIcon& icon : icons) {
        const vec2 drawn = *pixel_of(camera, picture, icon.place);
        EXPECT_LT(glm::distance(drawn, icon.pixel), 1e-2f) << icon.light;
        EXPECT_EQ(nearest_icon(icons, icon.pixel + vec2(1, 0), 4)->light, icon.light);
    }
    EXPECT_EQ(nearest_icon(icons, {60, 38}, 4), nullptr);
}

TEST(HandleDrag, ADragIsWorkedOutFromItsBeginningAndIsOneStep) {
    ViewState state = lit_state();
    const std::vector<LightIcon> icons = icons_in_view(state, picture, 9);
    const LightIcon& lamp = *nearest_icon(icons, {32, 20}, 2);
    ASSERT_EQ(lamp.light, 1u);
    const HandleDrag drag = begin_drag(state, picture, lamp, Handle::view, lamp.pixel, 10, 3);
    const Camera camera = viewpoint(state).camera;
    for (const vec2 to : {vec2(40, 20), vec2(50, 11), vec2(36, 24)}) {
        const std::vector<Action> actions = drag_actions(drag, to);
        ASSERT_EQ(actions.size(), 1u);
        EXPECT_EQ(actions[0].words[0], "lights/lamp/position");
        apply(state, actions[0]);
        const vec2 now = *pixel_of(camera, picture, state.scene->lights[1].position.at(0));
        EXPECT_LT(glm::distance(now, to), 1e-3f) << "the light is under the pointer";
    }
    EXPECT_EQ(state.session->done, 1u);
    apply(state, parse_action("cancel 3"));
    EXPECT_EQ(state.scene->lights[1].position.at(0), vec3(0, 1, 0));
}

TEST(HandleDrag, ABeamsRingLiesOnItsCone) {
    const ViewState state = lit_state();
    const Camera camera = viewpoint(state).camera;
    const std::vector<vec2> ring = beam_ring(camera, picture, *state.scene, 3, 0, 0.5f);
    ASSERT_EQ(ring.size(), 48u);
    // Straight down with a half angle of 45 degrees: half a meter below, half a meter around.
    float low = 1e9f, high = -1e9f;
    for (const vec2 pixel : ring) {
        const Ray ray = camera_ray(camera, picture, pixel);
        const vec3 point = ray.at((0.5f - ray.origin.y) / ray.direction.y);
        EXPECT_NEAR(glm::distance(point, vec3(0.5f, 0.5f, 1)), 0.5f, 2e-3f);
        low = std::min(low, point.x), high = std::max(high, point.x);
    }
    EXPECT_NEAR(high - low, 1, 1e-2f);
}
}
