// References until their noise is small: as good as asked for, and right on average though most samples are quick ones.
#include "measure/chart/errors.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const ivec2 picture(40, 24);

struct SmallShot {
    Scene scene;
    Snapshot snapshot;
    RenderRequest job;

    SmallShot(const std::string& file, const std::string& row)
        : scene(load_scene(std::string(TYNDALL_SOURCE_DIR) + "/" + file)) {
        snapshot = make_snapshot(scene, moment_of(scene, scene.first_frame));
        job.settings = settings_for(Quality::preview);
        if (!row.empty()) apply_setting(job.settings, row);
        job.scene_file = scene.file, job.resolution = picture;
    }
    Shot shot() const { return {scene, snapshot, job, scene.first_frame, {}, nullptr, {}}; }
};

class Reference : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(Reference, GetsToTheNoiseAndIsUnbiased) {
    constexpr double noise = 0.04;
    const SmallShot small(GetParam().first, GetParam().second);
    FileHashes files;
    ReferenceSamples exact, quick;
    exact.count = 32, exact.unlit = quick.unlit = false, quick.noise = noise;
    const ReferenceMetrics reference_metrics = make_metrics(make_reference(small.shot(), exact, files), false);
    const auto halves = make_reference(small.shot(), quick, files).halves;

    // The halves tell their own noise, and it is the one asked for: bounds hold with 99.5 %.
    const double mean = reference_metrics.mean;
    EXPECT_LT(measure_errors(halves[0].color, halves[1].color).rmse / 2 / mean, 1.3 * noise);

    // Noise of the mean over all pixels, and of the reference_metrics's: four standard deviations.
    const ChartErrors errors = chart_errors(reference_metrics, mean_of(halves));
    const double pixels = picture.x * picture.y,
                 own = measure_errors(reference_metrics.halves[0].color, reference_metrics.halves[1].color).rmse / 2;
    const double deviation = std::sqrt((noise * noise + own * own / (mean * mean)) / pixels);
    EXPECT_LT(std::abs(errors.bias), 4 * deviation);
    EXPECT_LT(std::abs(errors.inscatter_bias), 4 * deviation);
    EXPECT_LT(errors.error, noise);
}
// A light grid this coarse is off by more than the noise unless exact samples put it right.
INSTANTIATE_TEST_SUITE_P(Scenes, Reference,
                         testing::Values(std::pair{"scenes/window.json", "terms.light_resolution=8"},
                                         std::pair{"tests/measure/plan/plan_scenes/even_room.json", ""}));
}
}
