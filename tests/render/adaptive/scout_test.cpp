// The first look at an image: one pixel of four.
#include "base/clock.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/scout.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box room{vec3(-4), vec3(4)};
constexpr ivec2 size{37, 23};

View view_of() {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = size, view.pixel_samples = 1;
    return view;
}

// A thin sheet of fog on one side of the image, without noise but at its edge.
Snapshot half_filled() {
    return snapshot_of({homogeneous_medium(0.1f, {vec3(-20, -20, -4), vec3(0.013f, 20, -3.9f)})},
                       {sun_light({0, -0.2f, -1})});
}

std::shared_ptr<const Scout> scout_of(const View& view, const Snapshot& snapshot) {
    return make_scout(main_mode(), view, snapshot, {"", settings_for(Quality::draft)}, {}, steady_seconds);
}
}

TEST(Scout, TracesOnePixelOfFourThatStandsForAll) {
    View view = view_of();
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light({0.3f, -0.7f, 0})});
    const auto whole = scout_of(view, snapshot);
    EXPECT_EQ(whole->stats.camera_rays, 19u * 12 * scout_samples);
    EXPECT_GT(whole->ray_cost(), ray_work);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            EXPECT_EQ(whole->layers.inscatter.at(x, y), whole->layers.inscatter.at(x / 2 * 2, y / 2 * 2));
            EXPECT_GT(whole->layers.inscatter.at(x, y).x, 0) << x << " " << y;
        }

    view.crop_low = {5, 3}, view.crop_high = {30, 21};
    const auto part = scout_of(view, snapshot);
    EXPECT_EQ(part->stats.camera_rays, 13u * 10 * scout_samples) << "also of those that the crop cuts";
    for (const vec3& light : part->layers.inscatter.pixels) EXPECT_GT(light.x, 0);
}

// Where an edge passes between the pixels that are traced, their samples do not differ.
TEST(Scout, ExpectsNoiseInEveryTileAlongAnEdge) {
    const View view = view_of();
    const auto scout = scout_of(view, half_filled());
    const int edge = static_cast<int>(size.x / 2);
    float most = 0, least = infinity;
    for (int y = 0; y < size.y; ++y) {
        float row = 0;
        for (int x = edge - 2; x <= edge + 2; ++x) row = std::max(row, scout->layers.inscatter_variance.at(x, y).x);
        most = std::max(most, row), least = std::min(least, row);
        EXPECT_LT(scout->layers.inscatter_variance.at(2, y).x, 0.1f * row);
    }
    EXPECT_GT(least, 0.02f * most);
}
}
