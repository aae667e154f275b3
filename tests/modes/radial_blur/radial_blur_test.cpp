// The radial blur: what it must leave alone, how it fades, and that its sum does not depend on how many samples it has.
#include "modes/mode.h"
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

View view_towards(vec3 direction, ivec2 size = {160, 90}) {
    View view;
    view.camera = look_at(vec3(0), direction, vec3(0, 1, 0), 0.8f);
    view.size = size;
    return view;
}

PostOutput blur(const View& view, const Snapshot& snapshot, const Settings& settings, vec3 color = vec3(0)) {
    const Image<vec3> colors(view.size, color);
    const Image<float> alpha(view.size, 0.0f), depth(view.size, infinity);
    return find_mode("radial-blur").prepare_post(view, snapshot, settings)({colors, alpha, depth});
}

double mean(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3 pixel : image.pixels) sum += luminance(pixel);
    return sum / static_cast<double>(image.pixels.size());
}

// A sun at an angle to the right of a camera that looks along -z.
Snapshot sun_at(float angle) {
    return snapshot_of({homogeneous_medium(0.1f, Box{vec3(-50), vec3(50)})},
                       {sun_light(-vec3(std::sin(angle), 0, -std::cos(angle)))});
}

TEST(RadialBlur, LeavesThePictureAloneWhenTheLightIsBehind) {
    const View view = view_towards({0, 0, -1});
    for (const float angle : {1.5708f, 1.7f, 2.5f, 3.14159f}) {
        const PostOutput addition = blur(view, sun_at(angle), Settings{}, vec3(5));
        for (const vec3 pixel : addition.radiance.pixels) ASSERT_EQ(pixel, vec3(0)) << angle;
        for (const float valid : addition.validity.pixels) ASSERT_EQ(valid, 1) << angle;
    }
    // A lamp behind, and one at the eye.
    for (const vec3 place : {vec3(0, 0, 3), vec3(0)}) {
        const Snapshot lamp = snapshot_of({homogeneous_medium(0.1f)}, {point_light(place)});
        EXPECT_EQ(mean(blur(view, lamp, Settings{}).radiance), 0);
    }
}

TEST(RadialBlur, FadesMonotonouslyAsTheLightLeaves) {
    const View view = view_towards({0, 0, -1});
    for (const BlurSource source : {BlurSource::occlusion, BlurSource::highlights}) {
        Settings settings;
        settings.of<RadialBlurSettings>().source = source, settings.of<RadialBlurSettings>().threshold = 0.5f;
        double before = infinity;
        const float edge = std::atan(std::tan(0.4f) * 16 / 9); // of the picture
        for (float angle = edge; angle < 1.55f; angle += 0.02f) {
            const double now = mean(blur(view, sun_at(angle), settings, vec3(2)).radiance);
            ASSERT_LE(now, before * (1 + 1e-5)) << angle;
            before = now;
        }
        EXPECT_EQ(before, 0);
        EXPECT_GT(mean(blur(view, sun_at(0.3f), settings, vec3(2)).radiance), 0.01);
    }
}

TEST(RadialBlur, ItsBrightnessDoesNotDependOnTheNumberOfSamples) {
    const View view = view_towards({0, 0, -1});
    for (const float decay : {0.9f, 0.97f, 1.0f}) {
        Settings settings;
        settings.of<RadialBlurSettings>().decay = decay, settings.of<RadialBlurSettings>().size = 0.3f;
        settings.of<RadialBlurSettings>().samples = 32;
        const double few = mean(blur(view, sun_at(0.2f), settings).radiance);
        settings.of<RadialBlurSettings>().samples = 256;
        const double many = mean(blur(view, sun_at(0.2f), settings).radiance);
        EXPECT_NEAR(many / few, 1, 0.01) << decay;
    }
}

// On even brightness the blur is exposure · weight · Σ decay^i / 32 with i from 0 to 31.
TEST(RadialBlur, SumsAsPublished) {
    const View view = view_towards({0, 0, -1}, {64, 64});
    Settings settings;
    RadialBlurSettings& blur_settings = settings.of<RadialBlurSettings>();
    blur_settings.source = BlurSource::highlights, blur_settings.threshold = 0;
    blur_settings.decay = 0.9f, blur_settings.weight = 2, blur_settings.exposure = 0.5f;
    blur_settings.resolution = Resolution::full;
    double sum = 0;
    for (int i = 0; i < 32; ++i) sum += std::pow(0.9, i) / 32;
    for (const int samples : {32, 7, 100}) {
        blur_settings.samples = samples;
        const PostOutput addition = blur(view, sun_at(0), settings, vec3(3));
        EXPECT_NEAR(addition.radiance.at(32, 32).x, 3 * sum, 3 * sum * 1e-5) << samples;
        EXPECT_NEAR(addition.radiance.at(10, 50).x, 3 * sum, 3 * sum * 1e-5) << samples;
    }
}

// Nothing of highlights below the threshold, and only what is above it.
TEST(RadialBlur, TakesHighlightsAboveTheThreshold) {
    const View view = view_towards({0, 0, -1}, {32, 32});
    Settings settings;
    settings.of<RadialBlurSettings>().source = BlurSource::highlights, settings.of<RadialBlurSettings>().threshold = 2;
    EXPECT_EQ(mean(blur(view, sun_at(0), settings, vec3(2)).radiance), 0);
    const double above = mean(blur(view, sun_at(0), settings, vec3(4)).radiance);
    settings.of<RadialBlurSettings>().threshold = 0;
    EXPECT_NEAR(above / mean(blur(view, sun_at(0), settings, vec3(4)).radiance), 0.5, 1e-5);
}

// Pixels as far from the light have the same rays in any direction, whatever the shape of the picture.
TEST(RadialBlur, ItsDiscIsRound) {
    for (const ivec2 size : {ivec2(200, 100), ivec2(100, 200), ivec2(150, 150)}) {
        const View view = view_towards({0, 0, -1}, size);
        Settings settings;
        settings.of<RadialBlurSettings>().size = 0.4f, settings.of<RadialBlurSettings>().resolution = Resolution::full;
        settings.of<RadialBlurSettings>().samples = 256;
        View still = view;
        still.jitter = Jitter::none;
        const PostOutput addition = blur(still, sun_at(0), settings);
        const auto at = [&](int x, int y) { return addition.radiance.at(size.x / 2 + x, size.y / 2 + y).x; };
        for (const int r : {5, 15, 30}) {
            EXPECT_NEAR(at(r, 0) / at(0, r), 1, 0.01) << size.x << " " << r;
            EXPECT_NEAR(at(-r - 1, 0) / at(r, 0), 1, 1e-3) << size.x << " " << r;
        }
    }
}

TEST(RadialBlur, LightsAddUp) {
    View view = view_towards({0, 0, -1}, {48, 27});
    view.fog_parts = true;
    const Snapshot both =
        snapshot_of({homogeneous_medium(0.1f)}, {sun_light({0.1f, 0, 1}), point_light({0.5f, 0.2f, -4}, 30)});
    const PostOutput addition = blur(view, both, Settings{});
    ASSERT_EQ(addition.per_light.size(), 2u);
    for (size_t i = 0; i < addition.radiance.pixels.size(); ++i) {
        const vec3 sum = addition.per_light[0].pixels[i] + addition.per_light[1].pixels[i];
        ASSERT_NEAR(sum.x, addition.radiance.pixels[i].x, 1e-5f * (1 + sum.x));
    }
    EXPECT_GT(mean(addition.per_light[0]), 0);
    EXPECT_GT(mean(addition.per_light[1]), 0);
}

TEST(RadialBlur, SaysWhichLightsMakeNoRays) {
    const View view = view_towards({0, 0, -1});
    const auto worst = [&](float angle) {
        Severity severity = Severity::info;
        for (const Limitation& one : find_mode("radial-blur").limitations(view, sun_at(angle), Settings{}))
            if (one.subject == Subject::light && one.name == "sun") severity = std::max(severity, one.severity);
        return severity;
    };
    EXPECT_EQ(worst(0.1f), Severity::info);
    EXPECT_EQ(worst(0.8f), Severity::degraded);
    EXPECT_EQ(worst(3), Severity::wrong);
}
}
}
