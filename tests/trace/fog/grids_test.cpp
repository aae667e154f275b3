// Media with grids beside their density: what is shared from frame to frame, moved, mended and left out.
#include "scene/scene.h"
#include "support/expect.h"
#include "support/scratch.h"
#include "trace/fog/grids.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/fog_fixtures.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;
using ::testing::Contains;
using ::testing::HasSubstr;

FileSequence file_of(const TempFolder& scratch, const std::string& name, SparseVolume volume) {
    FileSequence sequence;
    sequence.pattern = scratch.file(name + ".vdb");
    volume.name = name;
    write_vdb(sequence.pattern, volume, {.half = false});
    return sequence;
}

MediumSource fire_source(const TempFolder& scratch, float kelvin = 1500) {
    MediumSource source;
    source.name = "fire", source.kind = MediumKind::vdb;
    source.sequence = file_of(scratch, "density", constant_box(16, 0.5f));
    source.extinction = 0.25f, source.albedo = vec3(0.75f);
    source.temperature = GridSource{file_of(scratch, "temperature", constant_box(16, kelvin)), {"temperature"}, {}};
    source.blackbody = BlackbodySource{};
    return source;
}

TEST(FogGrids, AreSharedUntilSomethingChanges) {
    const TempFolder scratch;
    Scene scene;
    scene.media = {fire_source(scratch)};
    scene.media[0].blackbody->scale.times = {0, 1}, scene.media[0].blackbody->scale.values = {1, 3};
    const Snapshot first = make_snapshot(scene, Moment{1, 0});
    ASSERT_EQ(first.media.size(), 2u);
    EXPECT_EQ(first.media[1].name, "fire (blackbody)");
    const Snapshot second = make_snapshot(scene, Moment{2, 1}, &first);
    EXPECT_EQ(second.media[1].density.bricks, first.media[1].density.bricks);
    EXPECT_EQ(second.media[1].optics.emission.field, first.media[1].optics.emission.field);
    expect_near(second.media[1].optics.emission.radiance, 3.0f * first.media[1].optics.emission.radiance, 1e-2f);
    scene.media[0].temperature = GridSource{file_of(scratch, "hotter", constant_box(16, 1800)), {"hotter"}, {}};
    const Snapshot hotter = make_snapshot(scene, Moment{3, 0}, &second);
    EXPECT_NE(hotter.media[1].density.bricks, first.media[1].density.bricks);
    EXPECT_EQ(hotter.media[0].density.bricks, first.media[0].density.bricks);
    EXPECT_GT(hotter.media[1].optics.emission.radiance.x, 5 * first.media[1].optics.emission.radiance.x);
}

TEST(FogGrids, MoveWithTheirMedium) {
    const TempFolder scratch;
    Scene scene;
    scene.media = {fire_source(scratch)};
    scene.media[0].blackbody->by_absorption = true;
    scene.media[0].albedo_grid = GridSource{file_of(scratch, "Cd", constant_box(16, 0.5f)), {"Cd"}, {}};
    const Snapshot still = make_snapshot(scene, Moment{1, 0});
    scene.media[0].translation = vec3(100, 0, 0), scene.media[0].scale = vec3(2);
    const Snapshot moved = make_snapshot(scene, Moment{2, 1}, &still);
    const auto there = [](vec3 point) { return vec3(100, 0, 0) + 2.0f * point; };
    for (const vec3 point : {vec3(3, 4, 5), vec3(0.5f, 15.3f, 7)}) {
        expect_near(emission_at(moved.media[1], there(point)), emission_at(still.media[1], point), 1e-2f);
        expect_near(albedo_at(moved.media[0].optics, there(point)), albedo_at(still.media[0].optics, point));
    }
    EXPECT_NEAR(moved.media[1].world_bounds.low.x, 98, 1e-3);
    // Half of the color, of an albedo of .75, of .25 / m at density .5.
    const vec3 expected = vec3((1 - 0.375f) * 0.125f) * vec3(blackbody_color(BlackbodyKind::kelvin, 1500));
    expect_near(emission_at(still.media[1], {8, 8, 8}), expected, 1e-3f * expected.x);
}

TEST(FogGrids, LightNeedsNoDensity) {
    const TempFolder scratch;
    Scene scene;
    scene.media = {fire_source(scratch)};
    scene.media[0].extinction = 0.0f;
    std::filesystem::remove(scratch / "density.vdb"); // is not read
    const Snapshot snapshot = make_snapshot(scene, Moment{1, 0});
    ASSERT_EQ(snapshot.media.size(), 1u);
    EXPECT_EQ(snapshot.media[0].optics.albedo, vec3(0));
    scene.media[0].blackbody->by_absorption = true;
    EXPECT_TRUE(make_snapshot(scene, Moment{1, 0}).media.empty());
    scene.media[0].blackbody->by_absorption = false, scene.media[0].blackbody->scale = 0.0f;
    EXPECT_TRUE(make_snapshot(scene, Moment{1, 0}).media.empty());
    scene.media[0] = fire_source(scratch, 0);
    EXPECT_EQ(make_snapshot(scene, Moment{1, 0}).media.size(), 1u) << "cold smoke";
}

TEST(FogGrids, TemperaturesOutOfRangeAreMendedAndSaid) {
    const TempFolder scratch;
    Scene scene;
    SparseVolume volume = constant_box(16, 1000);
    volume.leaves[0].values[9] = 1e9f, volume.leaves[0].values[10] = -5;
    scene.media = {fire_source(scratch)};
    scene.media[0].temperature = GridSource{file_of(scratch, "odd", volume), {"odd"}, {}};
    const Snapshot snapshot = make_snapshot(scene, Moment{1, 0});
    EXPECT_THAT(snapshot.notes, Contains(HasSubstr("odd.vdb: grid \"odd\": 1 voxels above 65504 clamped to it")));
    for (const Medium& medium : snapshot.media) EXPECT_TRUE(is_finite(medium.optics.emission.radiance));
}

template<class T> std::string raw(const T& value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }
std::string text(const std::string& words) { return raw(static_cast<uint32_t>(words.size())) + words; }

// An OpenVDB file of one leaf with all voxels active; write_vdb() does not write what is no number.
std::string file_of_leaf(const std::string& grid, const std::array<float, 512>& values) {
    const std::string first(1, '\1'), all(64, '\xff'), kind(1, '\0');
    const auto node = [&](size_t slots) { return first + std::string(2 * slots / 8 - 1, '\0') + kind; };
    return raw(int64_t{0x56444220}) + raw(std::array<uint32_t, 3>{224, 10, 0}) + std::string(1 + 36 + 4, '\0') +
           raw(int32_t{1}) + text(grid) + text("Tree_float_5_4_3") + text("") + raw(std::array<int64_t, 3>{}) +
           raw(uint32_t{2}) + raw(uint32_t{0}) + text("AffineMap") + raw(dmat4(1)) + raw(int32_t{1}) + raw(0.0f) +
           raw(std::array<uint32_t, 2>{0, 1}) + raw(ivec3(0)) + node(32768) + node(4096) + all + all + kind +
           raw(values);
}

TEST(FogGrids, TemperaturesThatAreNoNumbersAreColdAndSaid) {
    const TempFolder scratch;
    Scene scene;
    const auto radiance = [&](float odd) {
        std::array<float, 512> kelvin;
        kelvin.fill(1000), kelvin[9] = odd;
        scene.media = {fire_source(scratch)};
        scene.media[0].temperature->sequence.pattern = scratch.put("odd.vdb", file_of_leaf("temperature", kelvin));
        const Snapshot snapshot = make_snapshot(scene, Moment{1, 0});
        EXPECT_EQ(snapshot.media.size(), 2u);
        const std::string said = "odd.vdb: grid \"temperature\": 1 non-finite voxels set to 0";
        EXPECT_EQ(snapshot.notes, odd == 0 ? std::vector<std::string>() : std::vector{said});
        return snapshot.media.back().optics.emission.radiance;
    };
    const vec3 none = radiance(std::numeric_limits<float>::quiet_NaN());
    EXPECT_GT(none.x, 0);
    EXPECT_EQ(none, radiance(0));
}

// Half floats end at 6e-8, and below 6e-5 they have fewer digits.
TEST(FogGrids, EmissionThatHalfFloatsLoseIsSaid) {
    const TempFolder scratch;
    const auto notes = [&](float value, float scale) {
        Scene scene;
        scene.media = {fire_source(scratch)};
        scene.media[0].temperature.reset(), scene.media[0].blackbody.reset();
        scene.media[0].emission_grid = GridSource{file_of(scratch, "glow", constant_box(16, value)), {"glow"}, {}};
        scene.media[0].emission_grid->map.scale = scale, scene.media[0].emission = vec3(1);
        return make_snapshot(scene, Moment{1, 0}).notes;
    };
    EXPECT_THAT(notes(1e-5f, 1),
                Contains("glow.vdb: emission: its values, up to 1e-05, are stored as half floats: those "
                         "below 6e-5 lose precision and those below 6e-8 are lost; give it a larger "
                         "\"scale\""));
    EXPECT_THAT(notes(1e-5f, 1000), ::testing::IsEmpty());
    EXPECT_THAT(notes(0.5f, 1), ::testing::IsEmpty());
}

TEST(FogGrids, AMissingGridIsOneLine) {
    const TempFolder scratch;
    Scene scene;
    scene.media = {fire_source(scratch)};
    scene.media[0].temperature->grids = {"heat"};
    EXPECT_THAT(error_message(ExitCode::refused,
                              [&] {
                                  make_snapshot(scene, Moment{1, 0});
                              }),
                HasSubstr("has no grid \"heat\"; it has temperature (float)"));
}

TEST(FogGrids, ARecipesFireGlowsAsItsFormulaSays) {
    Scene scene;
    MediumSource& source = scene.media.emplace_back();
    source.name = "fire", source.kind = MediumKind::noise, source.blackbody = BlackbodySource{.scale = 0.5f};
    source.recipe = FogRecipe{};
    source.recipe->bounds = {vec3(-0.5f, 0, -0.5f), vec3(0.5f, 1, 0.5f)}, source.recipe->voxel_size = 0.0625;
    source.recipe->fire = FireRecipe{.height = 0.75f, .radius = 0.375f, .flicker = 0};
    const Snapshot first = make_snapshot(scene, Moment{1, 0});
    ASSERT_EQ(first.media.size(), 2u);
    EXPECT_EQ(first.media[1].name, "fire (blackbody)");
    for (const vec3 point : {vec3(0.03125f), vec3(0.03125f, 0.34375f, -0.09375f)}) { // centers of voxels
        const double h = point.y / 0.75, r = std::hypot(point.x, point.z) / 0.375 * (1 + h);
        const vec3 expected(0.5 * blackbody_color(BlackbodyKind::kelvin, 1100 + 800 * (1 - h * h - r * r)));
        // Half floats: a kelvin is 1/1900, and luminance goes with its tenth power and more.
        expect_near(emission_at(first.media[1], point), expected, 0.01f * expected.x);
    }
    EXPECT_EQ(emission_at(first.media[1], vec3(0.03125f, 0.90625f, 0.03125f)), vec3(0)) << "above the flame";

    // It rises though nothing else moves, and is grown anew for another moment alone.
    const Snapshot again = make_snapshot(scene, Moment{1, 0}, &first),
                   later = make_snapshot(scene, Moment{2, 1}, &first);
    EXPECT_EQ(again.media[1].density.bricks, first.media[1].density.bricks);
    EXPECT_NE(later.media[1].density.bricks, first.media[1].density.bricks);
    source.recipe->fire->rise = 0;
    const Snapshot still = make_snapshot(scene, Moment{1, 0}), stays = make_snapshot(scene, Moment{2, 1}, &still);
    EXPECT_EQ(stays.media[1].density.bricks, still.media[1].density.bricks);

    source.extinction = 0.0f; // light alone
    EXPECT_EQ(make_snapshot(scene, Moment{1, 0}).media.size(), 1u);
}

// A few bytes of file can stand for billions of voxels.
TEST(FogGrids, HugeTilesStayTiles) {
    const TempFolder scratch;
    Scene scene;
    SparseVolume volume;
    volume.tiles = {{ivec3(0), ivec3(799), 1500}};
    volume.active_high = ivec3(799);
    scene.media = {fire_source(scratch)};
    scene.media[0].temperature = GridSource{file_of(scratch, "huge", volume), {"huge"}, {}};
    const Snapshot snapshot = make_snapshot(scene, Moment{1, 0});
    ASSERT_EQ(snapshot.media.size(), 2u);
    EXPECT_LT(snapshot.media[1].density.bricks->bytes(), 1u << 28);
    const vec3 expected(blackbody_color(BlackbodyKind::kelvin, 1500));
    expect_near(emission_at(snapshot.media[1], vec3(400)), expected, 1e-3f * expected.x);
    EXPECT_NEAR(snapshot.media[1].optics.emission.field->out_of_gamut, 1, 1e-6);
}
}
}
