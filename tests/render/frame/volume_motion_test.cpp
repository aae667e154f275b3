// Fog of files while the shutter is open: moved along its velocities, or mixed from two frames.
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/sequence/job.h"
#include "scene/input_files.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/limitations.h"
#include "support/scratch.h"
#include "trace/fog/motion.h"
#include "trace/shutter_motion.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/vdb/vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <tuple>

namespace tyndall {
namespace {
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr float voxel = 1.0f / 32;

// A cube of even fog around a place, 16 voxels (0.5 m) wide, with the same velocity in all of its voxels.
void write_cube(const std::string& file, vec3 center, vec3 velocity, float density = 1, float side = voxel) {
    const ivec3 low = ivec3(glm::round(center / side)) - 8, high = low + 15;
    VdbContent content{{{"density"}, {"vel", true}}, glm::scale(dmat4(1), dvec3(side)), {}, {}, {}, {}};
    const ivec3 first = low >> 3, last = high >> 3;
    for (int x = first.x; x <= last.x; ++x)
        for (int y = first.y; y <= last.y; ++y)
            for (int z = first.z; z <= last.z; ++z) content.origins.push_back(ivec3(x, y, z) * 8);
    content.fill = [&](size_t number, std::span<Leaf> leaves) {
        for (Leaf& leaf : leaves) leaf = Leaf{content.origins[number]};
        for (int v = 0; v < 512; ++v) {
            const ivec3 at = content.origins[number] + ivec3(v >> 6, v >> 3 & 7, v & 7);
            if (glm::any(glm::lessThan(at, low)) || glm::any(glm::greaterThan(at, high))) continue;
            const auto i = static_cast<size_t>(v);
            leaves[0].values[i] = density;
            for (int c = 0; c < 3; ++c) leaves[static_cast<size_t>(1 + c)].values[i] = velocity[c];
        }
    };
    VdbImage(content, {.half = false}, file).write(file);
}

// Seen by an orthographic camera 2 m high and wide, a pixel a voxel, with the shutter open for a frame of a second.
struct Moving {
    TempFolder scratch;
    Scene scene;
    RenderRequest request;

    explicit Moving(const std::string& name = "fog.vdb") {
        scene.file = scratch / "scene.json", scene.frame_rate = 1, scene.resolution = {64, 64};
        CameraSource camera;
        camera.name = "camera", camera.ortho_height = 2, camera.shutter = {-0.5, 0.5, {}};
        camera.position = vec3(0, 0, 4), camera.target = vec3(0);
        scene.cameras.push_back(camera);
        LightSource sun;
        sun.name = "sun", sun.kind = LightKind::sun, sun.direction = vec3(0, 0, -1);
        scene.lights.push_back(sun);
        MediumSource fog;
        fog.name = "smoke", fog.kind = MediumKind::vdb, fog.extinction = 4.0f;
        fog.sequence.pattern = scratch.file(name);
        scene.media.push_back(fog);
        request.settings.pixel.filter = PixelFilter::box, request.settings.pixel.filter_radius = 0.5f;
        request.settings.pixel.samples = 64;
    }
    MediumSource& fog() { return scene.media[0]; }
    void move(float scale = 1, bool per_frame = false) {
        fog().velocity = VelocitySource{{fog().sequence, {"vel"}, {}}, scale, per_frame};
    }
    void number(std::vector<int> files) {
        fog().sequence.pattern = scratch.file("fog.####.vdb"), fog().sequence.files = std::move(files);
    }
    Snapshot snapshot() const { return make_snapshot(scene, moments_of(scene, request, 0)); }
    Layers rendered(const char* mode = "march") const {
        const View view = view_of(scene, request, request.settings, 0);
        FrameStats stats;
        return render_frame(find_mode(mode), view, snapshot(), request.settings, {}, stats);
    }
};

// Share of the time that the cube takes of a column, voxels as they are sampled: a trapezoid.
float covered(float x, float way) {
    const float half = 0.25f, low = std::max(x - half, -way / 2), high = std::min(x + half, way / 2);
    return std::max(high - low, 0.0f) / way;
}

double sum_of_alpha(const Layers& layers) {
    double sum = 0;
    for (const float alpha : layers.alpha.pixels) sum += double{alpha};
    return sum;
}

TEST(VolumeMotion, ConstantVelocityBlursToATrapezoid) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
    moving.move();
    moving.request.time_samples = 64;
    const float full = 1 - std::exp(-4 * 0.5f);
    for (const char* mode : {"march", "path"}) {
        const Layers layers = moving.rendered(mode);
        for (int x = 0; x < 64; ++x) {
            // Voxels lie at corners of pixels, half of one to the left of their middles.
            const float at = (static_cast<float>(x) + 1) / 32 - 1;
            EXPECT_NEAR(layers.alpha.at(x, 32), full * covered(at, 0.4f), 0.06f) << mode << " " << x;
        }
    }
}

// A fire without smoke has no density, and smoke may be coarser than its fire.
TEST(VolumeMotion, EmissionMovesWhateverTheDensity) {
    for (const bool has_smoke : {false, true}) {
        Moving moving;
        write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
        moving.move();
        moving.fog().emission_grid = GridSource{moving.fog().sequence, {"density"}, {}};
        moving.fog().emission = vec3(1), moving.fog().extinction = has_smoke ? 1e-5f : 0.0f;
        write_cube(moving.scratch.file("coarse.vdb"), vec3(0), vec3(0), 1, 16 * voxel);
        moving.fog().sequence.pattern = moving.scratch.file("coarse.vdb");
        moving.request.time_samples = 64;
        const FogTravel travel = fog_travel(moving.snapshot(), 0);
        EXPECT_NEAR(travel.voxels, 0.2 / double{voxel}, 0.3) << has_smoke;
        EXPECT_GE(travel.places, 20) << has_smoke;
        const Layers layers = moving.rendered();
        for (int x = 0; x < 64; ++x) {
            const float at = (static_cast<float>(x) + 1) / 32 - 1;
            EXPECT_NEAR(layers.color.at(x, 32).x, 0.5f * covered(at, 0.4f), 0.03f) << has_smoke << " " << x;
        }
    }
}

// A moment at the frame's own time says as much about the speed as any other.
TEST(VolumeMotion, TheFirstMomentMayBeTheFrames) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
    moving.move();
    moving.scene.cameras[0].shutter = {-0.25, 0.75, {}};
    moving.request.time_samples = 2;
    const Snapshot snapshot = moving.snapshot();
    EXPECT_NEAR(snapshot.moments->at(0).fog_sources[0].bricks->bounds.center().x, -voxel / 2, 0.1f * voxel);
    EXPECT_NEAR(snapshot.moments->at(1).fog_sources[0].bricks->bounds.center().x, 0.2f - voxel / 2, 0.6f * voxel);
}

TEST(VolumeMotion, MovesNothingAwayInAnyMode) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
    moving.fog().extinction = 0.2f; // light adds up where fog is thin
    moving.request.time_samples = 16;
    // The fog of path is found by chance: 24 pixels' worth, of 256 samples each, twice.
    for (const auto& [mode, samples, tolerance] :
         {std::tuple{"march", 16, 0.01}, {"froxel", 16, 0.02}, {"shadow-map", 16, 0.02}, {"path", 256, 0.065}}) {
        moving.request.settings.pixel.samples = samples;
        moving.fog().velocity.reset();
        const double still = sum_of_alpha(moving.rendered(mode));
        moving.move();
        EXPECT_NEAR(sum_of_alpha(moving.rendered(mode)), still, tolerance * still) << mode;
    }
}

TEST(VolumeMotion, UnitAndScaleSayHowFar) {
    Moving moving;
    moving.scene.frame_rate = 24;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {4.8f, 0, 0});
    moving.request.time_samples = 8;
    moving.move(2);
    const Snapshot by_second = moving.snapshot();
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
    moving.move(1, true);
    const Snapshot by_frame = moving.snapshot();
    for (size_t i = 0; i < 8; ++i) {
        const float middle = ((static_cast<float>(i) + 0.5f) / 8 - 0.5f) * 0.4f;
        for (const Snapshot* snapshot : {&by_second, &by_frame}) {
            const BrickPool& bricks = *(*snapshot->moments)[i].fog_sources[0].bricks;
            EXPECT_NEAR(bricks.bounds.center().x, middle - voxel / 2, 0.6f * voxel) << i;
            EXPECT_NEAR(sample_density(bricks, vec3(middle, 0, 0)), 1, 1e-2f);
        }
    }
}

TEST(VolumeMotion, PlacesAreShared) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.1f, 0, 0}); // 3.2 voxels
    moving.move();
    moving.request.time_samples = 32;
    const Snapshot snapshot = moving.snapshot();
    const FogTravel travel = fog_travel(snapshot, 0);
    EXPECT_NEAR(travel.voxels, 1.6, 0.1);
    EXPECT_GE(travel.places, 6);
    EXPECT_LE(travel.places, 10);
    moving.fog().velocity->scale = 1e-6f;
    EXPECT_LE(fog_travel(moving.snapshot(), 0).places, 2);
}

// A file of every frame: what the one before is moved to is where the next begins.
TEST(VolumeMotion, TheFirstMomentHasTheFogOfItsRun) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {2 * voxel, 0, 0}); // four runs: it is moved by half a voxel
    moving.request.time_samples = 16;
    moving.move();
    const Snapshot snapshot = moving.snapshot();
    ASSERT_TRUE(snapshot.moments);
    const auto fog_of = [&](size_t moment) { return snapshot.moments->at(moment).fog_sources.at(0).bricks; };
    for (size_t moment = 0; moment < 4; ++moment) EXPECT_EQ(fog_of(moment), fog_of(0)) << moment;
    EXPECT_NE(fog_of(4), fog_of(3));
}

TEST(VolumeMotion, SaysWhatWasRepairedInItsFiles) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {voxel, std::nanf(""), 0}); // two runs: the first is made again
    write_cube(moving.scratch.file("odd.vdb"), vec3(0), vec3(0), 1e5f);
    moving.move();
    moving.fog().emission_grid = GridSource{{moving.scratch.file("odd.vdb"), {}, 0, {}}, {"density"}, {}};
    moving.request.time_samples = 8;
    EXPECT_THAT(moving.snapshot().notes,
                UnorderedElementsAre("fog.vdb: grid \"vel\": 4096 non-finite voxels set to 0",
                                     "odd.vdb: grid \"density\": 4096 voxels above 65504 clamped to it"));
}

TEST(VolumeMotion, SaysWhichFilesAreMissing) {
    Moving moving;
    for (const char* name : {"fog.0000.vdb", "fog.0002.vdb"})
        write_cube(moving.scratch.file(name), vec3(0), {voxel, 0, 0});
    moving.number({0, 2}), moving.move();
    const std::string gap = "fog.0001.vdb is missing: ";
    for (const auto& [missing, what] :
         {std::pair{MissingFrame::hold, "fog.0000.vdb is shown instead"}, {MissingFrame::skip, "nothing is shown"}}) {
        const Snapshot snapshot =
            make_snapshot(moving.scene, moments_of(moving.scene, moving.request, 1), nullptr, missing);
        EXPECT_THAT(snapshot.notes, UnorderedElementsAre(gap + what));
    }
}

TEST(VolumeMotion, OfTheNearestFrame) {
    Moving moving;
    for (int frame = 0; frame <= 2; ++frame)
        write_cube(moving.scratch.file("fog.000" + std::to_string(frame) + ".vdb"),
                   vec3(0.125f * static_cast<float>(frame), 0, 0), {0.125f, 0, 0});
    moving.number({0, 1, 2}), moving.move();
    moving.scene.cameras[0].shutter = {0, 2, {}};
    moving.request.time_samples = 16;
    const Snapshot snapshot = moving.snapshot();
    for (size_t i = 0; i < 16; ++i)
        EXPECT_NEAR((*snapshot.moments)[i].fog_sources[0].bricks->bounds.center().x,
                    0.125f * (static_cast<float>(i) + 0.5f) / 8 - voxel / 2, 0.6f * voxel);
    EXPECT_EQ(frames_shown(moving.fog(), 0, moving.scene.cameras[0].shutter), (std::pair{0, 2}));
    // Beyond the last file it goes on.
    moving.scene.cameras[0].shutter = {2, 4, {}};
    const Snapshot beyond = moving.snapshot();
    EXPECT_NEAR(beyond.moments->front().fog_sources[0].bricks->bounds.center().x, 0.25f, voxel);
}

TEST(VolumeMotion, AMixOfTwoFramesIsTheMeanOfTheirPictures) {
    Moving moving;
    write_cube(moving.scratch.file("fog.0000.vdb"), vec3(-0.25f, 0, 0), {});
    write_cube(moving.scratch.file("fog.0001.vdb"), vec3(0.25f, 0.25f, 0), {}, 0.5f);
    moving.number({0, 1});
    moving.fog().blends = true, moving.fog().extinction = 0.01f; // so thin that light adds up
    moving.scene.cameras[0].shutter = {0, 1, {}};
    moving.request.time_samples = 8;
    const Layers mixed = moving.rendered();
    EXPECT_EQ(auto_moments(moving.scene, 0, {64, 64}, 0, moving.scene.cameras[0].shutter), 4);
    moving.request.shutter = Shutter{};
    const Layers first = moving.rendered();
    moving.fog().sequence.offset = 1;
    const Layers second = moving.rendered();
    double sum = 0;
    for (size_t i = 0; i < mixed.inscatter.pixels.size(); ++i) {
        const float mean = 0.5f * (first.inscatter.pixels[i].x + second.inscatter.pixels[i].x);
        EXPECT_NEAR(mixed.inscatter.pixels[i].x, mean, 2e-5f);
        sum += double{mean};
    }
    EXPECT_GT(sum, 0.01);
}

TEST(VolumeMotion, IsSaidWithItsAmount) {
    Moving moving;
    for (const char* name : {"fog.0000.vdb", "fog.0001.vdb"})
        write_cube(moving.scratch.file(name), vec3(0), {0.4f, 0, 0});
    moving.number({0, 1});
    moving.scene.cameras[0].shutter = {0, 0.5, {}};
    moving.request.time_samples = 16;
    moving.scene.lights[0].angle.times = {0, 1}, moving.scene.lights[0].angle.values = {0, 0.1f};
    const auto said = [&](const char* id) {
        const Snapshot snapshot = moving.snapshot();
        const View view = view_of(moving.scene, moving.request, moving.request.settings, 0);
        for (const Limitation& one : find_mode("march").limitations(view, snapshot, moving.request.settings))
            if (one.kind->id == std::string_view(id)) return std::optional(one);
        return std::optional<Limitation>();
    };
    ASSERT_TRUE(said("still_volumes"));
    moving.fog().blends = true;
    EXPECT_FALSE(said("still_volumes"));
    ASSERT_TRUE(said("blended_volumes"));
    EXPECT_NEAR(said("blended_volumes")->amounts[0], 48, 1);
    moving.fog().blends = false, moving.move();
    EXPECT_FALSE(said("still_volumes"));
    EXPECT_FALSE(said("blended_volumes"));
    ASSERT_TRUE(said("advected_volumes"));
    EXPECT_NEAR(said("advected_volumes")->amounts[0], 0.4 * 0.484 / double{voxel},
                0.3); // places lie in the middle of their moments
    EXPECT_EQ(said("advected_volumes")->severity, Severity::info);
}

TEST(VolumeMotion, AClosedShutterReadsNoVelocity) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {0.4f, 0, 0});
    const Layers still = (moving.request.shutter = Shutter{}, moving.rendered());
    moving.move(), moving.fog().velocity->grid.grids = {"nothing"};
    EXPECT_TRUE(moving.rendered().color.pixels == still.color.pixels);
    moving.request.shutter.reset();
    EXPECT_THAT(error_message(ExitCode::refused, [&] { moving.snapshot(); }), HasSubstr("has no grid \"nothing\""));
}

TEST(VolumeMotion, AbsurdSpeedsAreOneLineWithFileAndField) {
    Moving moving;
    write_cube(moving.scratch.file("fog.vdb"), vec3(0), {3e30f, 0, 0});
    moving.move();
    EXPECT_THAT(error_message(ExitCode::refused, [&] { moving.snapshot(); }),
                StartsWith(moving.scene.file.string() + ": medium smoke: density: its velocity moves it by up to"));
    moving.fog().emission_grid = GridSource{moving.fog().sequence, {"density"}, {}};
    moving.fog().extinction = 0.0f;
    EXPECT_THAT(error_message(ExitCode::refused, [&] { moving.snapshot(); }),
                StartsWith(moving.scene.file.string() + ": medium smoke: emission: its velocity moves it by up to"));
}
}
}
