// Light from all around: its table of directions, a furnace, a half-lit sky by quadrature, and a sun in a map.
#include "base/gauss_legendre.h"
#include "base/image.h"
#include "base/random.h"
#include "modes/area_light_limitations.h"
#include "modes/path/path_rays.h"
#include "modes/shared_limitations.h"
#include "scene/scene.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/surface.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5;
const Box unit_box{vec3(0), vec3(1)};
const Box slab{vec3(-1e4f, 0, -1e4f), vec3(1e4f, 1, 1e4f)};

BackgroundState even_map(vec3 color) {
    BackgroundState map;
    map.color = color;
    return map;
}

// A lat-long map whose texels have the radiance of their middles.
template<class Radiance> BackgroundState map_of(ivec2 size, const Radiance& radiance, float rotation = 0) {
    auto image = std::make_shared<Image<vec3>>(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float polar = pi * (y + 0.5f) / size.y, turn = 2 * pi * ((x + 0.5f) / size.x - 0.5f) - rotation;
            image->at(x, y) =
                radiance(vec3(std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn)));
        }
    BackgroundState map;
    map.kind = BackgroundKind::image, map.image = image, map.lat_long = true, map.rotation = rotation;
    return map;
}

BackgroundState half_sky() {
    return map_of({64, 512}, [](vec3 direction) { return vec3(direction.y > 0 ? 1 : 0); });
}

BackgroundState disc_map(vec3 direction, float half_angle, float rotation = 0) {
    const float edge = std::cos(half_angle);
    return map_of(
        {2048, 1024}, [&](vec3 d) { return vec3(glm::dot(d, direction) > edge ? 1000 : 0); }, rotation);
}

void expect_near(const RayEstimate& got, double expected, double share, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(got.value[c], expected, share * expected + sigmas * got.error[c]) << what << " ± " << got.error[c];
        EXPECT_LT(got.error[c], share * expected) << what;
    }
}

TEST(Environment, DirectionsArePickedByTheirLight) {
    for (const BackgroundState& map :
         {even_map(vec3(2, 1, 3)), half_sky(), disc_map(glm::normalize(vec3(1, 2, -3)), 0.3f, 1),
          map_of(
              {31, 17}, [](vec3 d) { return vec3(1 + d.x, 1 + d.y * d.z, 2); }, -0.4f)}) {
        const auto environment = make_environment(map);
        ASSERT_TRUE(environment);
        dvec3 sum(0);
        constexpr uint32_t count = 1 << 16;
        for (uint32_t i = 0; i < count; ++i) {
            const Sample2 u = sample2(i, 7);
            const EnvironmentSample sample = sample_environment(*environment, {u.x, u.y});
            EXPECT_NEAR(glm::length(sample.direction), 1, 1e-5);
            sum += dvec3(sample.radiance / sample.pdf) / double(count);
        }
        const dvec3 expected = 4 * std::numbers::pi * dvec3(environment->mean());
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 0.002 * expected[c]);
        double probability = 0; // of all directions
        for (uint32_t i = 0; i < count; ++i) {
            const Sample2 u = sample2(i, 9);
            const float y = 1 - 2 * u.x, across = std::sqrt(1 - y * y);
            const vec3 d(across * std::sin(2 * pi * u.y), y, across * std::cos(2 * pi * u.y));
            const float pdf = environment_pdf(*environment, d);
            EXPECT_TRUE(pdf > 0 || environment_radiance(*environment, d) == vec3(0));
            probability += 4 * std::numbers::pi * double(pdf) / count;
        }
        EXPECT_NEAR(probability, 1, 0.05);
    }
}

TEST(Environment, WhiteFurnaceIsWhite) {
    const std::vector<Phase> phases{{PhaseKind::isotropic}, forward_phase(0.9f),  forward_phase(-0.5f),
                                    {PhaseKind::rayleigh},  draine_phase(0.6, 3), mie_phase(20)};
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1))};
    for (const float extinction : {0.4f, 4.0f})
        for (const Phase& phase : phases) {
            Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, unit_box, phase)});
            snapshot.background.color = vec3(1);
            snapshot.environment = make_environment(even_map(vec3(1)));
            expect_near(traced(snapshot, ray, 2048), 1, 0.005, "phase " + std::string(traits_of(phase.kind).name));
        }
}

TEST(Environment, WhiteSurfacesInWhiteSurroundingsAreWhite) {
    TestScene stage = make_scene({homogeneous_medium(1, {vec3(-2), vec3(2)}, forward_phase(0.5f))}, {},
                                 {box_of(vec3(0), vec3(1), 0)});
    stage.scene->materials = {lambert(vec3(1))};
    add_surfaces(*stage.scene, stage.snapshot);
    stage.snapshot.background.color = vec3(1);
    stage.snapshot.environment = make_environment(even_map(vec3(1)));
    expect_near(traced(stage.snapshot, {{3, 2.5f, 4}, glm::normalize(vec3(-2.5f, -2, -3.5f))}, 4096), 1, 0.005, "box");
}

// Scattered once in a slab 0 < y < 1 under light that depends on the height alone.
double light_of_slab(const Phase& phase, double extinction, vec3 way) {
    double sum = 0;
    const double length = 1 / std::abs(double(way.y));
    constexpr int stretches = 8, turns = 96;
    for (int i = 0; i < stretches; ++i)
        for (const QuadratureNode& along : gauss_legendre(6)) {
            const double t = length * (i + along.at) / stretches, y = 1 + t * way.y;
            double arriving = 0;
            for (int j = 0; j < 16; ++j)
                for (const QuadratureNode& node : gauss_legendre(6)) {
                    const double height = std::pow((j + node.at) / 16, 2), across = std::sqrt(1 - height * height);
                    const double measure = node.weight / 16 * 2 * std::sqrt(height) * 2 * std::numbers::pi / turns;
                    for (int k = 0; k < turns; ++k) {
                        const double turn = 2 * std::numbers::pi * (k + 0.5) / turns;
                        const double cosine =
                            glm::dot(dvec3(across * std::cos(turn), height, across * std::sin(turn)), dvec3(way));
                        arriving +=
                            measure * phase_value_of<double>(phase, cosine) * std::exp(-extinction * (1 - y) / height);
                    }
                }
            sum += along.weight * length / stretches * extinction * std::exp(-extinction * t) * arriving;
        }
    return sum;
}

TEST(Environment, SlabUnderHalfLitSkyScattersOnceAsByQuadrature) {
    for (const float extinction : {0.3f, 1.5f})
        for (const Phase& phase : {Phase{PhaseKind::isotropic}, forward_phase(0.6f), mie_phase(10)}) {
            Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, slab, phase)});
            snapshot.environment = make_environment(half_sky());
            const Ray ray{{0, 3, 0}, glm::normalize(vec3(0.5f, -1, 0.2f))};
            const double expected = light_of_slab(phase, double(extinction), ray.direction);
            expect_near(traced(snapshot, ray, 1 << 13, 1), expected, 0.003, "slab");
        }
}

TEST(Environment, SunInTheMapIsTheSun) {
    const vec3 towards = glm::normalize(vec3(0.4f, 1, -0.3f));
    Snapshot snapshot = snapshot_of({homogeneous_medium(1, slab, {PhaseKind::isotropic})});
    snapshot.environment = make_environment(disc_map(towards, 0.035f, 0.7f));
    const float lux = 4 * pi * snapshot.environment->mean().x;
    EXPECT_NEAR(lux, 1000 * 2 * pi * (1 - std::cos(0.035f)), 0.01f * lux);
    Snapshot with_sun = snapshot_of(snapshot.media, {sun_light(-towards, lux)});
    const Ray ray{{0, 3, 0}, glm::normalize(vec3(0.5f, -1, 0.2f))};
    expect_near(traced(snapshot, ray, 1 << 12, 1), traced(with_sun, ray, 1 << 13, 1).value.x, 0.003, "sun");
}

// Both kinds of quadrature of single scattering and of surfaces are held against paths of one order.
RayEstimate marched_light(const Snapshot& snapshot, const Ray& ray, int samples, const Settings& settings) {
    const ScatterFunction scatter = find_mode("march").prepare(View{}, snapshot, settings, nullptr);
    return estimate_ray(scatter, ray, samples, fog_light);
}

RayEstimate path_fog_light(const Snapshot& snapshot, const Ray& ray, int samples) {
    return estimate_ray(path_mode(snapshot, 1), ray, samples, fog_light);
}

void expect_agreement(const RayEstimate& a, const RayEstimate& b, double precision, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(a.error[c], b.error[c]);
        EXPECT_NEAR(a.value[c], b.value[c], sigmas * error) << what;
        EXPECT_LE(error, precision * b.value[c]) << what; // both may be in the dark
    }
}

TEST(Environment, MarchOfASlabUnderHalfLitSkyIsAsByQuadrature) {
    for (const float extinction : {0.3f, 1.5f})
        for (const Phase& phase : {Phase{PhaseKind::isotropic}, forward_phase(0.6f), mie_phase(10)}) {
            Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, slab, phase)});
            snapshot.environment = make_environment(half_sky());
            const Ray ray{{0, 3, 0}, glm::normalize(vec3(0.5f, -1, 0.2f)), 100};
            const double expected = light_of_slab(phase, double(extinction), ray.direction);
            expect_near(marched_light(snapshot, ray, 1 << 12, {}), expected, 0.003, "slab");
        }
}

TEST(Environment, MarchIsAsPathsOfOneOrder) {
    const vec3 towards = glm::normalize(vec3(0.4f, 1, -0.3f));
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return 0.2f + p.x * p.y; }), 3);
    Medium colored = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, forward_phase(0.8f), vec3(0.9f, 0.5f, 0.2f));
    for (const BackgroundState& map : {disc_map(towards, 0.035f), half_sky(), even_map(vec3(1, 2, 3))})
        for (const std::vector<Medium>& media : {std::vector{grid}, std::vector{grid, colored}}) {
            TestScene stage = make_scene(media, {}, {roof(0.5f, 1.2f)});
            stage.snapshot.environment = make_environment(map);
            for (const vec3 way : {vec3(0.05f, -0.1f, -1), vec3(-0.08f, 0.05f, -1)}) {
                const Ray ray{{0.4f, 0.6f, 3}, glm::normalize(way), 6};
                expect_agreement(marched_light(stage.snapshot, ray, 1 << 11, {}),
                                 path_fog_light(stage.snapshot, ray, 1 << 13), 0.03, "march");
            }
        }
}

TEST(Environment, FactorsOnFogAndTintCountOnce) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, unit_box, forward_phase(0.5f))});
    const auto plain = make_environment(half_sky());
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1)), 6};
    snapshot.environment = plain;
    const dvec3 light = marched_light(snapshot, ray, 64, {}).value;
    auto scaled = std::make_shared<Environment>(*plain);
    scaled->volume_scale = 0.25f, scaled->scale = vec3(2);
    snapshot.environment = scaled;
    Settings tinted;
    tinted.style.tint = vec3(1, 0.5f, 0);
    const dvec3 half = marched_light(snapshot, ray, 64, tinted).value;
    EXPECT_NEAR(half.x, 0.5 * light.x, 1e-5 * light.x);
    EXPECT_NEAR(half.y, 0.25 * light.x, 1e-5 * light.x);
    EXPECT_EQ(half.z, 0);
    Settings off;
    off.terms.ambient = false;
    EXPECT_EQ(marched_light(snapshot, ray, 64, off).value, dvec3(0));
    EXPECT_EQ(estimate_ray(find_mode("path").prepare(View{}, snapshot, off, nullptr), ray, 64, fog_light).value,
              dvec3(0));
}

// A floor beside an edge that hides part of the sky, in fog.
TEST(Environment, SurfacesAreLitAsByPaths) {
    const vec3 towards = glm::normalize(vec3(0.4f, 1, -0.3f));
    for (const BackgroundState& map : {disc_map(towards, 0.1f), half_sky(), even_map(vec3(1, 2, 3))}) {
        TestScene stage = make_scene({homogeneous_medium(0.2f, {vec3(-9, 0, -9), vec3(9, 2, 9)})}, {},
                                     {floor_of(0, 9, 0), roof(0.5f, 1)});
        stage.scene->materials = {lambert(vec3(0.8f, 0.5f, 0.2f))};
        add_surfaces(*stage.scene, stage.snapshot);
        stage.snapshot.environment = make_environment(map);
        const Ray ray{{0.9f, 0.5f, 0}, {0, -1, 0}};
        const RayEstimate path = estimate_ray(path_mode(stage.snapshot, 1), ray, 1 << 12, surface_light);

        SurfacePoint point;
        point.position = {0.9f, 0, 0}, point.base_color = vec3(0.8f, 0.5f, 0.2f), point.instance = 0;
        constexpr uint32_t count = 1 << 16;
        dvec3 sum(0);
        for (uint32_t i = 0; i < count; ++i) {
            const Sample2 u = sample2(i, 3);
            const vec2 pair(u.x, u.y);
            vec3 radiance;
            shade_surfaces(stage.snapshot, {}, {&point, 1}, {&pair, 1}, {&radiance, 1});
            sum += dvec3(radiance) / double(count);
        }
        const double through = std::exp(-0.2 * 0.5);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c] * through, path.value[c], 0.005 * path.value[c] + sigmas * path.error[c]);
    }
}

// A white floor behind fog, lit by the surroundings: as bright as behind fog that absorbs as much and scatters nothing.
TEST(Environment, PathTakesItOutOfFogAlone) {
    const auto stage_of = [&](float albedo) {
        TestScene stage = make_scene({homogeneous_medium(0.5f, {vec3(-1), vec3(1)}, {}, vec3(albedo))}, {},
                                     {quad({-9, -9, -1.5f}, {18, 0, 0}, {0, 18, 0})}, vec3(0.3f));
        stage.snapshot.environment = make_environment(half_sky());
        return stage;
    };
    const TestScene white = stage_of(1), black = stage_of(0);
    const Ray ray{{0.2f, 0.1f, 5}, {0, 0, -1}, 20};
    Settings settings;
    settings.path.orders = 1;
    const auto light = [&](const TestScene& stage, const auto& part) {
        return estimate_ray(find_mode("path").prepare(View{}, stage.snapshot, settings, nullptr), ray, 1 << 12, part);
    };
    const RayEstimate expected = light(black, surface_light);
    EXPECT_GT(light(white, fog_light).value.x, 0.1);
    settings.terms.ambient = false;
    const RayEstimate found = light(white, surface_light);
    EXPECT_EQ(light(white, fog_light).value.x, 0);
    EXPECT_GT(expected.value.x, 0.1);
    EXPECT_NEAR(found.value.x, expected.value.x, sigmas * std::hypot(found.error.x, expected.error.x));
}

TEST(Environment, ModesSayWhatTheyMissOfIt) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, unit_box)});
    auto named = std::make_shared<Environment>(*make_environment(half_sky()));
    named->name = "sky";
    snapshot.environment = named;
    Settings settings;
    const auto amount = [&](const char* mode, const LimitationKind& kind) {
        for (const Limitation& one : find_mode(mode).limitations(View{}, snapshot, settings))
            if (one.is(kind) && one.name == "sky") return one.amounts;
        return std::array{-1.0, -1.0};
    };
    for (const char* mode : {"froxel", "shadow-map", "shadow-volume", "cone"}) {
        EXPECT_GT(amount(mode, limitation::mean_environment)[0], 5) << mode;
        EXPECT_NEAR(amount(mode, limitation::mean_environment)[1], 0.5, 0.005) << mode;
    }
    for (const char* mode : {"billboard", "radial-blur"})
        EXPECT_NEAR(amount(mode, limitation::environment_left_out)[0], 0.5, 0.005) << mode;
    for (const char* mode : {"path", "march"}) {
        EXPECT_EQ(amount(mode, limitation::mean_environment)[0], -1) << mode;
        EXPECT_EQ(amount(mode, limitation::environment_left_out)[0], -1) << mode;
    }
    settings.terms.ambient = false; // nothing is missed of what is left out on purpose
    for (const char* mode : {"froxel", "shadow-map", "shadow-volume", "cone"})
        EXPECT_EQ(amount(mode, limitation::mean_environment)[0], -1) << mode;
}

// As E has it: over all pixels, of light that scatters forwards, past a wall.
TEST(Environment, ItsMeanIsAsFarOffAsModesSay) {
    for (const float g : {0.0f, 0.8f}) {
        TestScene stage = make_scene({homogeneous_medium(0.5f, unit_box, forward_phase(g))}, {},
                                     {quad({-2, -2, -0.5f}, {4, 0, 0}, {0, 4, 0})});
        stage.snapshot.environment = make_environment(half_sky());
        const View view = view_of({0.5f, 1.2f, 4}, {0.5f, 0.5f, 0.5f}, {24, 16}, 0.5f);
        const auto march = find_mode("march").prepare(view, stage.snapshot, {}, nullptr);
        const auto cone = find_mode("cone").prepare(view, stage.snapshot, {}, nullptr);
        double squares = 0, sum = 0;
        for (const Ray& ray : pixel_rays(view, stage.snapshot)) {
            const double right = estimate_ray(march, ray, 4, fog_light).value.x;
            const double off = estimate_ray(cone, ray, 1, fog_light).value.x - right;
            squares += off * off, sum += right;
        }
        const double error = std::sqrt(squares * 24 * 16) / sum;
        for (const Limitation& one : find_mode("cone").limitations(view, stage.snapshot, Settings{})) {
            if (!one.is(limitation::mean_environment)) continue;
            EXPECT_NEAR(one.amounts[0], 100 * error, 30 * error) << g;
        }
    }
}

// A speck of fog in the image, and a sky of blue above and red below that are as bright as each other.
TEST(Environment, ItsMeanIsMeasuredWhereFogIsAndInEachChannel) {
    const auto stated = [](Box box, const std::shared_ptr<const Environment>& sky) {
        Snapshot snapshot = snapshot_of({homogeneous_medium(8, box)});
        snapshot.environment = sky;
        const View view = view_of({0, 0, 5}, {0, 0, 0}, {48, 27}, 0.9f);
        for (const Limitation& one : find_mode("cone").limitations(view, snapshot, Settings{}))
            if (one.is(limitation::mean_environment)) return one.amounts[0];
        return -1.0;
    };
    EXPECT_GT(stated({vec3(0.1f), vec3(0.2f)}, make_environment(half_sky())), 20);
    const vec3 blue(0, 0, 1), red(1, 0, 0);
    const auto colored = [&](vec3 d) { return d.y > 0 ? blue / luminance(blue) : red / luminance(red); };
    EXPECT_GT(stated({vec3(-0.5f), vec3(0.5f)}, make_environment(map_of({64, 512}, colored))), 50);
}

TEST(Environment, ModesWithItsMeanHaveItAsAmbientLight) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.01f, unit_box)}), even = snapshot;
    snapshot.environment = make_environment(half_sky());
    even.ambient = snapshot.environment->mean();
    const View view = view_of({0.5f, 0.5f, 3}, vec3(0.5f));
    const std::vector<Ray> rays = pixel_rays(view, snapshot);
    for (const char* mode : {"froxel", "shadow-map", "shadow-volume", "cone"}) {
        const double expected = mean_of(run_mode(mode, view, even, {}, rays));
        EXPECT_GT(expected, 0) << mode;
        EXPECT_NEAR(mean_of(run_mode(mode, view, snapshot, {}, rays)), expected, 1e-6 * expected) << mode;
    }
}

// Light that scatters more than once, from the fluence grid. With 1.6 million paths the grid's noise is below 1 % here;
// with the default of 200 000 it is up to 3 %.
TEST(Environment, FluenceHasItsLightThatScattersAgain) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(2, unit_box, {PhaseKind::isotropic})});
    snapshot.environment = make_environment(half_sky());
    const Ray ray{{0.4f, 0.3f, 3}, glm::normalize(vec3(0.05f, 0.1f, -1)), 6};
    Settings all;
    all.fluence.orders = all_orders, all.fluence.paths *= 8;
    const RayEstimate path = estimate_ray(path_mode(snapshot), ray, 1 << 12, fog_light);
    EXPECT_NEAR(marched_light(snapshot, ray, 1 << 10, all).value.x, path.value.x, 0.015 * path.value.x);
}
}
}
