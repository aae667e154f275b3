#include "base/io/frames.h"
#include "base/parallel.h"
#include "support/expect.h"
#include "support/threads.h"
#include "volume/recipe/bake.h"
#include "volume/recipe/recipe_fixtures.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gtest/gtest.h>

#include <map>

namespace tyndall::testing {
namespace {
FogRecipe small_fog() {
    FogRecipe recipe = busy_fog();
    recipe.voxel_size = 0.12;
    return recipe;
}

BakeReport baked(const FogRecipe& recipe, const std::string& pattern, const std::vector<int>& frames,
                 const BakeOptions& options = {}) {
    Progress progress(ProgressStyle::none, "bake", static_cast<double>(frames.size()));
    ::testing::internal::CaptureStderr(); // a line per frame
    struct Release {
        ~Release() { ::testing::internal::GetCapturedStderr(); }
    } release;
    return bake(recipe, pattern, frames, options, progress);
}

TEST(Bake, WritesWhatTheRecipeSays) {
    const TempFolder scratch;
    const FogRecipe recipe = small_fog();
    const std::string pattern = scratch.path() / "sub" / "fog.####.vdb";
    const BakeReport report = baked(recipe, pattern, {-2, 7, 12});
    EXPECT_EQ(report.written, 3);
    EXPECT_EQ(report.kept, 0);
    uint64_t bytes = 0, voxels = 0;
    for (const int frame : {-2, 7, 12}) {
        const std::string file = frame_name(pattern, frame);
        bytes += std::filesystem::file_size(file);
        VdbReadReport mended;
        const SparseVolume read = read_vdb(file, "density", &mended);
        EXPECT_EQ(mended.summary(), "");
        const SparseVolume grown = generate(recipe, frame / 24.0);
        EXPECT_EQ(read.active_low, grown.active_low);
        EXPECT_EQ(read.active_high, grown.active_high);
        for (int column = 0; column < 4; ++column)
            EXPECT_LT(glm::distance(read.index_to_world[column], grown.index_to_world[column]), 1e-12);
        ASSERT_EQ(read.leaves.size(), grown.leaves.size());
        for (const Leaf& leaf : grown.leaves)
            for (int i = 0; i < 512; i += 7) {
                const float value = leaf.values[i];
                ASSERT_NEAR(value_at(read, leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8)), value, value / 2048);
            }
        for (const Leaf& leaf : grown.leaves)
            for (const float value : leaf.values) voxels += value != 0;
    }
    EXPECT_EQ(report.bytes, bytes);
    EXPECT_EQ(report.voxels, voxels);
}

FogRecipe small_fire() {
    FogRecipe recipe = small_fog();
    recipe.threshold = 0.4f;
    recipe.fire = FireRecipe{.base = vec3(0, -0.5f, 0), .height = 1.2f, .radius = 0.5f};
    return recipe;
}

TEST(Bake, FireHasItsGridsOnTheSameVoxels) {
    const TempFolder scratch;
    const FogRecipe recipe = small_fire();
    const std::string file = scratch.path() / "fire.vdb";
    for (const bool half : {true, false})
        for (const bool blosc : {true, false}) {
            BakeOptions options;
            options.velocity = true, options.write.half = half, options.write.blosc = blosc;
            const BakeReport report = baked(recipe, file, {9}, options);
            const VdbInfo info = vdb_info(file);
            ASSERT_EQ(info.grids.size(), 3u);
            const std::array<GridRole, 3> roles{GridRole::density, GridRole::temperature, GridRole::velocity};
            for (size_t g = 0; g < 3; ++g) {
                EXPECT_EQ(info.grids[g].role, roles[g]) << g;
                EXPECT_EQ(info.grids[g].active_voxels, report.voxels) << g;
                EXPECT_EQ(info.grids[g].leaves, info.grids[0].leaves) << g;
                EXPECT_EQ(info.grids[g].active_low, info.grids[0].active_low) << g;
                EXPECT_EQ(info.grids[g].active_high, info.grids[0].active_high) << g;
            }
            EXPECT_EQ(info.grids[1].grid_class, "fog volume");
            EXPECT_EQ(info.grids[2].type, "vec3s");
            EXPECT_TRUE(info.grids[0].is_fog);

            // Values as grown, in the precision asked for; velocities, which may be negative, are read above 64.
            const double rounding = half ? 1.0 / 2048 : 1e-6, seconds = 9 / 24.0;
            const SparseVolume density = read_vdb(file), kelvin = read_vdb(file, "temperature");
            const SparseVolume grown = generate(recipe, seconds), hot = generate_temperature(recipe, seconds);
            const std::string name = "vel";
            ValueMap map;
            map.offset = 64;
            const ColorVolume velocity = read_color_vdb(file, {&name, 1}, map, infinity, nullptr);
            size_t compared = 0;
            for (const Leaf& leaf : hot.leaves)
                for (int v = 0; v < 512; v += 5) {
                    const ivec3 at = leaf.origin + ivec3(v / 64, v / 8 % 8, v % 8);
                    ASSERT_NEAR(value_at(kelvin, at), leaf.values[v], rounding * leaf.values[v]);
                    ASSERT_NEAR(value_at(density, at), value_at(grown, at), rounding);
                    if (leaf.values[v] == 0) continue;
                    const std::vector<vec3> point{vec3(grown.index_to_world * glm::dvec4(dvec3(at), 1))};
                    vec3 expected;
                    recipe_velocity(recipe, seconds, point, {&leaf.values[v], 1}, {&expected, 1});
                    for (int axis = 0; axis < 3; ++axis)
                        ASSERT_NEAR(value_at(velocity.channels[axis], at) - 64, expected[axis],
                                    1e-4 + rounding * std::abs(expected[axis]));
                    ++compared;
                }
            EXPECT_GT(compared, 300u);
        }
}

TEST(Bake, VelocityGoesWithAnyFog) {
    const TempFolder scratch;
    const std::string file = scratch.path() / "fog.vdb";
    FogRecipe recipe = small_fog();
    BakeOptions options;
    options.velocity = true;
    baked(recipe, file, {1}, options);
    const VdbInfo info = vdb_info(file);
    ASSERT_EQ(info.grids.size(), 2u);
    EXPECT_EQ(info.grids[1].name, "vel");
    EXPECT_EQ(info.grids[1].active_voxels, info.grids[0].active_voxels);
    BakeOptions resume;
    resume.resume = true;
    EXPECT_EQ(baked(recipe, file, {1}, resume).kept, 0) << "other grids were asked for";
    EXPECT_EQ(vdb_info(file).grids.size(), 1u);
    recipe.name = "vel";
    EXPECT_EQ(error_of([&] { baked(recipe, file, {1}, options); }).code, ExitCode::refused);
}

TEST(Bake, SaysHowItWasMade) {
    const TempFolder scratch;
    FogRecipe recipe = small_fog();
    recipe.albedo = vec3(0.9f, 0.8f, 0.7f);
    const std::string file = scratch.path() / "fog.vdb";
    baked(recipe, file, {12});
    std::map<std::string, std::string> metadata;
    for (const auto& [key, text] : vdb_metadata(file)) metadata[key] = text;
    const std::map<std::string, std::string> expected{{"tyndall_schema", "1"},
                                                      {"tyndall_frame", "12"},
                                                      {"tyndall_time_s", "0.5"},
                                                      {"tyndall_fps", "24"},
                                                      {"tyndall_up_axis", "Y"},
                                                      {"tyndall_unit_m", "1"},
                                                      {"tyndall_extinction_per_m", "0.1"},
                                                      {"tyndall_albedo", "0.9 0.8 0.7"},
                                                      {"tyndall_g", "0.3"},
                                                      {"tyndall_seed", "1"},
                                                      {"tyndall_period_s", "4"},
                                                      {"tyndall_evolve_per_s", "0.25"},
                                                      {"tyndall_swirl_per_s", "0.25"}};
    for (const auto& [key, text] : expected) EXPECT_EQ(metadata[key], text) << key;
    EXPECT_EQ(metadata["tyndall_settings_hash"].size(), 32u);
    EXPECT_EQ(metadata["creator"], "tyndall " TYNDALL_VERSION);

    const VdbInfo info = vdb_info(file);
    ASSERT_EQ(info.grids.size(), 1u);
    EXPECT_EQ(info.grids[0].name, "density");
    EXPECT_EQ(info.grids[0].grid_class, "fog volume");
    EXPECT_EQ(info.grids[0].background, 0);
    EXPECT_LE(info.grids[0].maximum, 1);
}

TEST(Bake, ResumeKeepsWhatIsRight) {
    const TempFolder scratch;
    const FogRecipe recipe = small_fog();
    const std::string pattern = scratch.path() / "fog.####.vdb";
    const std::vector<int> frames{1, 2, 3, 4};
    baked(recipe, pattern, frames);
    const auto whole = scratch.contents();
    BakeOptions resume;
    resume.resume = true;
    const auto counts = [&](const FogRecipe& fog, const BakeOptions& options) {
        const BakeReport report = baked(fog, pattern, frames, options);
        return std::pair(report.written, report.kept);
    };
    EXPECT_EQ(counts(recipe, resume), std::pair(0, 4));

    // Cut, damaged in the middle, another frame under this name, missing, not a VDB at all: each is made again.
    const auto put = [&](const char* name, const std::string& bytes) { scratch.put(name, bytes); };
    const std::string second = whole.at("fog.0002.vdb");
    std::string damaged = second;
    for (size_t i = damaged.size() / 2; i < damaged.size() / 2 + 64; ++i) damaged[i] = '\x55';
    for (const std::string& bytes : {second.substr(0, second.size() / 2), second.substr(0, second.size() - 1), damaged,
                                     whole.at("fog.0003.vdb"), std::string("not a volume"), std::string()}) {
        put("fog.0002.vdb", bytes);
        EXPECT_EQ(counts(recipe, resume), std::pair(1, 3));
        EXPECT_EQ(scratch.contents(), whole);
    }
    for (int i = 0; i < 20; ++i) { // single bits, which most readers do not see
        std::string flipped = second;
        flipped[second.size() * static_cast<size_t>(i) / 20 + static_cast<size_t>(i)] ^= static_cast<char>(1 << i % 8);
        put("fog.0002.vdb", flipped);
        EXPECT_EQ(counts(recipe, resume), std::pair(1, 3)) << i;
        EXPECT_EQ(scratch.contents(), whole);
    }
    std::filesystem::remove(scratch.path() / "fog.0004.vdb");
    EXPECT_EQ(counts(recipe, resume), std::pair(1, 3));
    EXPECT_EQ(scratch.contents(), whole);

    // Other settings make other files.
    FogRecipe other = recipe;
    other.gain += 1;
    EXPECT_EQ(counts(other, resume), std::pair(4, 0));
    BakeOptions full = resume;
    full.write.half = false;
    EXPECT_EQ(counts(other, full), std::pair(4, 0));
    EXPECT_EQ(counts(other, full), std::pair(0, 4));
    full.write.blosc = false;
    EXPECT_EQ(counts(other, full), std::pair(4, 0));
    full.resume = false;
    EXPECT_EQ(counts(other, full), std::pair(4, 0));
}

TEST(Bake, ThreadsGiveTheSameFiles) {
    const auto files = [] {
        const TempFolder scratch;
        baked(small_fog(), scratch.path() / "fog.####.vdb", {1, 2, 3, 4});
        BakeOptions options;
        options.velocity = true;
        baked(small_fire(), scratch.path() / "fire.vdb", {5}, options);
        return scratch.contents();
    };
    const auto alone = on_threads(1, files);
    EXPECT_EQ(alone.size(), 5u);
    EXPECT_EQ(on_threads(2, files), alone);
}

TEST(Bake, LoopsMeet) {
    const TempFolder scratch;
    const FogRecipe recipe = small_fog(); // four seconds at 24 frames per second
    baked(recipe, scratch.path() / "fog.####.vdb", {5, 101});
    const SparseVolume a = read_vdb(scratch.path() / "fog.0005.vdb"), b = read_vdb(scratch.path() / "fog.0101.vdb");
    ASSERT_EQ(a.leaves.size(), b.leaves.size());
    for (size_t i = 0; i < a.leaves.size(); ++i) {
        ASSERT_EQ(a.leaves[i].origin, b.leaves[i].origin);
        ASSERT_EQ(a.leaves[i].values, b.leaves[i].values);
    }
}

TEST(Bake, EmptyFogIsAFileToo) {
    const TempFolder scratch;
    FogRecipe recipe = small_fog();
    recipe.threshold = 1;
    const std::string file = scratch.path() / "none.vdb";
    EXPECT_EQ(baked(recipe, file, {1}).written, 1);
    EXPECT_TRUE(read_vdb(file).empty());
    BakeOptions resume;
    resume.resume = true;
    EXPECT_EQ(baked(recipe, file, {1}, resume).kept, 1);
}

TEST(Bake, RefusesWhatCannotBe) {
    const TempFolder scratch;
    const auto code_of = [&](const FogRecipe& recipe, const std::string& pattern, const std::vector<int>& frames) {
        return error_of([&] { baked(recipe, pattern, frames); }).code;
    };
    EXPECT_EQ(code_of(small_fog(), scratch.path() / "fog.vdb", {1, 2}), ExitCode::usage);
    const std::string file = scratch.put("file", "x");
    EXPECT_EQ(code_of(small_fog(), file + "/fog.vdb", {1}), ExitCode::unwritable);
    FogRecipe fine = small_fog();
    fine.voxel_size = 1e-6;
    EXPECT_EQ(code_of(fine, scratch.path() / "fine.vdb", {1}), ExitCode::out_of_memory);
    // A directory is in the way of the second frame: the first one is there, nothing half-written is.
    std::filesystem::create_directory(scratch.path() / "fog.0002.vdb");
    EXPECT_EQ(code_of(small_fog(), scratch.path() / "fog.####.vdb", {1, 2, 3}), ExitCode::unwritable);
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path())) {
        const std::string name = entry.path().filename();
        EXPECT_TRUE(name == "file" || name.starts_with("fog.000")) << name;
        if (!entry.is_regular_file() || name == "file") continue;
        EXPECT_FALSE(read_vdb(entry.path()).empty());
    }
}
}
}
