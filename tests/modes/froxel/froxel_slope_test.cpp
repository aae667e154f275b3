// How the froxels' error falls as tiles and slices shrink together.
#include "modes/froxel/froxel_fixtures.h"
#include "modes/froxel/settings.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TEST(Froxel, ErrorFallsAtLeastAsTheRootOfTheRefinement) {
    const TestScene stage = half_shadowed_fog();
    const View view = view_of({0.5f, 1.5f, 9}, {0, 1.5f, 0});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    // Least squares of log error over log refinement.
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int refinement = 1; refinement <= 8; refinement *= 2) {
        Settings settings;
        settings.of<FroxelSettings>().tile = 8 / refinement,
        settings.of<FroxelSettings>().depth_slices = 8 * refinement;
        const double error =
            relative_rmse(scattered(froxels(view, stage.snapshot, as_wide(settings, view.size)), rays), truth);
        const double u = std::log(refinement), v = std::log(error);
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    EXPECT_LE((n * xy - x * y) / (n * xx - x * x), -0.5);
}
}
}
