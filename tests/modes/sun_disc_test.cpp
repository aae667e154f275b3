// Suns large enough to show as discs in a narrow phase function.
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Limitation* sun_disc(const Limitations& limitations) {
    const auto found =
        std::ranges::find_if(limitations, [](const Limitation& one) { return one.kind->id == "sun_disc"; });
    return found == limitations.end() ? nullptr : &*found;
}

// Henyey-Greenstein's peak by its mean over a cap, whose integral has a closed form.
double peak_by_mean(double g, double angle) {
    const double low = std::cos(angle), square = g * g;
    const double inside = (1 - square) / (2 * g) * (1 / (1 - g) - 1 / std::sqrt(1 + square - 2 * g * low));
    return (1 - square) / (4 * double{pi} * std::pow(1 - g, 3)) / (inside / (2 * double{pi} * (1 - low)));
}

TEST(SunDisc, IsMissedByNarrowLobesInEveryMode) {
    Light sun;
    sun.kind = LightKind::sun, sun.name = "sun", sun.direction = {0, -1, 0}, sun.intensity = vec3(1);
    Medium fog;
    fog.world_bounds = fog.density.bounds = {vec3(-1), vec3(1)};
    fog.optics.extinction = vec3(0.1f), fog.optics.albedo = vec3(1);
    View view;
    view.camera = look_at(vec3(0, 0, 4), vec3(0, 0, -1), vec3(0, 1, 0), 1), view.size = {8, 8};
    for (const auto& [g, degrees] : {std::pair{0.9f, 2.0f}, {0.5f, 0.27f}}) {
        sun.angle = glm::radians(degrees), fog.optics.phase = {PhaseKind::henyey_greenstein, g};
        Snapshot snapshot;
        snapshot.lights = {sun}, snapshot.media = {fog};
        for (const Mode& mode : modes()) {
            SCOPED_TRACE(mode.name);
            const Limitations said = mode.limitations(view, snapshot, {});
            const Limitation* disc = sun_disc(said);
            ASSERT_EQ(disc != nullptr, g > 0.6f);
            if (!disc) continue;
            EXPECT_NEAR(disc->amounts[0], 100 * (peak_by_mean(0.9, glm::radians(2.0)) - 1), 0.1);
            EXPECT_NEAR(disc->amounts[1], 2, 1e-5);
        }
    }
}
}
}
