// Light of fog that emits, in other fog and on surfaces: quadrature, march against paths, what stands for it.
#include "base/gauss_legendre.h"
#include "base/random.h"
#include "integrate/lights/fire_lamps.h"
#include "modes/area_light_limitations.h"
#include "modes/fire_scenes.h"
#include "modes/path/path_rays.h"
#include "modes/shared_limitations.h"
#include "scene/scene.h"
#include "support/face_lights.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/lights/emission_surface.h"
#include "trace/lights/emissive_bricks.h"
#include "trace/occlusion/occluders.h"
#include "volume/medium.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5;

// A ball of .5 m that glows evenly and greenly but for its edge, its middle at `center`.
Medium glowing_ball(vec3 center) {
    const TempFolder scratch;
    const SparseVolume ball =
        tenth_volume(ivec3(12), [](ivec3 at) { return glm::clamp(5.5f - glm::length(vec3(at) - 5.5f), 0.0f, 1.0f); });
    MediumSource source = grid_source(scratch, "ball", ball, 0);
    source.emission_grid = property(scratch, "emission", ball);
    source.emission = vec3(2, 3, 1), source.translation = center - 0.55f;
    Scene scene;
    return snapshot_with(scene, source).media.at(0);
}

// Places of what a medium gives off, and how much: candela.
struct Emitter {
    dvec3 at, candela;
};
std::vector<Emitter> places_of(const Medium& medium) {
    constexpr int steps = 48;
    std::vector<Emitter> emitters;
    const dvec3 low(medium.world_bounds.low), size(medium.world_bounds.size());
    for (int i = 0; i < steps * steps * steps; ++i) {
        const dvec3 at = low + size * ((dvec3(i % steps, i / steps % steps, i / steps / steps) + 0.5) / double(steps));
        const dvec3 candela =
            dvec3(emission_at(medium, vec3(at))) * (size.x * size.y * size.z / double(steps * steps * steps));
        if (candela.y > 0) emitters.push_back({at, candela});
    }
    return emitters;
}

dvec3 light_by_quadrature(const Medium& fire, const Medium& fog, const Ray& ray) {
    const std::vector<Emitter> emitters = places_of(fire);
    const Interval<float> inside = clip(fog.world_bounds, ray.origin, ray.direction, {0, ray.t_max});
    const double extinction = double{gray_extinction(fog.optics)}, length = double{inside.length()};
    dvec3 sum(0);
    for (const QuadratureNode& along : gauss_legendre(24)) {
        const double t = double{inside.low} + along.at * length;
        const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
        dvec3 arriving(0);
        for (const Emitter& place : emitters) {
            const dvec3 offset = place.at - point;
            const double distance = glm::length(offset);
            const vec3 direction(offset / distance);
            const double way =
                extinction * double{clip(fog.world_bounds, vec3(point), direction, {0, infinity}).length()};
            arriving += place.candela * (std::exp(-way) / (distance * distance) *
                                         phase_value_of<double>(fog.optics.phase, glm::dot(direction, ray.direction)));
        }
        sum += along.weight * length * extinction * std::exp(-extinction * along.at * length) * arriving;
    }
    return sum * dvec3(fog.optics.albedo);
}

RayEstimate marched_light(const Snapshot& snapshot, const Ray& ray, int samples, const Settings& settings = {}) {
    return estimate_ray(find_mode("march").prepare(View{}, snapshot, settings, nullptr), ray, samples, fog_light);
}

// The slab ends where the ball begins.
TEST(FireLight, SlabBesideABallIsAsByQuadrature) {
    const Medium ball = glowing_ball({0, 0, 0});
    const Ray ray{{1.4f, 0.1f, -3}, glm::normalize(vec3(-0.02f, 0.03f, 1)), 10};
    for (const float extinction : {0.3f, 1.5f})
        for (const Phase& phase : {Phase{PhaseKind::isotropic}, forward_phase(0.6f)}) {
            const Medium slab =
                homogeneous_medium(extinction, {{0.8f, -3, -2}, {2.5f, 3, 2}}, phase, {0.9f, 0.8f, 0.7f});
            const Snapshot snapshot = snapshot_of({slab, ball});
            const dvec3 expected = light_by_quadrature(ball, slab, ray);
            for (const RayEstimate& found : {traced(snapshot, ray, 1 << 13, 1), marched_light(snapshot, ray, 1 << 11)})
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(found.value[c], expected[c], 0.005 * expected[c] + sigmas * found.error[c]);
                    EXPECT_LT(found.error[c], 0.005 * expected[c]);
                }
        }
}

// Fog that varies, in the fire and around it, with a wall in between.
TEST(FireLight, MarchIsAsPathsOfOneOrder) {
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return 0.2f + p.x * p.y; }), 3);
    const Medium colored = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, forward_phase(0.8f), vec3(0.9f, 0.5f, 0.2f));
    const Medium fire = glowing_ball({0.7f, 0.5f, 0.4f}), other = glowing_ball({-0.6f, 0.2f, 0});
    for (const std::vector<Medium>& media : {std::vector{grid, fire}, std::vector{grid, colored, fire, other}}) {
        const TestScene stage = make_scene(media, {}, {roof(0.3f, 0.8f)});
        for (const Ray& ray : {Ray{{0.3f, 0.4f, 2}, glm::normalize(vec3(0.05f, -0.1f, -1)), 4},
                               Ray{{0.7f, 0.5f, 2}, glm::normalize(vec3(0.01f, 0.02f, -1)), 4}}) {
            const RayEstimate paths = traced(stage.snapshot, ray, 1 << 12, 1);
            for (const Settings& settings : {Settings{}, exact_settings()}) {
                const RayEstimate march = marched_light(stage.snapshot, ray, 1 << 8, settings);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(march.value[c], paths.value[c],
                                sigmas * std::hypot(march.error[c], paths.error[c]) + 0.003 * paths.value[c]);
            }
        }
    }
}

// Radiance ε/κ in all directions, of which each collision scatters its albedo.
TEST(FireLight, EndlessFogScattersWhatItEmits) {
    Medium fog = homogeneous_medium(0.5f, everywhere(), forward_phase(0.4f), {0.8f, 0.5f, 0.2f});
    fog.optics.emission.radiance = {3, 2, 1};
    const Snapshot snapshot = snapshot_of({fog});
    const Ray ray{{1, 2, 3}, glm::normalize(vec3(1, 0.3f, -0.5f)), infinity};
    for (const RayEstimate& found : {traced(snapshot, ray, 1 << 12, 1), marched_light(snapshot, ray, 1 << 10)})
        for (int c = 0; c < 3; ++c) {
            const double expected = double{fog.optics.emission.radiance[c]} / 0.5 * (1 + double{fog.optics.albedo[c]});
            EXPECT_NEAR(found.value[c], expected, 1e-3 * expected + sigmas * found.error[c]);
            EXPECT_LT(found.error[c], 0.01 * expected);
        }
}

// Fog of each kind whose emission follows its density, in haze and under a roof.
TEST(FireLight, FogThatEmitsIlluminatesFogAsPathsOfOneOrder) {
    const Medium haze = homogeneous_medium(0.3f, {vec3(-2), vec3(3)}, forward_phase(0.5f), vec3(0.9f));
    const Box box{{-0.2f, 0.1f, -0.4f}, {0.9f, 0.8f, 0.6f}};
    Medium turned = homogeneous_medium(1, box, {}, vec3(0.3f));
    const mat4 turn = glm::rotate(mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3)));
    turned.density.world_to_local = glm::inverse(turn), turned.world_bounds = transform(turn, box);
    Medium layer = homogeneous_medium(0.6f, everywhere());
    layer.density.kind = DensityKind::height, layer.density.height_base = 0.2f, layer.density.height_falloff = 0.4f;
    for (Medium fog : {homogeneous_medium(2, box), turned, layer,
                       medium_of(unit_volume(16, [](vec3 p) { return 0.2f + p.x * p.y; }), 3)}) {
        fog.optics.emission.radiance = {1, 3, 2};
        const TestScene stage = make_scene({haze, fog}, {}, {roof(0.3f, 1.2f)});
        const Ray ray{{0.3f, 0.4f, 2}, glm::normalize(vec3(0.05f, -0.1f, -1)), 4};
        const RayEstimate paths = traced(stage.snapshot, ray, 1 << 11, 1);
        for (const Settings& settings : {Settings{}, exact_settings()}) {
            const RayEstimate march = marched_light(stage.snapshot, ray, 1 << 7, settings);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(march.value[c], paths.value[c],
                            sigmas * std::hypot(march.error[c], paths.error[c]) + 0.003 * paths.value[c]);
        }
    }
}

// What arrives at a white plane that looks up, by π: directions over it, and what the medium gives off along them.
dvec3 reflected_by_quadrature(const Medium& fire, vec3 point) {
    constexpr int turns = 96, steps = 400;
    dvec3 sum(0);
    for (const QuadratureNode& square : gauss_legendre(48)) // of the cosine
        for (int turn = 0; turn < turns; ++turn) {
            const double sine = std::sqrt(1 - square.at), angle = 2 * std::numbers::pi * (turn + 0.5) / turns;
            const vec3 direction(dvec3(sine * std::cos(angle), std::sqrt(square.at), sine * std::sin(angle)));
            const Interval<float> inside = clip(fire.world_bounds, point, direction, {0, infinity});
            if (inside.empty()) continue;
            const double step = double{inside.length()} / steps;
            for (int i = 0; i < steps; ++i)
                sum += dvec3(emission_at(fire, point + float(double{inside.low} + (i + 0.5) * step) * direction)) *
                       (step * square.weight / turns);
        }
    return sum;
}

// Beneath a ball, and within its lower half.
TEST(FireLight, SurfacesAreLitAsByQuadrature) {
    const Medium ball = glowing_ball({0, 1, 0});
    SurfacePoint point;
    point.normal = point.face_normal = {0, 1, 0}, point.instance = 0;
    for (const vec3 place : {vec3(0), vec3(0.9f, 0, 0.1f), vec3(0.1f, 0.6f, 0)}) {
        point.position = place;
        const dvec3 expected = reflected_by_quadrature(ball, place);
        const TestScene stage = make_scene({ball}, {}, {floor_of(place.y, 2, 0)});
        constexpr int batches = 64, count = 512;
        dvec3 sum(0), squares(0);
        for (uint32_t b = 0; b < batches; ++b) {
            std::vector<vec2> u(count);
            for (uint32_t i = 0; i < count; ++i) {
                const Sample2 pair = sample2(i, hash(b));
                u[i] = {pair.x, pair.y};
            }
            vec3 radiance(0);
            add_emitted_light(emitters_of(stage.snapshot), stage.snapshot, {&point, 1}, u, {&radiance, 1});
            sum += dvec3(radiance), squares += dvec3(radiance) * dvec3(radiance);
        }
        const dvec3 mean = sum / double(batches);
        for (int c = 0; c < 3; ++c) {
            const double error = std::sqrt(std::max(squares[c] / batches - mean[c] * mean[c], 0.0) / batches);
            EXPECT_LT(error, 0.01 * expected[c]);
            EXPECT_NEAR(mean[c], expected[c], sigmas * error + 0.003 * expected[c]) << place.x << ' ' << place.y;
        }
    }
}

TEST(FireLight, LampsHaveItsCandelaAndPlace) {
    const Medium fire = glowing_ball({2, 1, 0}), other = glowing_ball({-2, 1, 0});
    const Snapshot snapshot = snapshot_of({fire, other, homogeneous_medium(0.2f, {vec3(-3), vec3(3)})});
    dvec3 candela(0), found(0), middle(0);
    for (const Medium* medium : {&fire, &other})
        for (const Emitter& place : places_of(*medium)) candela += place.candela;
    const std::vector<Light> lamps = fire_lamps(snapshot);
    EXPECT_GE(lamps.size(), 2u);
    for (const Light& lamp : lamps) {
        found += dvec3(lamp.intensity), middle += double{lamp.intensity.y} * dvec3(lamp.position);
        EXPECT_LT(std::min(glm::distance(lamp.position, vec3(2, 1, 0)), glm::distance(lamp.position, vec3(-2, 1, 0))),
                  0.6f);
        EXPECT_LT(lamp.radius, 0.6f) << "none stands for both";
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], candela[c], 0.01 * candela[c]);
    EXPECT_LT(glm::distance(middle / found.y, dvec3(0, 1, 0)), 0.05);
}

// Of a ball: the mean of 1/r² is 10 % above that of its middle.
TEST(FireLight, FarEnoughIsWhereABallIsOffBySoMuch) {
    Light lamp;
    lamp.radius = 0.5f;
    const double d = far_distance(lamp, 0.02);
    double sum = 0, weight = 0;
    for (const QuadratureNode& r : gauss_legendre(24))
        for (const QuadratureNode& cosine : gauss_legendre(24)) {
            const double radius = 0.5 * r.at, c = 2 * cosine.at - 1, w = r.weight * cosine.weight * radius * radius;
            sum += w / (d * d + radius * radius - 2 * d * radius * c), weight += w;
        }
    EXPECT_NEAR(sum / weight * d * d - 1, 0.02, 0.002);
}

// Light leaves thick smoke from its outside, lamps would shine from its middle.
TEST(FireLight, FireInItsOwnSmokeIsWrongAtAnyDistance) {
    const auto reach = [](float extinction) {
        const Medium smoke = homogeneous_medium(extinction, {vec3(-0.7f, -0.2f, -0.7f), vec3(0.7f, 1.2f, 0.7f)});
        const Snapshot snapshot = snapshot_of({smoke, glowing_ball({0, 0.5f, 0})}, {});
        for (const Limitation& one : find_mode("froxel").limitations(View{}, snapshot, {}))
            if (one.is(limitation::lamps_for_fire)) return one.amounts[0] / double{snapshot.extent};
        return -1.0;
    };
    EXPECT_LT(reach(0.1f), 0.5);
    EXPECT_GE(reach(20), 1);
}

// No lamps stand for endless or thick fog, and cards draw nothing of its light or of ambient light.
TEST(FireLight, FogThatEmitsAndAmbientLightThatAreLeftOutAreSaid) {
    const auto amount = [](const char* mode, const Snapshot& snapshot, const LimitationKind& kind) {
        for (const Limitation& one : find_mode(mode).limitations(View{}, snapshot, Settings{}))
            if (one.is(kind)) return one.amounts[0];
        return -1.0;
    };
    for (const Box& box : {everywhere(), Box{vec3(-1e3f), vec3(1e3f)}}) {
        Medium fog = homogeneous_medium(0.5f, box, {}, vec3(0.6f));
        fog.optics.emission.radiance = vec3(3);
        Snapshot snapshot = snapshot_of({fog}, {point_light({1, 1, 1}, 2)});
        snapshot.ambient = vec3(20);
        for (const char* mode : {"froxel", "cone", "shadow-map", "shadow-volume"})
            EXPECT_NEAR(amount(mode, snapshot, limitation::unscattered_emission), 100 * 0.6 / 1.6, 0.01) << mode;
        for (const char* mode : {"march", "path"})
            EXPECT_EQ(amount(mode, snapshot, limitation::unscattered_emission), -1) << mode;
        for (const char* mode : {"billboard", "radial-blur"}) {
            EXPECT_NEAR(amount(mode, snapshot, limitation::emission_left_out), 6, 0.05) << mode;
            EXPECT_NEAR(amount(mode, snapshot, limitation::ambient_left_out), 20, 1e-4) << mode;
        }
    }
}

TEST(FireLight, PartsAndLimitationsSayWhatBecomesOfIt) {
    const Medium fog = homogeneous_medium(0.5f, {vec3(-3), vec3(3)}, forward_phase(0.2f), vec3(0.8f));
    const Snapshot snapshot = snapshot_of({fog, glowing_ball({0, 0.5f, 0})}, {point_light({1, 1, 1}, 2)});
    const View view = view_of({0.3f, 0.4f, 4}, {0, 0, 0});
    const std::vector<Ray> rays = pixel_rays(view, snapshot, 10);
    for (const Mode& mode : modes()) {
        const bool lamps =
            mode.name == "froxel" || mode.name == "shadow-map" || mode.name == "shadow-volume" || mode.name == "cone";
        EXPECT_EQ(has_limitation(mode.limitations(view, snapshot, {}), limitation::lamps_for_fire), lamps) << mode.name;
        EXPECT_FALSE(has_limitation(mode.limitations(view, snapshot, {}), limitation::unscattered_emission))
            << mode.name;
        if (!lamps && mode.name != "march") continue;
        std::vector<vec3> parts;
        const auto whole = run_mode(mode.name, view, snapshot, settings_for(Quality::preview), rays);
        run_mode(mode.name, view, snapshot, settings_for(Quality::preview), rays, &parts);
        for (size_t i = 0; i < rays.size(); i += 37) {
            vec3 sum(0);
            for (size_t p = 0; p < part_count(1); ++p) sum += parts[i * part_count(1) + p];
            EXPECT_NEAR(luminance(sum), luminance(whole[i].radiance), 2e-3f * luminance(sum)) << mode.name;
            const vec3 glow = parts[i * part_count(1) + 1 + static_cast<size_t>(OtherLight::emission)];
            EXPECT_GT(glow.y, 0) << mode.name << ": what the fog scatters of it";
        }
    }
}
}
}
