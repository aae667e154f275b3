// Analytic light cones against adaptive quadrature in double, closed forms and geometry.
#include "modes/cone/cone_integral.h"
#include "modes/cone/limitations.h"
#include "modes/cone/settings.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include "base/gauss_legendre.h"
#include "base/parallel.h"
#include "base/random.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double degree = M_PI / 180;

Light spot(vec3 position, vec3 direction, double inner, double outer, float candela = 1) {
    return spot_light(position, direction, candela, static_cast<float>(inner * degree),
                      static_cast<float>(outer * degree));
}

std::vector<Scatter> coned(const Snapshot& snapshot, const Settings& settings, const std::vector<Ray>& rays) {
    View view;
    view.camera.position = rays[0].origin;
    return run_mode("cone", view, snapshot, settings, rays);
}
Scatter coned(const Snapshot& snapshot, const Ray& ray, const Settings& settings = {}) {
    return coned(snapshot, settings, std::vector{ray})[0];
}

Ray towards(vec3 from, vec3 to, float t_max) { return {from, glm::normalize(to - from), t_max}; }

struct Case {
    Snapshot snapshot;
    std::vector<Ray> rays;
};

vec3 random_vector(RandomStream& random, float size) {
    return size * (2.0f * vec3(random.next(), random.next(), random.next()) - 1.0f);
}

Medium random_medium(RandomStream& random, int kind, vec3 place) {
    const float extinction = std::pow(10.0f, -2 + 2 * random.next()), g = 1.2f * random.next() - 0.6f;
    Medium medium = homogeneous_medium(extinction, everywhere(), {PhaseKind::henyey_greenstein, g});
    const vec3 half = 2.0f + 3.0f * vec3(random.next(), random.next(), random.next());
    const vec3 middle = place + random_vector(random, 2);
    if (kind > 0) medium.density.bounds = medium.world_bounds = Box{middle - half, middle + half};
    if (kind == 2) {
        medium.density.kind = DensityKind::height;
        medium.density.height_base = place.y - 1, medium.density.height_falloff = 0.5f + 2 * random.next();
    }
    return medium;
}

// One light in one to two media, and rays that meet it in every way: across, through it, along the axis, along the
// border of the cone, past it, from inside and from behind.
Case random_case(uint32_t number, int rays) {
    RandomStream random{hash(number, 0xc04eu)};
    const vec3 place = number % 2 ? vec3(1000, -700, 400) : vec3(0);
    const vec3 position = place + random_vector(random, 3), axis = glm::normalize(random_vector(random, 1) + 1e-3f);
    constexpr double angles[] = {1, 6, 12, 25, 40, 70, 89.9, 90, 0.5, 30};
    const double outer = angles[number % 10];
    Light light = spot(position, axis, outer * (number % 3 ? random.next() : 0.9), outer);
    if (number % 5 == 3) light.kind = LightKind::point;
    if (number % 5 == 4) light.kind = LightKind::sun;
    if (number % 4 == 1) light.range = 3 + 6 * random.next();
    if (number % 7 == 2) light.radius = 0.3f * random.next();
    const int kind = number / 10 % 4;
    std::vector<Medium> media{random_medium(random, std::min(kind, 2), place)};
    if (kind == 3) media.push_back(random_medium(random, 1, place));
    Case result{snapshot_of(media, {light}), {}};

    vec3 u, v;
    make_frame(axis, u, v);
    const auto on_cone = [&](double angle, float away) {
        const float turn = 2 * pi * random.next(), a = static_cast<float>(angle * degree);
        return position + away * (std::cos(a) * axis + std::sin(a) * (std::cos(turn) * u + std::sin(turn) * v));
    };
    for (int i = 0; i < rays; ++i) {
        const vec3 eye =
            i % 7 == 0 ? on_cone(outer * random.next(), 5 * random.next()) : place + random_vector(random, 6);
        const float t_max = 0.3f + 20 * random.next() * random.next();
        vec3 target = place + random_vector(random, 4);
        if (i % 8 == 1) target = position + random_vector(random, std::pow(10.0f, -4 * random.next()));
        if (i % 8 == 2) target = on_cone(outer * random.next(), 5 * random.next());
        if (i % 8 == 3) target = on_cone(outer, 5 * random.next());
        if (i % 8 == 4) target = eye + on_cone(outer, 1) - position;
        if (i % 8 == 5) target = eye - axis;
        result.rays.push_back(towards(eye, target, t_max));
    }
    return result;
}

// Largest errors over max(truth, peak/1000) of all rays of many scenes, in ascending order.
std::vector<double> errors(int scenes, int rays, int nodes) {
    Settings settings;
    settings.of<ConeSettings>().nodes = nodes;
    std::vector<std::vector<double>> found(scenes);
    parallel_for(scenes, [&](int64_t number) {
        const Case c = random_case(static_cast<uint32_t>(number), rays);
        const std::vector<Scatter> got = coned(c.snapshot, settings, c.rays);
        std::vector<double> truth;
        for (const Ray& ray : c.rays) truth.push_back(cone_integral(c.snapshot.lights[0], c.snapshot.media, ray));
        const double peak = *std::max_element(truth.begin(), truth.end());
        for (size_t i = 0; i < truth.size(); ++i) {
            const double error = std::abs(got[i].radiance.x - truth[i]) / std::max({truth[i], 1e-3 * peak, 1e-12});
            found[number].push_back(std::isfinite(got[i].radiance.x) ? error : double(infinity));
        }
    });
    std::vector<double> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    return all;
}

// 999 of 1000 rays within 1e-4, with the most nodes and with as many as by default; all finite.
void expect_exact(int scenes, int rays) {
    for (const int nodes : {max_gauss_nodes, ConeSettings{}.nodes}) {
        const std::vector<double> sorted = errors(scenes, rays, nodes);
        EXPECT_LE(sorted[static_cast<size_t>(0.999 * static_cast<double>(sorted.size()))], 1e-4) << nodes << " nodes";
        EXPECT_TRUE(std::isfinite(sorted.back()));
    }
}

TEST(Cone, EqualsAdaptiveQuadratureInAllCases) { expect_exact(40, 125); }
TEST(NightlyCone, EqualsAdaptiveQuadratureOnManyRays) { expect_exact(400, 250); }

TEST(Cone, WithoutExtinctionIsTheArcTangent) {
    // ∫ dt/|o + t d - l|² over 0..D = (atan((D+b)/s) - atan(b/s))/s.
    const float extinction = 1e-6f;
    const vec3 light(0.4f, 1.1f, -3);
    const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction)}, {point_light(light)});
    for (const vec3 target : {vec3(0, 0, -5), vec3(0.3f, 1, -3), vec3(0.39f, 1.09f, -2.99f), vec3(5, 2, 7)}) {
        const Ray ray = towards({0, 0.5f, 1}, target, 9);
        const dvec3 q = dvec3(ray.origin) - dvec3(light), d = glm::normalize(dvec3(ray.direction));
        const double b = glm::dot(q, d), s = glm::length(glm::cross(q, d));
        const double expected = (std::atan((9 + b) / s) - std::atan(b / s)) / s * extinction / (4 * M_PI);
        EXPECT_NEAR(coned(snapshot, ray).radiance.x / expected, 1, 3e-5); // e^-1e-6·(9+13) is 2e-5 less
    }
}

TEST(Cone, NothingBehindTheApexAndNothingAtZeroAngle) {
    const Ray behind{{-4, 0, 1}, {1, 0, 0}, 8}, across{{-4, 0, -1}, {1, 0, 0}, 8};
    const Snapshot narrow = snapshot_of({homogeneous_medium(0.3f)}, {spot(vec3(0), {0, 0, -1}, 5, 20)});
    EXPECT_EQ(coned(narrow, behind).radiance.x, 0);
    EXPECT_GT(coned(narrow, across).radiance.x, 0);
    EXPECT_EQ(coned(narrow, {{0, 0, 0.5f}, {0, 0, 1}, 8}).radiance.x, 0); // away along the axis
    const Snapshot none = snapshot_of({homogeneous_medium(0.3f)}, {spot(vec3(0), {0, 0, -1}, 0, 0)});
    EXPECT_EQ(coned(none, across).radiance.x, 0);
    EXPECT_EQ(coned(none, {{0, 0, 4}, {0, 0, -1}, 8}).radiance.x, 0);
}

TEST(Cone, NarrowSpotsAreAsBrightAsWide) {
    const Ray ray{{0, 0, -3}, {0, 0, 1}, 2}; // on the axis, towards the light
    const auto light_of = [&](double inner, double outer) {
        return coned(snapshot_of({homogeneous_medium(0.2f)}, {spot(vec3(0), {0, 0, -1}, inner, outer)}), ray)
            .radiance.x;
    };
    for (const double degrees : {0.051, 0.07, 0.1, 0.5})
        for (const double inner : {0.0, 1.0})
            EXPECT_NEAR(light_of(inner * degrees, degrees) / light_of(10, 20), 1, 1e-4) << degrees;
}

TEST(Cone, NinetyDegreesIsHalfOfAPointLight) {
    const Snapshot half = snapshot_of({homogeneous_medium(0.3f)}, {spot(vec3(0), {0, 0, -1}, 90, 90)});
    const Snapshot point = snapshot_of({homogeneous_medium(0.3f)}, {point_light(vec3(0))});
    // From z = -2 to the plane z = 0, and on behind it.
    const Ray beyond = towards({-1, 0.4f, -2}, {1, 0.2f, 2}, 6);
    const Ray until{beyond.origin, beyond.direction, 2 / beyond.direction.z};
    EXPECT_NEAR(coned(half, beyond).radiance.x / coned(point, until).radiance.x, 1, 1e-5);
}

TEST(Cone, TheLensOnlyCutsAway) {
    // A lens of 0.2 m in a cone of 45 degrees: no light before 0.2 m along the axis, the same light behind.
    Settings lens;
    lens.of<ConeSettings>().near_radius = 0.2f;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.3f)}, {spot(vec3(0), {0, 0, -1}, 30, 45)});
    const Ray near{{-4, 0, -0.19f}, {1, 0, 0}, 8}, far{{-4, 0, -0.21f}, {1, 0, 0}, 8};
    EXPECT_EQ(coned(snapshot, near, lens).radiance.x, 0);
    EXPECT_EQ(coned(snapshot, far, lens).radiance.x, coned(snapshot, far).radiance.x);
    const Ray slanted = towards({0.1f, 0, 2}, {0, 0.05f, -2}, 6);
    const Ray rest{slanted.at(2.2f / -slanted.direction.z), slanted.direction, 6 + 2.2f / slanted.direction.z};
    const double dimmed = std::exp(-0.3 * 2.2 / -slanted.direction.z);
    EXPECT_NEAR(coned(snapshot, slanted, lens).radiance.x / (dimmed * coned(snapshot, rest).radiance.x), 1, 1e-5);
    EXPECT_LT(coned(snapshot, slanted, lens).radiance.x, coned(snapshot, slanted).radiance.x);
}

TEST(Cone, StaysSmoothThroughTheLight) {
    for (const float radius : {0.0f, 0.05f}) {
        Light light = point_light(vec3(0));
        light.radius = radius;
        const Snapshot snapshot = snapshot_of({homogeneous_medium(0.3f)}, {light});
        const float at = coned(snapshot, towards({0, 0, 3}, {1e-7f, 0, 0}, 6)).radiance.x;
        const float beside = coned(snapshot, towards({0, 0, 3}, {2e-7f, 0, 0}, 6)).radiance.x;
        const float through = coned(snapshot, {{0, 0, 3}, {0, 0, -1}, 6}).radiance.x;
        EXPECT_NEAR(at / beside, 1, 1e-2);
        EXPECT_NEAR(at / through, 1, 1e-2);
    }
}

TEST(Cone, AmbientLightAndEmissionOfOverlappingMedia) {
    // Constant glow per extinction c_m on overlapping slabs: piecewise c (1 - e^-τ).
    Medium first = homogeneous_medium(0.5f, {vec3(-1), vec3(1)}),
           second = homogeneous_medium(1.5f, {vec3(-1, -1, -1), vec3(1, 1, 0)});
    first.optics.albedo = vec3(0.5f), second.optics.emission.radiance = vec3(3), second.optics.albedo = vec3(0);
    const Snapshot snapshot = snapshot_of({first, second}, {}, vec3(2));
    const Scatter result = coned(snapshot, {{0, 0, 5}, {0, 0, -1}, 20});
    const double t1 = std::exp(-0.5), t2 = std::exp(-2.0);
    EXPECT_NEAR(result.radiance.x / (1 * (1 - t1) + t1 * (0.25 * 1 + 0.75 * 2) * (1 - t2)), 1, 1e-5);
    EXPECT_NEAR(result.transmittance / (t1 * t2), 1, 1e-6);
}

TEST(Cone, FollowsTheReferenceInEvenFogUnderALampAndASun) {
    const Light lamp = spot({0.3f, 2, -1}, {0.1f, -1, 0.1f}, 15, 25, 20);
    const Box box{vec3(-3, -1, -3), vec3(3, 3, 3)};
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.4f, box, {PhaseKind::henyey_greenstein, 0.5f})},
                                    {lamp, sun_light({0.5f, -1, 0.2f})}, vec3(0.02f));
    snapshot.media[0].optics.albedo = vec3(0.9f, 0.8f, 0.7f), snapshot.lights[0].volume_scale = 1.5f;
    std::vector<Ray> rays;
    for (int i = 0; i < 32; ++i) {
        const Sample2 at = sample2(i, 3);
        rays.push_back(towards({0, 1, 7}, {4 * at.x - 2, 3 * at.y - 1, 0}, 12));
    }
    std::vector<vec3> parts;
    View view;
    view.camera.position = {0, 1, 7};
    const std::vector<Scatter> exact = marched(snapshot, exact_settings(), rays);
    const std::vector<Scatter> got = run_mode("cone", view, snapshot, {}, rays, &parts);
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_NEAR(glm::distance(got[i].radiance, exact[i].radiance) / glm::length(exact[i].radiance), 0, 2e-3);
        EXPECT_NEAR(got[i].transmittance / exact[i].transmittance, 1, 1e-5);
        const vec3 *of_ray = &parts[part_count(2) * i], ambient = got[i].radiance - of_ray[0] - of_ray[1];
        const vec3 expected = vec3(0.9f, 0.8f, 0.7f) * 0.02f * (1 - got[i].transmittance);
        EXPECT_NEAR(glm::distance(ambient, expected), 0, 1e-6f * glm::length(got[i].radiance) + 1e-7f);
        EXPECT_NEAR(glm::distance(of_ray[2], expected), 0, 1e-6f * glm::length(got[i].radiance) + 1e-7f);
    }
}

TEST(Cone, EveryControlDoesWhatItSays) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.4f)}, {spot({0, 2, 0}, {0, -1, 0}, 10, 20)});
    const Ray ray{{-3, 0, 0}, {1, 0, 0}, 8};
    const float plain = coned(snapshot, ray).radiance.x;
    const auto with = [&](auto change) {
        Settings settings;
        change(settings);
        return coned(snapshot, ray, settings).radiance.x;
    };
    // Inverse square at 2 m and more is less than a quarter of none.
    EXPECT_GT(with([](Settings& s) { s.of<ConeSettings>().attenuation = ConeAttenuation::none; }), 3.9f * plain);
    const float none = with([](Settings& s) { s.of<ConeSettings>().attenuation = ConeAttenuation::none; });
    EXPECT_LT(with([](Settings& s) { s.of<ConeSettings>().attenuation = ConeAttenuation::linear; }), none);
    EXPECT_GT(with([](Settings& s) { s.of<ConeSettings>().edge = ConeEdge::soft, s.of<ConeSettings>().inner = 1; }),
              1.2f * plain);
    EXPECT_LT(with([](Settings& s) { s.of<ConeSettings>().edge = ConeEdge::soft, s.of<ConeSettings>().inner = 0; }),
              plain);
    const float noisy = with([](Settings& s) { s.of<ConeSettings>().noise = 1; });
    EXPECT_NE(noisy, plain);
    EXPECT_NEAR(noisy / plain, 1, 0.9);
    EXPECT_EQ(with([](Settings& s) { s.of<ConeSettings>().noise = 1; }), noisy);
    EXPECT_EQ(with([](Settings& s) { s.style.range = 1; }), 0);
    EXPECT_NEAR(with([](Settings& s) { s.style.tint = vec3(0.5f); }) / plain, 0.5, 1e-6);
    EXPECT_GT(with([](Settings& s) { s.style.light_depth = 0; }), 1.5f * plain);
    EXPECT_LT(with([](Settings& s) { s.style.view_depth = 3; }), 0.5f * plain);
}

TEST(Cone, NamesWhatItDoesNotSee) {
    const Mode& mode = find_mode("cone");
    Snapshot snapshot = snapshot_of({medium_of(unit_volume(8, [](vec3 p) { return p.x; }), 1)}, {point_light(vec3(2))});
    EXPECT_TRUE(has_limitation(mode.limitations({}, snapshot, {}), limitation::drawn_as_homogeneous));
    EXPECT_EQ(coned(snapshot, {{0.5f, 0.5f, 3}, {0, 0, -1}, 10}).validity, 0.5f);
    EXPECT_EQ(coned(snapshot, {{5, 5, 3}, {0, 0, -1}, 10}).validity, 1.0f);
    Settings settings;
    settings.of<ConeSettings>().attenuation = ConeAttenuation::none;
    EXPECT_TRUE(has_limitation(mode.limitations({}, snapshot, settings), limitation::unphysical_attenuation));
}

// What is stated is what leaving out shadows does to the image.
TEST(Cone, StatesTheErrorOfMissingShadows) {
    const Box fog{vec3(-3, 0, -3), vec3(3, 3, 3)};
    for (const float edge : {-0.5f, 0.0f, 1.0f, 2.5f})
        for (const Light& light : {sun_light({0, -1, 0}), spot({0, 4, 0}, {0, -1, 0}, 0, 40)}) {
            SCOPED_TRACE(edge);
            const TestScene scene = make_scene({homogeneous_medium(0.1f, fog)}, {light}, {roof(edge, 3.5f)});
            const View view = view_of({0, 1.5f, 9}, {0, 1.5f, 0}, {64, 36});
            const std::vector<Ray> rays = pixel_rays(view, scene.snapshot);
            const double error = relative_rmse(run_mode("cone", view, scene.snapshot, Settings{}, rays),
                                               run_mode("march", view, scene.snapshot, exact_settings(), rays));
            const Limitations told = find_mode("cone").limitations(view, scene.snapshot, Settings{});
            const auto found =
                std::ranges::find_if(told, [](const Limitation& one) { return one.is(limitation::no_shadows); });
            const double stated = found == told.end() ? 0 : found->amounts[0] / 100;
            EXPECT_NEAR(stated, std::min(error, 100.0), (error < 1 ? 0.15 : 0.5) * stated + 0.02);
        }
}

TEST(GaussLegendre, IsExactForPolynomials) {
    for (int n = 1; n <= max_gauss_nodes; ++n)
        for (const int power : {0, 1, 2 * n - 1}) {
            double sum = 0;
            for (const QuadratureNode& node : gauss_legendre(n)) sum += node.weight * std::pow(node.at, power);
            EXPECT_NEAR(sum * (power + 1), 1, 2e-6) << n;
        }
}
}
}
