// Motion blur against closed forms, and against the mean of stills.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "render/sequence/job.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "trace/shutter_motion.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tyndall::test {
namespace {
constexpr int moments = 16;

View open_view(ivec2 size, int samples, int count = moments) {
    View view = plain_view(size, samples, 2);
    auto shutter = std::make_shared<OpenShutter>();
    shutter->cameras.resize(static_cast<size_t>(count), view.camera);
    view.shutter = shutter;
    return view;
}

TEST(ShutterMoments, ManySamplesOfAPixelShowEachAsOften) {
    const View view = open_view({8, 8}, 3 * moments);
    View batched = view;
    batched.batches = 3;
    for (const ivec2 pixel : {ivec2(0, 0), ivec2(5, 2)}) {
        std::map<int, int> seen;
        for (int s = 0; s < view.pixel_samples; ++s) ++seen[moment_at(batched, pixel, s)];
        ASSERT_EQ(seen.size(), moments);
        for (const auto& [moment, times] : seen) EXPECT_EQ(times, 3) << moment;
    }
}

TEST(ShutterMoments, FewSamplesAreSpreadOverNeighbors) {
    for (const int samples : {1, 2, 4}) {
        const View view = open_view({8, 8}, samples);
        for (int y = 0; y < 8; y += 2)
            for (int x = 0; x < 8; x += 2) {
                std::map<int, int> strata; // of as many as the four pixels have samples
                for (int i = 0; i < 4 * samples; ++i)
                    ++strata[moment_at(view, {x + i % 2, y + i / 2 % 2}, i / 4) * 4 * samples / moments];
                EXPECT_EQ(strata.size(), static_cast<size_t>(4 * samples));
            }
        std::set<int> in_tile;
        for (int i = 0; i < 16; ++i) in_tile.insert(moment_at(view, {i % 4, i / 4}, 0));
        EXPECT_EQ(in_tile.size(), 4u); // rays of a tile still go together
    }
}

TEST(ShutterMoments, ManySamplesOfATileGoTogether) {
    const View view = open_view({8, 8}, moments);
    for (int s = 0; s < moments; ++s)
        for (int i = 0; i < 16; ++i) EXPECT_EQ(moment_at(view, {i % 4, i / 4}, s), moment_at(view, {0, 0}, s));
}

// A plate of 0.5 m that moves 0.4 m during the exposure, seen by an orthographic camera 2 m high and wide.
struct Moving {
    Scene scene;
    RenderRequest request;
};
constexpr float half = 0.25f, way = 0.4f;

Keyed<vec3> straight(vec3 first, vec3 last) {
    Keyed<vec3> place;
    place.times = {0, 1}, place.values = {first, last};
    return place;
}

void put(Moving& moving, bool plate_moves) {
    Scene& scene = moving.scene;
    scene.frame_rate = 1, scene.resolution = {64, 64};
    add_plane(scene, -2, half, vec3(4, 2, 1));
    CameraSource camera;
    camera.name = "camera", camera.ortho_height = 2, camera.shutter = {0, 1, {}};
    const vec3 left(-way / 2, 0, 0), right(way / 2, 0, 0), ahead(0, 0, -1);
    if (plate_moves) {
        Node node;
        node.translation = straight(left, right);
        scene.nodes.push_back(node), scene.instances[0].node = 0;
        camera.position = vec3(0), camera.target = ahead;
    } else {
        camera.position = straight(right, left), camera.target = straight(right + ahead, left + ahead);
    }
    scene.cameras.push_back(camera);
    moving.request.settings.pixel.filter = PixelFilter::box;
    moving.request.settings.pixel.filter_radius = 0.5f, moving.request.settings.pixel.samples = 64;
}

Layers rendered(const Scene& scene, const RenderRequest& request, const char* mode = "march",
                FrameStats* of = nullptr) {
    const Snapshot snapshot = make_snapshot(scene, moments_of(scene, request, 0));
    View view = view_of(scene, request, request.settings, 0);
    FrameStats stats;
    const Layers layers = render_frame(find_mode(mode), view, snapshot, request.settings, {}, stats);
    if (of) *of = stats;
    return layers;
}

// Share of the time that the plate's part of a column takes: a trapezoid, as wide as plate and way together.
float covered(float x) {
    const float low = std::max(x - half, -way / 2), high = std::min(x + half, way / 2);
    return std::max(high - low, 0.0f) / way;
}

class ShutterFrame : public testing::TestWithParam<bool> {};

TEST_P(ShutterFrame, ConstantVelocityBlursToATrapezoid) {
    Moving moving;
    put(moving, GetParam());
    moving.request.time_samples = 64;
    FrameStats stats;
    for (const char* mode : {"march", "path"}) {
        SCOPED_TRACE(mode);
        const Layers layers = rendered(moving.scene, moving.request, mode, &stats);
        EXPECT_EQ(stats.moments, 64);
        for (int x = 0; x < 64; ++x) {
            const float at = (static_cast<float>(x) + 0.5f) / 32 - 1;
            // Moments are a share of 1/64 apart; a pixel is wider than the way between two of them.
            expect_near(layers.color.at(x, 32), covered(at) * vec3(4, 2, 1), 4 * 0.04f);
            EXPECT_NEAR(layers.alpha.at(x, 32), covered(at), 0.04f) << x;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Moves, ShutterFrame, testing::Bool(),
                         [](const auto& one) { return one.param ? "Plate" : "Camera"; });

TEST(ShutterDepth, IsThatOfTheMiddle) {
    Moving moving;
    put(moving, true);
    const Layers layers = rendered(moving.scene, moving.request);
    for (int x = 0; x < 64; ++x) {
        const bool on_plate = std::abs((static_cast<float>(x) + 0.5f) / 32 - 1) < half;
        if (on_plate)
            EXPECT_NEAR(layers.depth.at(x, 32), 2, 1e-5f) << x;
        else
            EXPECT_EQ(layers.depth.at(x, 32), infinity) << x;
    }
}

TEST(ShutterDepth, AClosedShutterIsAStill) {
    Moving moving;
    put(moving, true);
    moving.request.shutter = Shutter{};
    EXPECT_EQ(view_of(moving.scene, moving.request, moving.request.settings, 0).shutter, nullptr);
    const Layers closed = rendered(moving.scene, moving.request);
    moving.request.shutter.reset(), moving.scene.cameras[0].shutter = {};
    EXPECT_TRUE(same_bits(rendered(moving.scene, moving.request).color, closed.color));
}

// A lamp that moves through fog, with a second one that shines only at the end.
void add_lamps(Moving& moving) {
    Scene& scene = moving.scene;
    scene.resolution = {16, 12};
    LightSource lamp;
    lamp.name = "moving", lamp.intensity = 3, lamp.position = straight({-0.6f, 0.5f, -1.2f}, {0.6f, 0.5f, -1.2f});
    scene.lights.push_back(lamp);
    lamp.name = "flash", lamp.position = vec3(0, -0.7f, -1);
    lamp.intensity.times = {0.5f, 1}, lamp.intensity.values = {0, 5};
    scene.lights.push_back(lamp);
    MediumSource fog;
    fog.extinction = 0.3f, fog.bounds = {vec3(-2, -2, -3), vec3(2, 2, -0.5f)};
    scene.media.push_back(fog);
}

// Of as many stills, each of which shows all of the fog that its moment has.
Layers mean_of_stills(const Moving& moving, const char* mode) {
    const FrameMoments frame = moments_of(moving.scene, moving.request, 0);
    const RenderRequest& request = moving.request;
    Layers mean;
    for (size_t i = 0; i < frame.moments.size(); ++i) {
        const Snapshot snapshot = make_snapshot(moving.scene, frame.moments[i]);
        View view = view_of(moving.scene, request, request.settings, 0);
        view.camera = view.shutter->cameras[i], view.shutter = nullptr, view.seed = static_cast<uint32_t>(100 + i);
        FrameStats stats;
        const Layers still = render_frame(find_mode(mode), view, snapshot, request.settings, {}, stats);
        if (i == 0)
            mean = still;
        else
            blend_layers(mean, still, 1 / static_cast<float>(i + 1));
    }
    return mean;
}

TEST(ShutterFog, IsTheMeanOfItsMoments) {
    Moving moving;
    put(moving, true), add_lamps(moving);
    moving.request.time_samples = 8;
    Settings& settings = moving.request.settings;
    settings.pixel.samples = 8, settings.pixel.filter = PixelFilter::center; // each moment once, at the same places
    settings.terms.emission = false; // what fog scatters of the plate's is found by chance
    for (const char* mode : {"march", "froxel", "shadow-volume", "cone"}) {
        SCOPED_TRACE(mode);
        const Layers blurred = rendered(moving.scene, moving.request, mode), mean = mean_of_stills(moving, mode);
        double squares = 0, sum = 0;
        for (size_t i = 0; i < mean.inscatter.pixels.size(); ++i) {
            const double difference = luminance(blurred.inscatter.pixels[i] - mean.inscatter.pixels[i]);
            squares += difference * difference, sum += luminance(mean.inscatter.pixels[i]);
        }
        const double count = static_cast<double>(mean.inscatter.pixels.size());
        EXPECT_GT(sum, 0);
        EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.01); // jitter of steps
    }
}

// Of the fog's light over the image, and its standard error.
std::pair<double, double> mean_light(const Layers& layers) {
    double sum = 0, variance = 0;
    for (size_t i = 0; i < layers.inscatter.pixels.size(); ++i) {
        sum += double{layers.inscatter.pixels[i].x};
        if (!layers.inscatter_variance.empty()) variance += double{layers.inscatter_variance.pixels[i].x};
    }
    const double count = static_cast<double>(layers.inscatter.pixels.size());
    return {sum / count, std::sqrt(variance) / count};
}

TEST(ShutterFog, MarchAgreesWithPath) {
    Moving moving;
    put(moving, true), add_lamps(moving);
    moving.scene.materials[0].emission = vec3(0); // in path it lights the fog
    moving.request.time_samples = 32;
    moving.request.exr.layers = {"variance"};
    Settings& settings = moving.request.settings;
    settings.path.orders = settings.fluence.orders = 1;
    settings.pixel.samples = 64;
    const auto [marched, march_error] = mean_light(rendered(moving.scene, moving.request, "march"));
    settings.pixel.samples = 1024;
    const auto [traced, path_error] = mean_light(rendered(moving.scene, moving.request, "path"));
    EXPECT_LT(path_error, 0.02 * traced);
    EXPECT_NEAR(marched, traced, 3.5 * std::hypot(path_error, march_error));
}

TEST(ShutterFog, LightsHaveLayersOfTheirOwnWhateverTheMoment) {
    Moving moving;
    put(moving, true), add_lamps(moving);
    moving.request.time_samples = 4;
    moving.request.exr.layers = {"lights"};
    for (const char* mode : {"march", "path"}) {
        const Layers layers = rendered(moving.scene, moving.request, mode);
        ASSERT_EQ(layers.lights.size(), 2u);
        EXPECT_EQ(layers.lights[1].first, "flash");
        double flash = 0;
        for (size_t i = 0; i < layers.inscatter.pixels.size(); ++i) {
            vec3 sum = layers.ambient.pixels[i] + layers.emission.pixels[i] + layers.multiple.pixels[i];
            for (const auto& [name, image] : layers.lights) sum += image.pixels[i];
            expect_near(sum, layers.inscatter.pixels[i], 1e-4f);
            flash += luminance(layers.lights[1].second.pixels[i]);
        }
        EXPECT_GT(flash, 0);
    }
}

TEST(UsualMoments, FollowTheMotionOnThePicture) {
    Moving moving;
    put(moving, true);
    const Shutter shutter = moving.scene.cameras[0].shutter;
    // 0.4 m are a fifth of the picture.
    for (const auto& [side, count] : {std::pair{10, 4}, {40, 16}, {100, 32}, {400, 128}, {4000, max_auto_moments}}) {
        EXPECT_NEAR(image_motion(moving.scene, 0, ivec2(side), 0, shutter), 0.2f * static_cast<float>(side),
                    0.01f * static_cast<float>(side));
        EXPECT_EQ(auto_moments(moving.scene, 0, ivec2(side), 0, shutter), count) << side;
    }
}

// Ripple of a comb of thin lines so many pixels apart, seen through the filter: RMS by the mean.
double ripple(PixelFilter filter, float radius, double apart) {
    double sum = 0, squares = 0;
    constexpr int places = 500;
    for (int i = 0; i < places; ++i) {
        double light = 0;
        for (int line = -20; line <= 20; ++line) {
            const double away = (i / double{places} + line) * apart / double{radius};
            if (std::abs(away) < 1) light += double{filter_density(filter, {static_cast<float>(away), 0.0f})};
        }
        sum += light, squares += light * light;
    }
    const double mean = sum / places;
    return std::sqrt(std::max(squares / places - mean * mean, 0.0)) / mean;
}

TEST(UsualMoments, ThinLinesShowAsOne) {
    EXPECT_LT(ripple(PixelFilter::blackman_harris, 1, 0.75), 0.07) << "the usual distance";
    EXPECT_GT(ripple(PixelFilter::blackman_harris, 1, 1.5), 0.5);
}

TEST(UsualMoments, MemoryBoundsThem) {
    Moving moving;
    put(moving, false); // a camera that moves: what is kept of lights is made anew
    const Shutter shutter = moving.scene.cameras[0].shutter;
    const auto count = [&](size_t lights, bool keeps_images, int finer = 1) {
        moving.scene.lights.resize(lights);
        return auto_moments(moving.scene, 0, ivec2(4000), 0, shutter, keeps_images, finer);
    };
    EXPECT_EQ(count(1, false), max_auto_moments);
    EXPECT_EQ(count(1, true), 16); // 0.53 GB each
    MediumSource fog;
    fog.kind = MediumKind::vdb;
    moving.scene.media.push_back(fog);
    EXPECT_EQ(count(1, false), max_auto_moments); // 8 MiB
    EXPECT_EQ(count(3, false), 256);
    EXPECT_EQ(count(24, false), 32);
    EXPECT_EQ(count(24, false, 2), 32);
    EXPECT_EQ(count(24, true), 4); // however much that is
    for (LightSource& light : moving.scene.lights) light.kind = LightKind::spot, light.outer_cone = 0.05f;
    EXPECT_EQ(count(24, true), 8); // 0.8 GB: beams are seen in a twentieth of the picture
}

TEST(UsualMoments, ShadowVolumesBoundThem) {
    Moving moving;
    put(moving, false);
    moving.scene.lights.resize(24);
    const auto count = [&](size_t triangles) {
        moving.scene.meshes[0].triangles.resize(triangles);
        return auto_moments(moving.scene, 0, ivec2(4000), 0, moving.scene.cameras[0].shutter, false, 1);
    };
    EXPECT_EQ(count(100), max_auto_moments);
    EXPECT_EQ(count(200'000), 8);                // 0.96 GB each
    EXPECT_EQ(count(400'000), max_auto_moments); // more than is kept of them
}

TEST(UsualMoments, NothingThatMovesNeedsOne) {
    Moving moving;
    put(moving, true);
    moving.scene.nodes[0].translation = vec3(0);
    LightSource flash;
    flash.intensity.times = {0.5f, 1}, flash.intensity.values = {0, 5};
    moving.scene.lights.push_back(flash); // its mean brightness is known
    EXPECT_EQ(auto_moments(moving.scene, 0, ivec2(64), 0, moving.scene.cameras[0].shutter), 1);
    EXPECT_EQ(view_of(moving.scene, moving.request, moving.request.settings, 0).shutter, nullptr);
}

TEST(ShutterLimitations, SayInEveryModeHowFarMomentsLieApart) {
    Moving moving;
    put(moving, true);
    for (const auto& [count, severity] : {std::pair{4, Severity::degraded}, {16, Severity::info}}) {
        moving.request.time_samples = count;
        const Snapshot snapshot = make_snapshot(moving.scene, moments_of(moving.scene, moving.request, 0));
        const View view = view_of(moving.scene, moving.request, moving.request.settings, 0);
        for (const Mode& mode : modes()) {
            SCOPED_TRACE(mode.name);
            const Limitations said = mode.limitations(view, snapshot, moving.request.settings);
            const auto found = std::ranges::find_if(
                said, [](const Limitation& one) { return one.kind->id == std::string_view("shutter_moments"); });
            ASSERT_NE(found, said.end());
            EXPECT_EQ(found->severity, severity);
            EXPECT_NEAR(found->amounts[0], 0.2 * 64 / count, 0.05); // the plate crosses a fifth of the picture
            EXPECT_EQ(found->amounts[1], count);
        }
    }
}

TEST(ShutterSnapshots, ShareWhatStandsStill) {
    Moving moving;
    put(moving, true);
    moving.scene.nodes[0].translation = vec3(0);
    add_lamps(moving);
    const Snapshot snapshot = make_snapshot(moving.scene, moments_of(moving.scene, moving.request, 0));
    ASSERT_TRUE(snapshot.moments);
    for (const Snapshot& moment : *snapshot.moments) EXPECT_EQ(moment.occluders, snapshot.occluders);
}
}
}
