// Furnaces: fog and surfaces of albedo 1 in an environment of radiance 1 are seen as 1, for every phase function.
#include "modes/path/path_rays.h"
#include "scene/scene.h"
#include "support/tiny_scenes.h"
#include "trace/lights/environment.h"
#include "volume/medium.h"
#include "volume/phase/phase_samples.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5; // a false alarm once in 150000 comparisons

std::vector<NamedPhase> phases_of_each_kind() {
    return {{"isotropic", {PhaseKind::isotropic}},
            {"forward", forward_phase(0.9f)},
            {"backward", forward_phase(-0.5f)},
            {"schlick", {PhaseKind::schlick, 0.4f}},
            {"rayleigh", {PhaseKind::rayleigh}},
            {"draine", draine_phase(0.6, 3)},
            {"droplets of 0.05", mie_phase(0.05)},
            {"droplets of 3", mie_phase(3)},
            {"droplets of 20", mie_phase(20)},
            {"two lobes", mixed_phase(0.6, forward_phase(0.95f), forward_phase(-0.9f))},
            {"droplets and air", mixed_phase(0.4, mie_phase(8), {PhaseKind::rayleigh})},
            {"table", tabulated_bow(0.9)},
            {"halo", tabulated({{0, 3}, {21, 0.5}, {22, 30}, {23, 0.3}, {90, 0.05}, {180, 0.1}})},
            {"legendre", legendre_of(0.7, 60)}};
}

TEST(Furnace, EachKindOfPhaseFunctionIsTried) {
    std::set<PhaseKind> kinds;
    for (const NamedPhase& one : phases_of_each_kind()) kinds.insert(one.phase.kind);
    EXPECT_EQ(kinds.size(), std::size(phase_kinds));
}

// Uneven fog in even fog, around a white box or not.
TestScene furnace(const Phase& phase, bool with_box) {
    const Medium even = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, phase);
    Medium cloud = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 6);
    cloud.optics.phase = phase, cloud.optics.albedo = vec3(1);
    TestScene stage = make_scene({cloud, even}, {}, {});
    stage.scene->materials = {lambert(vec3(1))};
    if (with_box) add_mesh(*stage.scene, box_of({0.2f, 0.1f, 0.3f}, {0.7f, 0.5f, 0.8f}, 0));
    add_surfaces(*stage.scene, stage.snapshot);
    stage.snapshot.background.color = vec3(1);
    stage.snapshot.environment = make_environment(stage.snapshot.background);
    return stage;
}

// Within sampling error, and precise enough to tell.
void expect_white(const NamedPhase& one, bool with_box, int samples, double precision) {
    const Ray ray{{0.4f, 0.35f, 3}, glm::normalize(vec3(0.05f, -0.02f, -1))};
    const RayEstimate found = traced(furnace(one.phase, with_box).snapshot, ray, samples);
    EXPECT_NEAR(found.value.x, 1, sigmas * found.error.x + 1e-5) << one.name << (with_box ? ", white box" : "");
    EXPECT_LT(found.error.x, precision) << one.name;
}

TEST(Furnace, IsWhiteForEachPhaseFunctionAroundAWhiteBox) {
    for (const NamedPhase& one : phases_of_each_kind()) expect_white(one, true, 2048, 0.0025);
}

TEST(Furnace, NightlyIsWhiteForEachPhaseFunctionToFivePerMille) {
    for (const NamedPhase& one : phases_of_each_kind())
        for (const bool with_box : {false, true}) expect_white(one, with_box, 1 << 14, 0.005 / sigmas);
}
}
}
