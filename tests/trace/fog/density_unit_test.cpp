// Densities in any unit of measurement.
#include "scene/scene.h"
#include "support/scratch.h"
#include "trace/fog/density_unit.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Densities rise from 0.1 to 1, times a factor.
SparseVolume ramp(float factor, int leaves = 4) {
    SparseVolume volume;
    for (int n = 0; n < leaves; ++n) {
        Leaf& leaf = volume.leaves.emplace_back();
        leaf.origin = {8 * n, 0, 0};
        for (size_t v = 0; v < 512; ++v) leaf.values[v] = factor * (0.1f + 0.9f * static_cast<float>(v) / 511);
    }
    volume.active_low = ivec3(0), volume.active_high = {8 * leaves - 1, 7, 7};
    return volume;
}

TEST(DensityUnit, IsOneForWhatHalvesHold) {
    for (const float factor : {0.01f, 1.0f, 30000.0f}) EXPECT_EQ(density_unit(ramp(factor)), 1) << factor;
    EXPECT_EQ(density_unit(SparseVolume()), 1);
}

TEST(DensityUnit, IsAPowerOfTwoBelowTheLargest) {
    for (const float factor : {1e-30f, 1e-9f, 1e8f, 1e30f}) {
        const float unit = density_unit(ramp(factor));
        EXPECT_LE(unit, factor);
        EXPECT_GT(2 * unit, factor);
        int exponent;
        EXPECT_EQ(std::frexp(unit, &exponent), 0.5f);
    }
}

TEST(DensityUnit, IgnoresStrayVoxels) {
    SparseVolume volume = ramp(1);
    volume.leaves[0].values[7] = 3e38f;
    EXPECT_EQ(density_unit(volume), 1);
    EXPECT_EQ(divide_by(1, volume), 1u);
}

// The same fog in grams, micrograms and droplets.
TEST(DensityUnit, DoesNotMatterToTheMedium) {
    const TempFolder folder;
    for (const float factor : {1.0f, 1e-9f, 1e8f}) {
        SCOPED_TRACE(factor);
        const std::filesystem::path file = folder / (factor < 1 ? "small.vdb" : factor > 1 ? "large.vdb" : "one.vdb");
        write_vdb(file, ramp(factor), {.half = false});
        Scene scene;
        MediumSource& source = scene.media.emplace_back();
        source.kind = MediumKind::vdb, source.sequence.pattern = file.string();
        source.extinction = 2 / factor, source.emission = vec3(3 / factor);
        source.channel_extinction = vec3(1, 2, 3) / factor;
        const Snapshot snapshot = make_snapshot(scene, Moment{});
        ASSERT_EQ(snapshot.media.size(), 1u);
        const Optics& optics = snapshot.media[0].optics;
        const float highest = snapshot.media[0].density.bricks->highest;
        EXPECT_NEAR(optics.extinction.x * highest, 2, 2e-3f);
        EXPECT_NEAR(optics.emission.radiance.x * highest, 3, 3e-3f);
        EXPECT_NEAR(channel_of(snapshot, 2).media[0].optics.extinction.x * highest, 3, 3e-3f);
        EXPECT_TRUE(snapshot.notes.empty());
    }
}
}
}
