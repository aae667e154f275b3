// Fog between shadow volumes, against closed forms and the deterministic reference.
#include "integrate/single_scattering/single_scattering.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "modes/shadow_volume/limitations.h"
#include "modes/shadow_volume/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include "base/parallel.h"
#include "scene/mesh.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tyndall::test {
namespace {
// The rays of a small picture, packet by packet, as the renderer asks.
struct Picture {
    View view;
    std::vector<Ray> rays;
    std::vector<vec2> positions;
};

Picture picture_of(const Camera& camera, const Snapshot& snapshot, float t_max) {
    Picture picture;
    picture.view.camera = camera, picture.view.size = {32, 32}, picture.view.filter = PixelFilter::center;
    for (int tile = 0; tile < 64; ++tile) {
        for (int i = 0; i < 16; ++i) {
            const vec2 p(4 * (tile % 8) + i % 4 + 0.5f, 4 * (tile / 8) + i / 4 + 0.5f);
            picture.positions.push_back(p);
            picture.rays.push_back(camera_ray(camera, picture.view.size, p));
        }
        Hits hits;
        hits.instance.fill(-1);
        const std::span<Ray> last = std::span(picture.rays).last(16);
        if (snapshot.occluders) snapshot.occluders->closest(last, 0, hits);
        for (int i = 0; i < 16; ++i) last[i].t_max = hits.instance[i] < 0 ? t_max : std::min(t_max, hits.t[i]);
    }
    return picture;
}

std::vector<Scatter> drawn(std::string_view mode, const Picture& picture, const Snapshot& snapshot,
                           const Settings& settings) {
    const ScatterFunction scatter = find_mode(mode).prepare(picture.view, snapshot, settings, nullptr);
    std::vector<Scatter> results(picture.rays.size());
    const std::vector<uint32_t> ids(16, 7);
    for (size_t first = 0; first < results.size(); first += 16)
        scatter({.rays = std::span(picture.rays).subspan(first, 16),
                 .ids = ids,
                 .positions = std::span(picture.positions).subspan(first, 16)},
                std::span(results).subspan(first, 16));
    return results;
}

const Box room{vec3(-3, 0, -3), vec3(3, 4, 3)};
std::vector<Mesh> furniture() {
    return {box_of({-1, 1, -1}, {-0.2f, 1.6f, 0.4f}), box_of({0.4f, 2, -0.5f}, {1.2f, 2.1f, 0.9f}),
            quad({-2, 2.6f, -0.2f}, {1.7f, 0, 0.3f}, {0, 0.4f, 1}), quad({0.2f, 0.5f, -2}, {0, 1.5f, 0}, {1, 0, 0.4f})};
}
std::vector<Light> all_lights() {
    return {sun_light({0.4f, -1, 0.2f}, 2), point_light({0.3f, 2.8f, 0.2f}, 3),
            spot_light({-1, 3.5f, 1.5f}, {0.3f, -1, -0.5f}, 9, 0.25f, 0.5f)};
}
const Camera cameras[] = {look_at({2.5f, 1.5f, 5}, {0, 1.5f, 0}, {0, 1, 0}, 0.9f),
                          look_at({-0.5f, 0.6f, -0.2f}, {1, 1.2f, 1}, {0, 1, 0}, 1.3f)}; // the second in a shadow

TEST(ShadowVolume, SunUnderARoofByHand) {
    // Without light-side dimming (the sun is level with the roof's end of the fog) half the path is lit.
    const Box thin{vec3(-4, -0.001f, -1), vec3(4, 0.001f, 1)};
    const TestScene stage = make_scene({homogeneous_medium(0.5f, thin)}, {sun_light({0, -1, 0}, 3)},
                                       {quad({0, 1, -2}, {5, 0, 0}, {0, 0, 4})});
    Picture picture;
    picture.rays.assign(16, {{-4, 0, 0}, {1, 0, 0}, 8});
    picture.view.camera = look_at({-4, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1);
    picture.positions.assign(16, vec2(320, 180));
    const Scatter result = drawn("shadow-volume", picture, stage.snapshot, {})[3];
    const double dimmed = std::exp(-0.5 * 0.001); // through half the slab
    EXPECT_NEAR(result.radiance.x, 3 * dimmed * (1 - std::exp(-0.5 * 4)) / (4 * std::numbers::pi), 1e-6);
    EXPECT_NEAR(result.transmittance, std::exp(-0.5 * 8), 1e-7);
    EXPECT_EQ(result.validity, 1);
}

TEST(ShadowVolume, EqualsTheReferenceInEvenFog) {
    for (const Light& light : all_lights()) {
        const TestScene stage =
            make_scene({homogeneous_medium(0.3f, room, {PhaseKind::henyey_greenstein, 0.5f})}, {light}, furniture());
        for (const Camera& camera : cameras) {
            const Picture picture = picture_of(camera, stage.snapshot, 20);
            const std::vector<Scatter> expected = drawn("march", picture, stage.snapshot, exact_settings());
            const std::vector<Scatter> found = drawn("shadow-volume", picture, stage.snapshot, {});
            EXPECT_GT(mean_of(expected), 1e-4);
            EXPECT_LT(rms_difference(found, expected) / mean_of(expected), 1e-4) << light.name;
            for (size_t i = 0; i < found.size(); ++i) {
                EXPECT_NEAR(found[i].transmittance, expected[i].transmittance, 1e-5);
                EXPECT_GE(found[i].radiance.x, 0);
            }
        }
    }
}

TEST(ShadowVolume, HeightFogAmbientAndSeveralMedia) {
    Medium height = homogeneous_medium(0.4f, room);
    height.density.kind = DensityKind::height, height.density.height_base = 0.5f, height.density.height_falloff = 0.8f;
    Medium other = homogeneous_medium(0.1f, Box{vec3(-1), vec3(1.5f)}, {PhaseKind::rayleigh, 0});
    other.optics.albedo = vec3(0.9f, 0.5f, 0.2f);
    const auto check = [&] {
        const TestScene stage = make_scene({height, other}, all_lights(), furniture(), vec3(0.1f, 0.2f, 0.3f));
        const Picture picture = picture_of(cameras[0], stage.snapshot, 20);
        const std::vector<Scatter> expected = drawn("march", picture, stage.snapshot, exact_settings()),
                                   found = drawn("shadow-volume", picture, stage.snapshot, {});
        EXPECT_LT(rms_difference(found, expected) / mean_of(expected), 2e-3);
    };
    check();
    height.optics.emission.radiance = {0.02f, 0.01f, 0}, height.optics.albedo = other.optics.albedo = vec3(0);
    check(); // lamps stand for what is scattered of it
}

TEST(ShadowVolume, OrthographicCamerasAndStretchesBehindBlendSurfaces) {
    const TestScene stage = make_scene({homogeneous_medium(0.3f, room)}, all_lights(), furniture());
    Camera flat = cameras[0];
    flat.ortho_height = 4;
    const Picture picture = picture_of(flat, stage.snapshot, 20);
    const std::vector<Scatter> expected = drawn("march", picture, stage.snapshot, exact_settings());
    EXPECT_LT(rms_difference(drawn("shadow-volume", picture, stage.snapshot, {}), expected) / mean_of(expected), 1e-3);

    // The same stretch, begun anywhere on the line from the camera; and rays of no camera at all.
    for (const float skip : {0.5f, 2.5f, 4.0f}) {
        Picture behind = picture_of(cameras[0], stage.snapshot, 20);
        for (Ray& ray : behind.rays) ray = {ray.at(skip), ray.direction, std::max(ray.t_max - skip, 0.0f)};
        const std::vector<Scatter> rest = drawn("march", behind, stage.snapshot, exact_settings());
        EXPECT_LT(rms_difference(drawn("shadow-volume", behind, stage.snapshot, {}), rest) / mean_of(rest), 1e-3);
        behind.view.camera.position += vec3(0.3f, 0.1f, 0);
        EXPECT_LT(rms_difference(drawn("shadow-volume", behind, stage.snapshot, {}), rest) / mean_of(rest), 1e-3);
    }
}

TEST(ShadowVolume, SampledFogApproachesTheReference) {
    const auto wavy = [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::cos(7 * p.y + 4 * p.z); };
    const TestScene stage = make_scene({medium_of(unit_volume(32, wavy), 2)},
                                       {sun_light({0.4f, -1, 0.2f}, 2), point_light({0.4f, 1.3f, 0.6f}, 1)},
                                       {box_of({0.2f, 0.7f, 0.2f}, {0.5f, 0.8f, 0.6f})});
    const Picture picture =
        picture_of(look_at({0.5f, 0.5f, 2.5f}, {0.5f, 0.5f, 0.5f}, {0, 1, 0}, 0.6f), stage.snapshot, 9);
    const std::vector<Scatter> expected = drawn("march", picture, stage.snapshot, exact_settings());
    double before = 1;
    for (const char* steps : {"shadow_volume.steps=12", "shadow_volume.steps=48", "shadow_volume.steps=192"}) {
        Settings settings;
        apply_setting(settings, steps);
        apply_setting(settings, "terms.light_resolution=128");
        const std::vector<Scatter> found = drawn("shadow-volume", picture, stage.snapshot, settings);
        const double error = rms_difference(found, expected) / mean_of(expected);
        EXPECT_LT(error, before);
        before = error;
        EXPECT_EQ(found[500].validity, 1);
    }
    EXPECT_LT(before, 0.01); // what the light's grid of 128 cells leaves
    Settings even;
    even.of<ShadowVolumeSettings>().fog = ShadowFog::homogeneous;
    EXPECT_EQ(drawn("shadow-volume", picture, stage.snapshot, even)[500].validity, 0);
    const Limitations said = find_mode("shadow-volume").limitations(picture.view, stage.snapshot, even);
    EXPECT_TRUE(has_limitation(said, limitation::drawn_as_homogeneous));
}

TEST(ShadowVolume, DeepStepsKeepTheirLight) {
    // Fog 20 deep in 4 steps, lit evenly: E p a (1 - e^-20), whatever the steps. A lamp far away is as even, but has
    // two nodes a step: the second stands for 2.5 to 5, and lies 0.19 too deep for the middle of that. The
    // first of later steps, as much too near, make up for a tenth of it.
    const Light far = point_light({0, 300, 0}, 9e4f);
    const double too_deep = std::exp(-2.5) * std::expm1(-2.5) * std::expm1(-5 * (std::sqrt(1.0 / 12) - 0.25));
    Settings settings;
    settings.terms.light = LightTransmittance::off, settings.of<ShadowVolumeSettings>().fog = ShadowFog::sampled;
    settings.of<ShadowVolumeSettings>().steps = 4;
    for (const auto& [light, missing] : {std::pair(sun_light({0, -1, 0}), 0.0), {far, too_deep}}) {
        const Snapshot snapshot =
            snapshot_of({homogeneous_medium(5, {vec3(-1, -0.5f, -2), vec3(1, 0.5f, 2)})}, {light});
        const View view = view_of({0, 0, 5}, vec3(0));
        const Ray ray{{0, 0, 5}, {0, 0, -1}, 10};
        const float found = run_mode("shadow-volume", view, snapshot, settings, {ray})[0].radiance.x;
        EXPECT_NEAR(double{found} * 4 * std::numbers::pi, 1 - missing, missing > 0 ? 0.1 * missing : 1e-5);
        const Limitations said = find_mode("shadow-volume").limitations(view, snapshot, settings);
        const auto deep = std::ranges::find(said, &limitation::deep_steps, &Limitation::kind);
        ASSERT_NE(deep, said.end());
        EXPECT_EQ(deep->severity, Severity::wrong);
    }
}

TEST(ShadowVolume, EndlessFogAndFarEnds) {
    const TestScene stage =
        make_scene({homogeneous_medium(0.2f)}, {sun_light({1, -1e-3f, 0}, 2), point_light({0, 3, 0}, 5)}, furniture());
    Picture picture = picture_of(cameras[0], stage.snapshot, 1e6f);
    for (const Scatter& result : drawn("shadow-volume", picture, stage.snapshot, {})) {
        EXPECT_TRUE(is_finite(result.radiance));
        EXPECT_GE(result.radiance.x, 0);
    }
    // Closed form: an isotropic sun that nothing dims.
    Light light = sun_light({0, 0, -1}, 2);
    Medium fog = homogeneous_medium(1e-4f);
    fog.density.bounds = fog.world_bounds = {vec3(-1e6f, -1e6f, -1), vec3(1e6f, 1e6f, 1)};
    Picture level;
    level.view.camera = look_at({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    level.rays.assign(16, {{0, 0, 0}, {1, 0, 0}, 1e6f}), level.positions.assign(16, vec2(320, 180));
    const Scatter result = drawn("shadow-volume", level, snapshot_of({fog}, {light}), {})[0];
    EXPECT_NEAR(result.radiance.x * 4 * std::numbers::pi / 2, 1 - std::exp(-1e-4 * 1e6), 2e-4);
}

TEST(ShadowVolume, ShellsAreALookAndSaySo) {
    const TestScene stage = make_scene({homogeneous_medium(0.3f, room)}, {sun_light({0.4f, -1, 0.2f}, 2)}, furniture());
    const Picture picture = picture_of(cameras[0], stage.snapshot, 20);
    Settings shells, brighter;
    shells.of<ShadowVolumeSettings>().draw = brighter.of<ShadowVolumeSettings>().draw = ShadowDraw::shells;
    brighter.of<ShadowVolumeSettings>().shell_intensity *= 2;
    const std::vector<Scatter> one = drawn("shadow-volume", picture, stage.snapshot, shells);
    const std::vector<Scatter> two = drawn("shadow-volume", picture, stage.snapshot, brighter);
    EXPECT_GT(mean_of(one), 0);
    EXPECT_NEAR(mean_of(two) / mean_of(one), 2, 1e-5);
    EXPECT_EQ(one[100].validity, 0);
    const Limitations said = find_mode("shadow-volume").limitations(picture.view, stage.snapshot, shells);
    EXPECT_TRUE(has_limitation(said, limitation::shells));
    shells.of<ShadowVolumeSettings>().shell_length = 1e-3f; // nothing shows that near its occluder
    EXPECT_LT(mean_of(drawn("shadow-volume", picture, stage.snapshot, shells)), 0.01 * mean_of(one));
}

TEST(ShadowVolume, ShellsKeepAmbientLightAndScaleWithTheScene) {
    const vec3 ambient(0.1f, 0.2f, 0.3f);
    const TestScene stage =
        make_scene({homogeneous_medium(0.3f, room)}, {sun_light({0.4f, -1, 0.2f}, 2)}, furniture(), ambient);
    const Picture picture = picture_of(cameras[0], stage.snapshot, 20);
    Settings shells, measured;
    shells.of<ShadowVolumeSettings>().draw = measured.of<ShadowVolumeSettings>().draw = ShadowDraw::shells;
    const Box& bounds = stage.snapshot.bounds;
    measured.of<ShadowVolumeSettings>().shell_length = 0.5f * glm::distance(bounds.low, bounds.high);
    const std::vector<Scatter> found = drawn("shadow-volume", picture, stage.snapshot, shells);
    EXPECT_EQ(rms_difference(found, drawn("shadow-volume", picture, stage.snapshot, measured)), 0);

    shells.of<ShadowVolumeSettings>().shell_intensity = 0;
    const std::vector<Scatter> dark = drawn("shadow-volume", picture, stage.snapshot, shells);
    for (size_t i = 0; i < dark.size(); ++i) // albedo 1: what the fog takes away, of the ambient light
        EXPECT_NEAR(dark[i].radiance.z, ambient.z * (1 - dark[i].transmittance), 1e-6f);
    EXPECT_GT(mean_of(found), mean_of(dark));
}

TEST(ShadowVolume, LimitationsNameSoftLightsAndAlpha) {
    Light soft = sun_light({0, -1, 0});
    soft.angle = 0.01f;
    TestScene stage = make_scene({homogeneous_medium(0.1f, room)}, {soft}, furniture());
    const auto said = [](const Snapshot& snapshot) {
        return find_mode("shadow-volume").limitations(View{}, snapshot, {});
    };
    EXPECT_TRUE(has_limitation(said(stage.snapshot), limitation::hard_shadows));
    EXPECT_FALSE(has_limitation(said(stage.snapshot), limitation::no_alpha_shadows));
    Material glass;
    glass.alpha_mode = AlphaMode::blend, glass.alpha = 0.5f;
    stage.scene->materials.push_back(glass), stage.scene->meshes[0].material = 0;
    stage.snapshot.occluders = Occluders::make(*stage.scene, 0, nullptr);
    EXPECT_TRUE(has_limitation(said(stage.snapshot), limitation::no_alpha_shadows));
}

TEST(ShadowVolume, PartsOfTheLightsAddUpAndThreadsDoNotMatter) {
    const TestScene stage = make_scene({homogeneous_medium(0.3f, room)}, all_lights(), furniture());
    const Picture picture = picture_of(cameras[0], stage.snapshot, 20);
    const std::vector<Scatter> alone = drawn("shadow-volume", picture, stage.snapshot, {});
    const ScatterFunction scatter = find_mode("shadow-volume").prepare(picture.view, stage.snapshot, {}, nullptr);
    std::vector<Scatter> together(alone.size());
    constexpr size_t count = part_count(3);
    std::vector<vec3> parts(count * alone.size(), vec3(0));
    const std::vector<uint32_t> ids(16, 7);
    parallel_for(64, [&](int64_t p) {
        const size_t first = 16 * static_cast<size_t>(p);
        scatter({.rays = std::span(picture.rays).subspan(first, 16),
                 .ids = ids,
                 .parts = std::span(parts).subspan(count * first, count * 16),
                 .positions = std::span(picture.positions).subspan(first, 16)},
                std::span(together).subspan(first, 16));
    });
    for (size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(alone[i].radiance, together[i].radiance);
        const vec3 sum = parts[count * i] + parts[count * i + 1] + parts[count * i + 2];
        EXPECT_NEAR(sum.x, alone[i].radiance.x, 1e-6f * (1 + sum.x));
    }
}
}
}
