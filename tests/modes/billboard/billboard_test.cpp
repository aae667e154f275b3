// Beam cards: where they are placed, and what they do to a picture.
#include "modes/billboard/billboard.h"
#include "modes/billboard/limitations.h"
#include "modes/billboard/settings.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A wall at x = 0 with a hole |y - 2|, |z| < 0.5, floor and ceiling, and fog behind the wall; a sun shines through the
// hole at 45 degrees and lands on the floor about x = 2.
struct HoleInWall {
    Scene scene;
    Snapshot snapshot;

    HoleInWall() {
        const vec3 up(0, 1, 0), along(0, 0, 1);
        add_mesh(scene, quad({0, 0, -4}, 1.5f * up, 8.0f * along));
        add_mesh(scene, quad({0, 2.5f, -4}, 3.5f * up, 8.0f * along));
        add_mesh(scene, quad({0, 1.5f, -4}, up, 3.5f * along));
        add_mesh(scene, quad({0, 1.5f, 0.5f}, up, 3.5f * along));
        add_mesh(scene, quad({0, 0, -4}, {6, 0, 0}, 8.0f * along));
        add_mesh(scene, quad({0, 6, -4}, {6, 0, 0}, 8.0f * along));
        snapshot =
            snapshot_of({homogeneous_medium(0.2f, {vec3(0, 0, -4), vec3(6, 6, 4)})}, {sun_light({1, -1, 0}, 10)});
        snapshot.scene = &scene;
        snapshot.occluders = Occluders::make(scene, 0, nullptr);
        snapshot.bounds.grow(snapshot.occluders->bounds());
    }
};

TEST(Billboard, FindsTheHoleInAWall) {
    const HoleInWall hole;
    const std::vector<BeamCard> cards = place_cards(hole.snapshot, BillboardSettings{});
    ASSERT_FALSE(cards.empty());
    double area = 0;
    for (const BeamCard& card : cards) {
        EXPECT_NEAR(glm::dot(glm::normalize(card.to - card.from), glm::normalize(vec3(1, -1, 0))), 1, 1e-5);
        EXPECT_NEAR(card.from.x, 0, 0.1);
        EXPECT_NEAR(card.from.y, 2, 0.6);
        EXPECT_LT(std::abs(card.from.z), 0.6);
        EXPECT_NEAR(card.to.y, 0, 0.1);
        area += M_PI * card.half_from.x * card.half_from.y;
    }
    // The hole's area across the light is 1 · cos 45°; an ellipse with a rectangle's moments is π/3 larger.
    EXPECT_NEAR(area / std::sqrt(0.5), M_PI / 3, 0.15);
}

TEST(Billboard, ClosedHolesHaveNoCards) {
    HoleInWall hole;
    add_mesh(hole.scene, quad({-0.01f, 1, -1}, {0, 2, 0}, {0, 0, 2}));
    hole.snapshot.occluders = Occluders::make(hole.scene, 0, nullptr);
    EXPECT_TRUE(place_cards(hole.snapshot, BillboardSettings{}).empty());
}

TEST(Billboard, DrawsTheBeamAndNothingBeside) {
    const HoleInWall hole;
    const View view = view_of({2, 1.5f, 7}, {1.5f, 1, 0}, {160, 90});
    const auto at = [&](vec3 target) {
        const Ray ray{view.camera.position, glm::normalize(target - view.camera.position), 12};
        return run_mode("billboard", view, hole.snapshot, {}, {ray})[0];
    };
    const Scatter in = at({1, 1, 0}), beside = at({3.5f, 2.5f, 0});
    EXPECT_GT(in.radiance.x, 0);
    EXPECT_EQ(in.validity, 0);
    EXPECT_EQ(beside.radiance.x, 0);
    EXPECT_LT(beside.transmittance, 1);
    Settings clear;
    clear.of<BillboardSettings>().fog = false;
    const Ray ray{view.camera.position, glm::normalize(vec3(3.5f, 2.5f, 0) - view.camera.position), 12};
    EXPECT_EQ(run_mode("billboard", view, hole.snapshot, clear, {ray})[0].transmittance, 1);
}

TEST(Billboard, IsAboutAsBrightAsTheLightInTheFog) {
    const HoleInWall hole;
    const View view = view_of({2, 1.5f, 7}, {1.5f, 1, 0}, {160, 90});
    const std::vector<Ray> rays = pixel_rays(view, hole.snapshot, 20);
    const double truth = mean_of(marched(hole.snapshot, exact_settings(), rays));
    const double drawn = mean_of(run_mode("billboard", view, hole.snapshot, {}, rays));
    EXPECT_GT(drawn, 0.2 * truth);
    EXPECT_LT(drawn, 2 * truth);
}

// Dots of dust are much smaller than a pixel here, and are enlarged to one.
TEST(Billboard, DustOfAnOrthographicViewIsThatOfAViewFromFarAway) {
    const HoleInWall hole;
    constexpr float height = 2, distance = 1000;
    View view = view_of({1, 1, distance}, {1, 1, 0}, {90, 90}, 2 * std::atan(0.5f * height / distance));
    const auto dust = [&] {
        const std::vector<Ray> rays = pixel_rays(view, hole.snapshot, 2 * distance);
        Settings none;
        none.of<BillboardSettings>().specks = 0;
        std::vector<Scatter> with = run_mode("billboard", view, hole.snapshot, {}, rays);
        const std::vector<Scatter> without = run_mode("billboard", view, hole.snapshot, none, rays);
        for (size_t i = 0; i < with.size(); ++i) with[i].radiance -= without[i].radiance;
        return with;
    };
    const std::vector<Scatter> far = dust();
    view.camera.ortho_height = height;
    EXPECT_GT(mean_of(far), 0);
    EXPECT_LT(relative_rmse(dust(), far), 0.1);
}

TEST(Billboard, DoesNotPopOnAnOrbit) {
    const HoleInWall hole;
    for (const CardFacing facing : {CardFacing::axis, CardFacing::camera, CardFacing::cross}) {
        Settings settings;
        settings.of<BillboardSettings>().facing = facing;
        double before = 0;
        for (int step = 0; step < 40; ++step) {
            const float turn = 0.2f + static_cast<float>(step) * 0.5f * pi / 180;
            const View view =
                view_of(vec3(1.5f, 1.8f, 0) + 6.0f * vec3(std::sin(turn), 0, std::cos(turn)), {1.5f, 1, 0}, {160, 90});
            const double now =
                mean_of(run_mode("billboard", view, hole.snapshot, settings, pixel_rays(view, hole.snapshot, 20)));
            if (step > 0) {
                EXPECT_NEAR(now / before, 1, 0.02) << step << " facing " << static_cast<int>(facing);
            }
            before = now;
        }
    }
}

// Three posts 1 m wide and 4 m high along z on a floor, 2 m apart, and a sun at 45 degrees across them.
struct OpenPosts {
    Scene scene;
    Snapshot snapshot;
    View view = view_of({-5, 1, 9}, {-5, 1, 0}, {160, 90}); // beside all cards
    Ray ray{{-5, 1, 9}, {0, 0, -1}, 18};

    OpenPosts() {
        add_mesh(scene, quad({-10, 0, -10}, {20, 0, 0}, {0, 0, 20}));
        for (const float z : {-3.5f, -0.5f, 2.5f}) add_mesh(scene, quad({0, 0, z}, {0, 4, 0}, {0, 0, 1}));
        snapshot =
            snapshot_of({homogeneous_medium(0.02f, {vec3(-10, 0, -10), vec3(10, 8, 10)})}, {sun_light({1, -1, 0}, 10)});
        snapshot.scene = &scene;
        snapshot.occluders = Occluders::make(scene, 0, nullptr);
        snapshot.bounds.grow(snapshot.occluders->bounds());
    }

    float beside_all_cards(const Settings& settings) const {
        return run_mode("billboard", view, snapshot, settings, {ray})[0].radiance.x;
    }
};

TEST(Billboard, InTheOpenCardsStandInGapsBeforeAVeil) {
    const OpenPosts posts;
    const Snapshot& snapshot = posts.snapshot;
    std::vector<float> open;
    const std::vector<BeamCard> cards = place_cards(snapshot, BillboardSettings{}, &open);
    EXPECT_GT(open[0], 0.3f);
    ASSERT_FALSE(cards.empty());
    // Beams begin in the plane of the posts and end on the floor. Rays some 50 m long are counted in floats.
    const double rounding = 8 * 50 * 0x1p-23;
    for (const BeamCard& card : cards) {
        EXPECT_GT(std::abs(card.from.z), 0.5) << "not between posts";
        EXPECT_LT(std::abs(card.from.z), 2.5) << "not between posts";
        EXPECT_NEAR(card.from.x, 0, rounding);
        EXPECT_NEAR(card.to.y, 0, rounding);
    }
    // Beside all cards a ray still sees fog in the sun, less than if all were lit.
    const float veil = posts.beside_all_cards({});
    const float lit = marched(snapshot, exact_settings(), std::vector{posts.ray})[0].radiance.x;
    EXPECT_GT(veil, 0.1f * lit);
    EXPECT_LT(veil, 0.7f * lit);
}

// Only cards of gaps follow billboard.gaps, only what is beside all cards follows billboard.veil.
TEST(Billboard, GapsAndVeilAreSetApart) {
    const HoleInWall hole;
    Settings settings;
    settings.of<BillboardSettings>().gaps = 7, settings.of<BillboardSettings>().veil = 0;
    const auto expect_tint = [&](const Snapshot& snapshot, float tint) {
        const std::vector<BeamCard> cards = place_cards(snapshot, settings.of<BillboardSettings>());
        EXPECT_FALSE(cards.empty());
        for (const BeamCard& card : cards) EXPECT_EQ(card.tint, vec3(tint));
    };
    expect_tint(hole.snapshot, 1);
    const OpenPosts posts;
    expect_tint(posts.snapshot, 7);
    EXPECT_EQ(posts.beside_all_cards(settings), 0);
    settings.of<BillboardSettings>().veil = 0.25f;
    const float quarter = posts.beside_all_cards(settings);
    settings.of<BillboardSettings>().veil = 0.5f;
    EXPECT_NEAR(posts.beside_all_cards(settings) / quarter, 2, 1e-5);
}

TEST(Billboard, SpotsWithNothingBeforeThemHaveOneCard) {
    HoleInWall hole;
    Light lamp = spot_light({3, 4, 0}, {0, -1, 0}, 50, 0.1f, 0.2f);
    hole.snapshot.lights = {lamp};
    const std::vector<BeamCard> cards = place_cards(hole.snapshot, BillboardSettings{});
    ASSERT_EQ(cards.size(), 1u);
    EXPECT_NEAR(cards[0].to.y, 0, 0.15);
    EXPECT_NEAR(cards[0].half_to.x, 4 * std::tan(0.17f), 0.05);
}

TEST(Billboard, HandPlacedCardsAreDrawn) {
    HoleInWall hole;
    Billboard card;
    card.name = "by hand", card.light = "sun", card.from = {4, 5, 0}, card.to = {4, 1, 0};
    card.width_from = card.width_to = 1, card.tint = vec3(1, 0.5f, 0), card.intensity = 2;
    hole.scene.billboards = {card};
    Settings settings;
    settings.of<BillboardSettings>().cards = 0, settings.of<BillboardSettings>().streaks = 0,
    settings.of<BillboardSettings>().specks = 0;
    const View view = view_of({4, 3, 7}, {4, 3, 0}, {160, 90});
    const Ray ray{{4, 3, 7}, {0, 0, -1}, 20};
    const vec3 light = run_mode("billboard", view, hole.snapshot, settings, {ray})[0].radiance;
    EXPECT_GT(light.x, 0);
    EXPECT_NEAR(light.y / light.x, 0.5, 1e-5);
    EXPECT_EQ(light.z, 0);
    // It fades out before a surface: soft_depth is 0.4 m.
    const Ray blocked{{4, 3, 7}, {0, 0, -1}, 7.02f};
    EXPECT_LT(run_mode("billboard", view, hole.snapshot, settings, {blocked})[0].radiance.x, 0.05f * light.x);
}

TEST(Billboard, NamesItsLimitations) {
    const HoleInWall hole;
    const Mode& mode = find_mode("billboard");
    EXPECT_TRUE(has_limitation(mode.limitations(view_of({1, 1, 0}, {3, 1, 0}, {160, 90}), hole.snapshot, {}),
                               limitation::camera_in_card));
    Snapshot open = snapshot_of({homogeneous_medium(0.2f)}, {sun_light({0, -1, 0})});
    EXPECT_TRUE(has_limitation(mode.limitations({}, open, {}), limitation::no_opening));
}
}
}
