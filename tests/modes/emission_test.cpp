// Light that fog emits adds up along the way, whether or not the fog dims anything.
#include "modes/mode.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/run_mode.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using ::testing::HasSubstr;

MediumSource flame(float extinction, Box bounds = {vec3(-1), vec3(1)}) {
    MediumSource source;
    source.name = "flame", source.bounds = bounds;
    source.extinction = extinction, source.emission = vec3(2, 1, 0.5f), source.albedo = vec3(0);
    return source;
}

TEST(Emission, NeedsNoExtinction) {
    Scene alone, beside_fog;
    alone.media = {flame(0)};
    beside_fog.media = {flame(0), flame(0.3f)};
    beside_fog.media[1].emission = vec3(0);
    const View view = view_of({0.2f, 0.1f, 2}, vec3(0), {64, 36});
    int asked = 0;
    for (const Mode& mode : modes()) {
        if (!reads(mode, "terms.emission") || mode.name == "path") continue; // path_test.cpp has its own
        for (const Scene* scene : {&alone, &beside_fog}) {
            const Snapshot snapshot = make_snapshot(*scene, Moment{0, 0});
            const std::vector<Ray> rays = pixel_rays(view, snapshot, 10);
            std::vector<Scatter> expected;
            for (const Ray& ray : rays) {
                const double length = clip({vec3(-1), vec3(1)}, ray.origin, ray.direction, {0, ray.t_max}).length();
                const double sum = scene == &alone ? length : (1 - std::exp(-0.3 * length)) / 0.3;
                expected.push_back({vec3(2, 1, 0.5f) * static_cast<float>(sum)});
            }
            const auto found = scattered(mode.prepare(view, snapshot, settings_for(Quality::preview), nullptr), rays);
            const double most = mode.name == "froxel" ? 0.08 : 1e-3; // froxels are wider than pixels
            EXPECT_LT(relative_rmse(found, expected), most) << mode.name << (scene == &alone ? "" : " in fog");
            ++asked;
        }
    }
    EXPECT_EQ(asked, 2 * 5);
}

TEST(Emission, WithoutEndIsRefused) {
    Scene scene;
    scene.media = {flame(0, everywhere())};
    const Error error = error_of([&] { make_snapshot(scene, Moment{0, 0}); });
    EXPECT_EQ(error.code, ExitCode::refused);
    EXPECT_THAT(error.what(), HasSubstr("medium flame: emits in unbounded space"));
    scene.media = {flame(1e-9f, everywhere())};
    EXPECT_EQ(make_snapshot(scene, Moment{0, 0}).media.size(), 1u);
}
}
}
