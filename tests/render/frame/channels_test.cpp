// Fog that dims red, green and blue differently, against closed forms and against gray fog of each channel's
// extinction.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/scratch.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const vec3 extinction(1.5f, 0.5f, 0.125f);

std::string text(vec3 v) {
    return "[" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + "]";
}

// A box of fog 2 m thick, lit by a sun, before a background.
std::string scene_text(const std::string& fog, const std::string& more = {}) {
    return R"({"tyndall": 1, "camera": {"position": [0, 0, 3], "target": [0, 0, 0], "vertical_fov": 20},
        "lights": [{"name": "sun", "type": "sun", "direction": [0, -1, 0], "intensity": 3}], "ambient": [0.1, 0.2, 0.3],
        "media": [{"type": "homogeneous", "extinction": )" +
           fog + R"(, "albedo": 0.8, "g": 0.3, "bounds": {"low": [-5, -1, -1], "high": [5, 1, 1]}}],
        "background": {"color": [1, 0.5, 2]})" +
           more + "}";
}

struct Seen {
    Scene scene;
    Snapshot snapshot;
    Layers layers;
};

void see(const std::string& text, std::string_view mode, Seen& seen, bool background = true, int samples = 2) {
    const TempFolder folder;
    seen.scene = load_scene(folder.put("scene.json", text));
    seen.snapshot = make_snapshot(seen.scene, moment_of(seen.scene, 1));
    View view = plain_view({8, 8}, samples);
    view.camera = camera_at(seen.scene, 0, 0);
    view.background = background, view.fog_parts = true;
    FrameStats stats;
    seen.layers = render_frame(find_mode(mode), view, seen.snapshot, settings_for(Quality::preview), {}, stats);
}

// Of 16 pixels around the middle, whose rays are 2 m long in the fog within .5 %.
vec3 mean_background(const Layers& layers) {
    vec3 sum(0);
    for (int y = 2; y < 6; ++y)
        for (int x = 2; x < 6; ++x) sum += layers.background.at(x, y);
    return sum / 16.0f;
}

const vec3 through = glm::exp(-2.0f * extinction), behind(1, 0.5f, 2);

TEST(Channels, ABackgroundComesThroughByItsColor) {
    Seen seen;
    see(scene_text(text(extinction)), "march", seen);
    ASSERT_TRUE(is_chromatic(seen.snapshot));
    expect_near(mean_background(seen.layers) / (through * behind), vec3(1), 0.02f);
    EXPECT_NEAR(seen.layers.transmittance.at(4, 4), mean_component(through), 0.005f);
}

TEST(Channels, EachHasItsTransmittanceWhoseMeanIsThatOfAll) {
    for (const char* mode : {"march", "path", "froxel"}) {
        Seen seen;
        see(scene_text(text(extinction)), mode, seen, true, 64);
        vec3 sum(0);
        for (size_t i = 0; i < seen.layers.transmittance.pixels.size(); ++i)
            EXPECT_NEAR(mean_component(seen.layers.channel_transmittance.pixels[i]),
                        seen.layers.transmittance.pixels[i], 1e-6f);
        for (int y = 2; y < 6; ++y)
            for (int x = 2; x < 6; ++x) sum += seen.layers.channel_transmittance.at(x, y) / 16.0f;
        const bool noisy = mode == std::string_view("path");                 // a sample comes through or does not
        const float slices = mode == std::string_view("froxel") ? 0.04f : 0; // its slices cut the edges of the box
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], through[c],
                        0.005f + slices + (noisy ? 4.5f * std::sqrt((1 - through[c]) * through[c] / 1024) : 0))
                << mode;
    }
    Seen gray;
    see(scene_text("0.5"), "march", gray);
    EXPECT_TRUE(gray.layers.channel_transmittance.empty());
}

// A sample comes through or does not.
TEST(Channels, ABackgroundComesThroughPathsByItsColor) {
    constexpr int samples = 256;
    Seen seen;
    see(scene_text(text(extinction)), "path", seen, true, samples);
    const vec3 ratio = mean_background(seen.layers) / (through * behind);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(ratio[c], 1, 4.5f * std::sqrt((1 - through[c]) / through[c] / (16 * samples)) + 0.015f);
}

TEST(Channels, AlphaIsOneMinusTheMean) {
    Seen seen;
    see(scene_text(text(extinction)), "march", seen, false);
    EXPECT_NEAR(seen.layers.alpha.at(4, 4), 1 - mean_component(glm::exp(-2.0f * extinction)), 0.005f);
}

// Each channel is what gray fog would show; paths trace extinctions that are far apart one by one.
TEST(Channels, EachIsThatOfGrayFog) {
    for (const Mode& mode : modes()) {
        if (mode.surfaces == Surfaces::post) continue;
        const vec3 each = mode.traces_channels ? vec3(4, 0.5f, 0.125f) : extinction;
        Seen all;
        see(scene_text(text(each)), mode.name, all);
        for (int c = 0; c < 3; ++c) {
            Seen gray;
            see(scene_text(std::to_string(each[c])), mode.name, gray);
            EXPECT_FALSE(is_chromatic(gray.snapshot));
            for (size_t i = 0; i < all.layers.color.pixels.size(); ++i) {
                EXPECT_NEAR(all.layers.inscatter.pixels[i][c], gray.layers.inscatter.pixels[i][c], 1e-6f) << mode.name;
                EXPECT_NEAR(all.layers.ambient.pixels[i][c], gray.layers.ambient.pixels[i][c], 1e-6f) << mode.name;
                EXPECT_NEAR(all.layers.background.pixels[i][c], gray.layers.background.pixels[i][c], 1e-6f)
                    << mode.name;
            }
        }
    }
}

// Clouds in chromatic haze over ground, under a sky, a lamp and the sun: paths that follow any channel, weighted, add
// up to those of each. Differences of pixels are independent, with the same error.
TEST(Channels, TracedTogetherAddUpToThoseOfGrayFog) {
    constexpr int samples = 512;
    const auto scene_of = [](const std::string& haze, const std::string& cloud) {
        return R"({"tyndall": 1, "camera": {"position": [0, 1, 6], "target": [0, 0.6, 0], "vertical_fov": 40},
            "lights": [{"type": "sun", "direction": [-1, -2, -1], "intensity": 3},
                       {"type": "point", "position": [1, 1.5, 1], "intensity": 4},
                       {"type": "environment", "intensity": 1}],
            "background": {"color": [0.2, 0.3, 0.5]},
            "media": [{"type": "homogeneous", "extinction": )" +
               haze + R"(, "albedo": [0.9, 0.8, 0.7], "g": 0.5, "emission": [0.02, 0.01, 0.03],
                       "bounds": {"low": [-3, -1, -3], "high": [3, 2, 3]}},
                      {"type": "noise", "recipe": "cloud.json", "extinction": )" +
               cloud + R"(, "albedo": 0.9}]})";
    };
    const TempFolder folder;
    folder.put("cloud.json", R"({"bounds": {"low": [-1, 0, -1], "high": [1, 1, 1]}, "voxel_size": 0.1,
        "noise": {"scale": 0.5, "octaves": 2, "seed": 3}, "density": {"threshold": 0.3, "gain": 2}})");
    const auto rendered = [&](const std::string& text, int seed) {
        const Scene scene = load_scene(folder.put("scene.json", text));
        const Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
        View view = plain_view({16, 8}, samples);
        view.camera = camera_at(scene, 0, 0);
        view.seed = static_cast<uint32_t>(seed);
        FrameStats stats;
        return render_frame(find_mode("path"), view, snapshot, settings_for(Quality::preview), {}, stats);
    };
    const vec3 thin(0.9f, 0.3f, 0.05f), thick(6, 3, 1);
    const Layers all = rendered(scene_of(text(thin), text(thick)), 1);
    for (int c = 0; c < 3; ++c) {
        const Layers gray = rendered(scene_of(std::to_string(thin[c]), std::to_string(thick[c])), 2 + c);
        double sum = 0, squares = 0, mean = 0;
        const size_t count = all.color.pixels.size();
        for (size_t i = 0; i < count; ++i) {
            const double d = double{all.color.pixels[i][c]} - gray.color.pixels[i][c];
            sum += d, squares += d * d, mean += gray.color.pixels[i][c];
        }
        EXPECT_LT(std::abs(sum), 4.5 * std::sqrt(squares)) << c;
        EXPECT_LT(std::sqrt(squares), 0.01 * mean) << "precise enough to tell";
    }
}

TEST(Channels, ThatFogDoesNotDimStayClear) {
    Seen seen;
    see(scene_text("[0.7, 0, 0]"), "march", seen);
    for (const vec3& pixel : seen.layers.background.pixels) {
        EXPECT_EQ(pixel.y, 0.5f);
        EXPECT_EQ(pixel.z, 2);
        EXPECT_LT(pixel.x, 0.3f);
    }
    for (const vec3& pixel : seen.layers.inscatter.pixels) expect_near(pixel * vec3(0, 1, 1), vec3(0), 1e-12f);
}

TEST(Channels, OfEqualExtinctionAreGray) {
    Seen color, number;
    see(scene_text("[0.4, 0.4, 0.4]"), "march", color);
    see(scene_text("0.4"), "march", number);
    EXPECT_FALSE(is_chromatic(color.snapshot));
    EXPECT_TRUE(same_bits(color.layers.color, number.layers.color));
}

// A white plane 4 m deep in the fog, lit along the way that the eye looks.
TEST(Channels, SurfacesAreLitThroughTheFog) {
    Scene scene;
    add_plane(scene, -4, 50, vec3(0));
    scene.materials.back().base_color = vec3(1);
    Snapshot snapshot = snapshot_of(scene);
    snapshot.lights = {sun_light({0, 0, -1}, 2)};
    snapshot.media = {homogeneous_medium(mean_component(extinction), {vec3(-50, -50, -9), vec3(50, 50, 0)})};
    snapshot.media[0].optics.channels = extinction / mean_component(extinction);
    View view = plain_view({8, 8}, 1, 2.0f);
    view.surface_parts = true;
    FrameStats stats;
    const Layers layers = render_frame(find_mode("march"), view, snapshot, settings_for(Quality::preview), {}, stats);
    const vec3 lit = 2 / pi * glm::exp(-8.0f * extinction);
    for (const vec3& pixel : layers.surface.pixels) expect_near(pixel / lit, vec3(1), 2e-3f);
}
}
}
