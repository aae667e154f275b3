// The path tracer against closed forms, published values and conservation laws.
#include "base/random.h"
#include "modes/path/path_rays.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5; // a false alarm once in 150000 comparisons

// Within sampling error of the expected value, and precise enough to tell.
void expect_close(const RayEstimate& got, dvec3 expected, double precision, const std::string& what = {}) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(std::abs(got.value[c] - expected[c]), sigmas * got.error[c] + 2e-6 * std::abs(expected[c]))
            << what << " got " << got.value[c] << " ± " << got.error[c] << ", expected " << expected[c];
        EXPECT_LT(got.error[c], precision * std::abs(expected[c]) + 1e-12) << what;
    }
}
void expect_close(const RayEstimate& got, double expected, double precision, const std::string& what = {}) {
    expect_close(got, dvec3(expected), precision, what);
}

const Box unit_box{vec3(0), vec3(1)};
const Box slab{vec3(-1e4f, 0, -1e4f), vec3(1e4f, 1, 1e4f)};
const Phase isotropic{PhaseKind::isotropic, 0};
Medium with_albedo(Medium medium, vec3 albedo) {
    medium.optics.albedo = albedo;
    return medium;
}

Medium noise_grid(float extinction, Phase phase) {
    Medium medium = medium_of(unit_volume(32,
                                          [](vec3 p) {
                                              const uint32_t cell =
                                                  hash(static_cast<uint32_t>(p.x * 32), static_cast<uint32_t>(p.y * 32),
                                                       static_cast<uint32_t>(p.z * 32));
                                              return std::max(0.0f, 2 * to_unit(cell) - 0.8f);
                                          }),
                              extinction);
    medium.optics.phase = phase;
    return medium;
}

TEST(Path, WhiteFurnaceIsWhite) {
    // Albedo 1 in even surroundings: every ray sees radiance 1, whatever the fog.
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1))};
    for (const Medium& medium : {homogeneous_medium(3, unit_box, forward_phase(0.8f)),
                                 homogeneous_medium(3, unit_box, {PhaseKind::rayleigh, 0}),
                                 noise_grid(8, forward_phase(-0.5f)), noise_grid(2, isotropic)}) {
        Snapshot snapshot = snapshot_of({medium}, {}, vec3(1));
        snapshot.background.color = vec3(1);
        expect_close(traced(snapshot, ray, 512), 1, 0.005);
    }
}

TEST(Path, NightlyWhiteFurnaceIsWhiteToTwoPerMille) {
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1))};
    for (const float g : {-0.5f, 0.0f, 0.8f}) {
        Snapshot snapshot = snapshot_of(
            {noise_grid(6, forward_phase(g)), homogeneous_medium(1, unit_box, {PhaseKind::rayleigh, 0})}, {}, vec3(1));
        snapshot.background.color = vec3(1);
        expect_close(traced(snapshot, ray, 8192), 1, 0.002);
    }
}

TEST(Path, FurnaceWithSurfacesAndOverlappingFogIsWhite) {
    Scene scene;
    scene.materials = {lambert(vec3(1))};
    add_mesh(scene, box_of(vec3(0.2f), vec3(0.6f), 0));
    Snapshot snapshot = snapshot_of({noise_grid(4, forward_phase(0.6f)), homogeneous_medium(1, unit_box)}, {}, vec3(1));
    add_surfaces(scene, snapshot);
    snapshot.background.color = vec3(1);
    expect_close(traced(snapshot, {{0.4f, 0.45f, 3}, {0, 0, -1}}, 512), 1, 0.006);
}

// White, between clear and opaque.
Texture faded_texture() {
    Image<vec4> faded(ivec2(4, 4), vec4(1));
    for (int i = 0; i < 16; ++i) faded.at(i % 4, i / 4).w = to_unit(hash(static_cast<uint32_t>(i), 8u));
    Texture texture;
    texture.texels = shared_texels(std::move(faded));
    return texture;
}

// Glows with 1 - base color.
Material glowing_with_alpha(AlphaMode mode) {
    Material material = lambert(vec3(0.6f, 0.3f, 0), vec3(0.4f, 0.7f, 1));
    material.base_texture = 0, material.alpha_mode = mode;
    return material;
}

TEST(Path, FurnaceWithGlowingWallsThatLetLightThroughIsWhite) {
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        Scene scene;
        scene.materials = {glowing_with_alpha(mode)}, scene.textures = {faded_texture()};
        for (const float side : {-0.5f, 1.2f}) {
            add_mesh(scene, quad({-1, side, -1}, {3, 0, 0}, {0, 0, 3}, 0));
            add_mesh(scene, quad({-1, -1, side}, {3, 0, 0}, {0, 3, 0}, 0));
            scene.meshes.back().alphas = {1, 0.7f, 0.9f, 1};
        }
        Snapshot snapshot =
            snapshot_of({noise_grid(4, forward_phase(0.5f)), homogeneous_medium(0.3f, unit_box)}, {}, vec3(1));
        add_surfaces(scene, snapshot);
        snapshot.background.color = vec3(1);
        for (const Ray& ray : {Ray{{0.4f, 0.45f, 1.1f}, glm::normalize(vec3(0.1f, 0, -1))},
                               Ray{{0.4f, 0.45f, 3}, glm::normalize(vec3(0.1f, 0.1f, -1))}})
            expect_close(traced(snapshot, ray, 2048), 1, 0.006);
    }
}

TEST(Path, GlowingFurnaceIsEven) {
    // A closed box whose walls glow with 1 - base color: everything inside has radiance 1, fog of albedo 1 too.
    Scene scene;
    scene.materials = {lambert(vec3(0.6f, 0.3f, 0), vec3(0.4f, 0.7f, 1))};
    add_mesh(scene, box_of(vec3(-1), vec3(2), 0));
    Snapshot snapshot = snapshot_of({noise_grid(4, forward_phase(0.5f)), homogeneous_medium(0.3f, unit_box)}, {});
    add_surfaces(scene, snapshot);
    expect_close(traced(snapshot, {{0.4f, 0.45f, 1.5f}, glm::normalize(vec3(0.1f, 0, -1))}, 512), 1, 0.01);
}

// Slabs seen straight on in even light from one side only, by reciprocity the share of a perpendicular beam that comes
// back (R) or through (T). Van de Hulst 1980 and Wang, Jacques & Zheng 1995; others by adding-doubling.
struct SlabCase {
    float albedo, g, depth;
    double reflected, transmitted;
};
class PathSlab : public testing::TestWithParam<SlabCase> {};

RayEstimate slab_share(const SlabCase& c, bool reflected, int samples) {
    Medium fog = with_albedo(homogeneous_medium(c.depth, slab, forward_phase(c.g)), vec3(c.albedo));
    static Scene scene; // a black floor under the slab and the camera keeps light from below away
    if (scene.meshes.empty()) {
        scene.materials = {lambert(vec3(0))};
        add_mesh(scene, floor_of(-2, 1e5f, 0));
    }
    Snapshot snapshot = snapshot_of({fog}, {}, vec3(1));
    add_surfaces(scene, snapshot);
    if (reflected) return traced(snapshot, {{0.5f, 3, 0.5f}, {0, -1, 0}}, samples);
    snapshot.background.color = vec3(1);
    return traced(snapshot, {{0.5f, -1, 0.5f}, {0, 1, 0}}, samples);
}

TEST_P(PathSlab, ReflectsAndTransmitsAsPublished) {
    expect_close(slab_share(GetParam(), true, 1024), GetParam().reflected, 0.02, "R");
    expect_close(slab_share(GetParam(), false, 1024), GetParam().transmitted, 0.02, "T");
}

TEST_P(PathSlab, NightlyReflectsAndTransmitsAsPublishedToTwoPerMille) {
    expect_close(slab_share(GetParam(), true, 48000), GetParam().reflected, 0.002, "R");
    expect_close(slab_share(GetParam(), false, 24000), GetParam().transmitted, 0.002, "T");
}
INSTANTIATE_TEST_SUITE_P(
    Path, PathSlab,
    testing::Values(SlabCase{0.9f, 0.75f, 2, 0.09739, 0.66096}, SlabCase{1, 0, 1, 0.34133, 0.65867},
                    SlabCase{1, 0.5f, 1, 1 - 0.82389, 0.82389}, SlabCase{0.8f, 0, 4, 0.28402, 0.07508},
                    SlabCase{0.99f, 0.85f, 8, 0.30215, 0.55894}, SlabCase{0.9f, -0.5f, 2, 0.46277, 0.27607}));

TEST(Path, RadianceOfASunlitSlabAsPublished) {
    // Van de Hulst 1980, table 12: albedo .8, depth 2, isotropic, seen under cosine .5 with the sun at cosine mu0:
    // radiance = factor · mu0 · E / π.
    const struct {
        double mu0, above, below;
    } rows[] = {{1, 0.28616, 0.14864}, {0.9, 0.30277, 0.14731}, {0.7, 0.34188, 0.13963}, {0.3, 0.45353, 0.09425}};
    for (const auto& row : rows) {
        const float sine = static_cast<float>(std::sqrt(1 - row.mu0 * row.mu0));
        const Light light = sun_light({sine, -static_cast<float>(row.mu0), 0}, static_cast<float>(pi / row.mu0));
        const Snapshot snapshot = snapshot_of({with_albedo(homogeneous_medium(2, slab), vec3(0.8f))}, {light});
        const vec3 down = glm::normalize(vec3(0, -0.5f, std::sqrt(0.75f)));
        expect_close(traced(snapshot, {vec3(0, 3, 0), down}, 1024), row.above, 0.01, "above");
        expect_close(traced(snapshot, {vec3(0, -2, 0), vec3(0, 0.5f, down.z)}, 1024), row.below, 0.01, "below");
    }
}

TEST(Path, OneOrderIsTheClosedFormOfSingleScattering) {
    // Slab, isotropic: factor = w/4 · mu0/(mu+mu0) · (1 - e^(-tau(1/mu+1/mu0))) / mu0, radiance = factor · mu0 E / π.
    const double albedo = 0.9, depth = 2, mu0 = 1, mu = 0.5;
    const double factor = albedo / (4 * (mu + mu0)) * (1 - std::exp(-depth * (1 / mu + 1 / mu0)));
    EXPECT_NEAR(factor, 0.149628187, 1e-8);
    const Snapshot snapshot =
        snapshot_of({with_albedo(homogeneous_medium(2, slab), vec3(0.9f))}, {sun_light({0, -1, 0}, pi)});
    const Ray ray{{0, 3, 0}, glm::normalize(vec3(0, -0.5f, std::sqrt(0.75f)))};
    expect_close(traced(snapshot, ray, 512, 1), factor, 0.005);
}

TEST(Path, PointLightInEvenFogIsTheAirlightIntegral) {
    const struct {
        float extinction, h, a, expected;
    } rows[] = {
        {1, 1, 1, 0.01745864f}, {0.1f, 1, 5, 0.01151431f}, {0.5f, 0.1f, 2, 0.40195407f}, {2, 0.5f, 0.5f, 0.06983456f}};
    for (const auto& row : rows) {
        const Snapshot snapshot = snapshot_of({homogeneous_medium(row.extinction)}, {point_light({0, row.h, -row.a})});
        expect_close(traced(snapshot, {{0, 0, 0}, {0, 0, -1}}, 1024, 1), row.expected, 0.01);
    }
}

TEST(Path, EmissionAbsorptionIsItsClosedForm) {
    Snapshot snapshot = snapshot_of({with_albedo(homogeneous_medium(0.5f, {vec3(-1.5f), vec3(1.5f)}), vec3(0))}, {});
    snapshot.media[0].optics.emission.radiance = vec3(1);
    const Ray ray{{0, 0, 5}, {0, 0, -1}, 20};
    expect_close(traced(snapshot, ray, 1024), 1.553739680, 0.005);

    // Thin fog is asked along the ray, and dimmed by the other fog on it.
    snapshot.media[0].optics.extinction = vec3(0.25f);
    expect_close(traced(snapshot, ray, 1024), (1 - std::exp(-0.75)) / 0.25, 0.002);
    snapshot.media.push_back(with_albedo(homogeneous_medium(0.75f, {vec3(-1.5f), vec3(1.5f)}), vec3(0)));
    expect_close(traced(snapshot, ray, 1024), 1 - std::exp(-3), 0.002);
}

TEST(Path, SurfaceUnderFogIsItsClosedForm) {
    // Sun at 60 degrees onto a floor below one meter of fog, seen straight down: base/π · E mu0 · e^(-s/mu0) · e^(-s).
    Scene scene;
    scene.materials = {lambert({0.8f, 0.4f, 0.2f})};
    add_mesh(scene, floor_of(-0.5f, 100, 0));
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.7f, slab)}, {sun_light({std::sqrt(0.75f), -0.5f, 0}, 3)});
    add_surfaces(scene, snapshot);
    const RayEstimate got = estimate_ray(path_mode(snapshot, 1), {{0, 4, 0}, {0, -1, 0}}, 64, surface_light);
    expect_close(got, dvec3(0.8, 0.4, 0.2) * (3 * 0.5 / M_PI * std::exp(-0.7 * 2 - 0.7)), 0.001);
}

TEST(Path, LightBouncesBetweenSurfaces) {
    // Two large parallel plates, no fog: the upper glows with 1, the lower reflects rho, both see only each other:
    // radiance of the lower = rho · (1 + up) with up = sigma · lower; lower = rho / (1 - rho sigma).
    Scene scene;
    scene.materials = {lambert(vec3(0.5f)), lambert(vec3(0.4f), vec3(1))};
    add_mesh(scene, floor_of(0, 3000, 0));
    add_mesh(scene, floor_of(1, 3000, 1));
    Snapshot snapshot = snapshot_of({}, {});
    add_surfaces(scene, snapshot);
    const Ray ray{{0, 0.5f, 0}, {0, -1, 0}};
    expect_close(traced(snapshot, ray, 1024), 0.5 / (1 - 0.5 * 0.4), 0.01);
    expect_close(traced(snapshot, ray, 1024, 1), 0.5, 0.01);
    expect_close(traced(snapshot, ray, 1024, 2), 0.5, 0.01);
    expect_close(traced(snapshot, ray, 1024, 3), 0.5 + 0.5 * 0.4 * 0.5, 0.01);
}

TEST(Path, GlowOnFogIsTheSameAimedAtOrFoundByChance) {
    // A glowing disc-like quad above a fog box; without the snapshot's scene, paths do not know where to aim.
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        Scene scene;
        scene.materials = {glowing_with_alpha(mode)}, scene.textures = {faded_texture()};
        add_mesh(scene, quad({-0.5f, 1.2f, -0.5f}, {2, 0, 0}, {0, 0, 2}, 0));
        Snapshot snapshot = snapshot_of({noise_grid(4, forward_phase(0.5f))}, {});
        add_surfaces(scene, snapshot);
        RayEstimate results[2];
        for (const bool aimed : {false, true}) {
            snapshot.scene = aimed ? &scene : nullptr;
            results[aimed] = traced(snapshot, {{0.4f, 0.45f, 3}, {0, 0, -1}}, 4096);
        }
        for (int c = 0; c < 3; ++c) {
            const double error = glm::length(glm::dvec2(results[0].error[c], results[1].error[c]));
            EXPECT_LT(std::abs(results[0].value[c] - results[1].value[c]), sigmas * error);
            EXPECT_LT(error, 0.02 * results[0].value[c]);
        }
    }
}

TEST(Path, BlendSurfacesLetTheirShareThrough) {
    Scene scene;
    scene.materials = {blend_material(0.3f)};
    scene.materials[0].base_color = vec3(0);
    add_mesh(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 0));
    add_mesh(scene, quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, 0));
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, {vec3(-2), vec3(2)})}, {});
    add_surfaces(scene, snapshot);
    snapshot.background.color = vec3(1);
    const Ray ray{{0.1f, 0.2f, 5}, {0, 0, -1}};
    const RayEstimate got = estimate_ray(path_mode(snapshot), ray, 16, all_light);
    expect_close(got, 0.7 * 0.7 * std::exp(-2.0), 1e-5);
    const RayEstimate passing =
        estimate_ray(path_mode(snapshot), ray, 16, [](const Scatter& s) { return vec3(s.transmittance); });
    expect_close(passing, std::exp(-2.0), 1e-5);
}

TEST(Path, GridOfOneValueIsEvenFog) {
    const Ray ray{{0.4f, 0.45f, 3}, glm::normalize(vec3(0.02f, 0.05f, -1))};
    const SparseVolume full = unit_volume(32, [](vec3) { return 0.5f; });
    Medium grid = with_albedo(medium_of(full, 4), vec3(0.9f));
    const Medium even = with_albedo(homogeneous_medium(2, grid.density.bricks->bounds), vec3(0.9f));
    const Light light = sun_light({0.3f, -1, -0.2f});
    const RayEstimate a = traced(snapshot_of({grid}, {light}), ray, 1024),
                      b = traced(snapshot_of({even}, {light}), ray, 1024);
    // The outermost half voxel of a grid fades out: its mass is the same to 3/32 of a percent only across the middle.
    EXPECT_NEAR(a.value.x, b.value.x, sigmas * std::hypot(a.error.x, b.error.x) + 0.02 * b.value.x);
}

TEST(Path, OneOrderEqualsTheMarchInShadowedFog) {
    Scene scene;
    scene.materials = {lambert(vec3(0.5f))};
    add_mesh(scene, quad({0.3f, 1.1f, -1}, {0.3f, 0, 0}, {0, 0, 3}, 0));
    add_mesh(scene, floor_of(-0.2f, 5, 0));
    Medium banks = noise_grid(3, forward_phase(0.6f));
    banks.optics.albedo = vec3(0.9f, 0.6f, 0.3f);
    Light spot = spot_light({0.5f, 2, 0.5f}, {0, -1, 0}, 4, 0.2f, 0.5f);
    spot.volume_scale = 2;
    Snapshot snapshot = snapshot_of({banks, homogeneous_medium(0.2f, {vec3(-1), vec3(2)})},
                                    {sun_light({0.3f, -1, -0.2f}, 2), spot, point_light({0.2f, 0.3f, 0.4f}, 0.1f)});
    add_surfaces(scene, snapshot);
    Settings fine = exact_settings();
    fine.march.step_voxels = 0.1f, fine.march.step_share = 1.0f / 4000;
    for (const vec3 origin : {vec3(0.4f, 0.45f, 3), vec3(0.7f, 0.8f, 3), vec3(0.1f, 0.3f, 3)}) {
        const Ray ray{origin, {0, 0, -1}, 5};
        const RayEstimate got = estimate_ray(path_mode(snapshot, 1), ray, 4096, fog_light);
        const dvec3 expected(marched(snapshot, fine, ray).radiance);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(got.value[c], expected[c], sigmas * got.error[c] + 0.002 * expected[c]) << got.error[c];
        EXPECT_LT(got.error.x, 0.01 * got.value.x);
    }
}

TEST(Path, SunInFogWithoutBoundsOrAnythingElse) {
    // Level ray in height fog under a sun overhead: even along the ray. Light path above y: s e^-y.
    Medium fog = homogeneous_medium(0.2f);
    fog.density.kind = DensityKind::height, fog.density.height_falloff = 1;
    Snapshot snapshot = snapshot_of({fog}, {sun_light({0, -1, 0}, 3)});
    snapshot.bounds = Box{};
    const double density = 0.2 * std::exp(-0.5);
    const double expected = 3 / (4 * M_PI) * std::exp(-density) * (1 - std::exp(-4 * density));
    expect_close(traced(snapshot, {{0, 0.5f, 0}, {0, 0, -1}, 4}, 256, 1), expected, 0.01);
    const double endless = 3 / (4 * M_PI) * std::exp(-density);
    expect_close(traced(snapshot, {{0, 0.5f, 0}, {0, 0, -1}}, 1024, 1), endless, 0.01);
}

TEST(Path, MistFarBelowALevelSunTakesNothing) {
    Medium mist = homogeneous_medium(0.2f);
    mist.density.kind = DensityKind::height, mist.density.height_falloff = 1;
    const Box high{vec3(-1, 199, -1), vec3(1, 201, 1)};
    const Snapshot snapshot = snapshot_of({mist, homogeneous_medium(0.5f, high)}, {sun_light({1, 0, 0}, 3)});
    const double expected = 3 / (4 * M_PI) * std::exp(-0.5) * (1 - std::exp(-1.0));
    expect_close(traced(snapshot, {{0, 200, 4}, {0, 0, -1}}, 256, 1), expected, 0.01);
}

TEST(Path, ThickPlumesWithGapsHideNothingBehindThem) {
    // Two opaque halves with a gap between them; behind the gap thin haze is lit.
    const SparseVolume walls = unit_volume(32, [](vec3 p) { return p.x > 0.4f && p.x < 0.6f ? 0.0f : 1.0f; });
    Medium plume = with_albedo(medium_of(walls, 400), vec3(0));
    const Box behind{vec3(-1, -1, -3), vec3(2, 2, -1)};
    const Snapshot snapshot = snapshot_of({plume, homogeneous_medium(0.2f, behind)}, {sun_light({0, -1, 0}, 3)});
    const double expected = 3 / (4 * M_PI) * std::exp(-0.2 * 1.5) * (1 - std::exp(-0.4));
    expect_close(traced(snapshot, {{0.5f, 0.5f, 4}, {0, 0, -1}}, 256, 1), expected, 0.03);
}

TEST(Path, LampVeryFarAwayIsASun) {
    Light lamp = point_light({0, 2e7f, 0}, 4e14f);
    Medium fog = noise_grid(3, forward_phase(0.4f));
    const Ray ray{{0.4f, 0.45f, 3}, {0, 0, -1}};
    const RayEstimate far = traced(snapshot_of({fog}, {lamp}), ray, 512, 1),
                      near = traced(snapshot_of({fog}, {sun_light({0, -1, 0})}), ray, 512, 1);
    EXPECT_NEAR(far.value.x, near.value.x, sigmas * std::hypot(far.error.x, near.error.x));
    EXPECT_LT(far.error.x, 0.02 * far.value.x);
}

TEST(Path, LightsArePartsOfTheWhole) {
    const Snapshot snapshot =
        snapshot_of({noise_grid(3, forward_phase(0.4f))}, {sun_light({0.3f, -1, -0.2f}), point_light({0.5f, 2, 0.5f})});
    const ScatterFunction scatter = path_mode(snapshot);
    const std::vector<Ray> rays(16, Ray{{0.4f, 0.45f, 3}, {0, 0, -1}});
    for (uint32_t i = 0; i < 50; ++i) {
        std::vector<uint32_t> ids(16);
        for (uint32_t lane = 0; lane < 16; ++lane) ids[lane] = i * 16 + lane;
        std::vector<vec3> parts(16 * part_count(2), vec3(0));
        std::vector<Scatter> results(16);
        scatter({.rays = rays, .ids = ids, .parts = parts}, results);
        for (size_t lane = 0; lane < 16; ++lane) {
            const vec3 sum = parts[part_count(2) * lane] + parts[part_count(2) * lane + 1];
            EXPECT_NEAR(sum.x, all_light(results[lane]).x, 1e-5f * (1 + sum.x));
        }
    }
}
}
}
