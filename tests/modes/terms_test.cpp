// Terms that are off, in every mode that reads them: the light of a scene that does not have them.
#include "integrate/style.h"
#include "modes/froxel/froxel_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
struct WithoutTerm {
    const char* row;
    void (*take_out)(Snapshot& snapshot);
};

constexpr WithoutTerm terms[] = {
    {"terms.phase",
     [](Snapshot& snapshot) {
         for (Medium& medium : snapshot.media) medium.optics.phase.kind = PhaseKind::isotropic;
     }},
    {"terms.heterogeneity", [](Snapshot& snapshot) { snapshot.media = homogeneous_media(snapshot.media); }},
    {"terms.emission",
     [](Snapshot& snapshot) {
         for (Medium& medium : snapshot.media) medium.optics.emission.radiance = vec3(0);
     }},
    {"terms.ambient", [](Snapshot& snapshot) { snapshot.ambient = vec3(0); }},
};

TEST(Terms, OffIsASceneWithoutThem) {
    Medium cloud = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 2.5f);
    cloud.optics.phase = {PhaseKind::henyey_greenstein, 0.6f};
    cloud.optics.emission.radiance = vec3(0.1f);
    const Snapshot snapshot = snapshot_of({cloud}, {point_light({1.5f, 1.3f, 0.4f}, 1)}, vec3(0.2f));
    const View view = view_of({0.5f, 0.8f, 3}, {0.5f, 0.5f, 0.5f}, {32, 18});
    const std::vector<Ray> rays = pixel_rays(view, snapshot, 10);
    int compared = 0;
    for (const Mode& mode : modes()) {
        for (const WithoutTerm& term : terms) {
            if (!reads(mode, term.row)) continue;
            const Settings all = settings_for(Quality::preview);
            Settings off = all;
            apply_setting(off, std::string(term.row) + "=off");
            Snapshot without = snapshot;
            term.take_out(without);
            const auto whole = scattered(mode.prepare(view, snapshot, all, nullptr), rays);
            const auto switched = scattered(mode.prepare(view, snapshot, off, nullptr), rays);
            const auto taken_out = scattered(mode.prepare(view, without, all, nullptr), rays);
            for (size_t i = 0; i < rays.size(); ++i)
                ASSERT_EQ(switched[i].radiance, taken_out[i].radiance) << mode.name << " " << term.row << " ray " << i;
            // The cone takes every medium at its mean density anyway.
            const bool homogeneous = mode.name == "cone" && term.row == std::string("terms.heterogeneity");
            if (!homogeneous) {
                EXPECT_GT(relative_rmse(switched, whole), 0.01) << mode.name << " " << term.row;
            }
            ++compared;
        }
    }
    EXPECT_EQ(compared, 4 * 6);
}
}
}
