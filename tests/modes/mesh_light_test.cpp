// Light of surfaces that glow, in fog and on other surfaces: quadrature, march against paths, what others say of it.
#include "base/gauss_legendre.h"
#include "base/random.h"
#include "modes/area_light_limitations.h"
#include "modes/path/path_rays.h"
#include "modes/shared_limitations.h"
#include "scene/scene.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/lights/emission_surface.h"
#include "trace/occlusion/occluders.h"
#include "trace/small_scenes.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5;
const vec3 radiance(2, 3, 1);

// A square of 1 m at y = 1 that glows on both sides, over fog below it; with more surfaces that do not.
TestScene glowing_stage(std::vector<Medium> media, std::vector<Mesh> others = {}) {
    others.push_back(quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}));
    TestScene stage = make_scene(std::move(media), {}, others);
    Material glowing = lambert(vec3(0));
    glowing.name = "lamp", glowing.emission = radiance;
    stage.scene->materials = {lambert(vec3(1)), glowing};
    for (Mesh& mesh : stage.scene->meshes) mesh.material = 0;
    stage.scene->meshes.back().material = 1;
    add_surfaces(*stage.scene, stage.snapshot);
    return stage;
}

dvec3 light_by_quadrature(double extinction, const Phase& phase, const Ray& ray) {
    double sum = 0;
    constexpr int stretches = 8;
    for (int i = 0; i < stretches; ++i)
        for (const QuadratureNode& along : gauss_legendre(8)) {
            const double t = double(ray.t_max) * (i + along.at) / stretches;
            const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
            double arriving = 0;
            for (const QuadratureNode& u : gauss_legendre(32))
                for (const QuadratureNode& v : gauss_legendre(32)) {
                    const dvec3 offset = dvec3(u.at - 0.5, 1, v.at - 0.5) - point;
                    const double distance = glm::length(offset);
                    arriving += u.weight * v.weight * std::abs(offset.y) / (distance * distance * distance) *
                                std::exp(-extinction * distance) *
                                phase_value_of<double>(phase, glm::dot(offset, dvec3(ray.direction)) / distance);
                }
            sum += along.weight * double(ray.t_max) / stretches * extinction * std::exp(-extinction * t) * arriving;
        }
    return sum * dvec3(radiance);
}

RayEstimate marched_light(const Snapshot& snapshot, const Ray& ray, int samples, const Settings& settings = {}) {
    return estimate_ray(find_mode("march").prepare(View{}, snapshot, settings, nullptr), ray, samples, fog_light);
}

TEST(MeshLight, FogScattersOnceAsByQuadrature) {
    for (const Ray& ray : {Ray{{-2, 0.3f, 0.15f}, glm::normalize(vec3(1, 0.02f, -0.03f)), 4},
                           Ray{{-2, 1.6f, 0}, glm::normalize(vec3(1, -0.02f, 0.03f)), 4}})
        for (const float extinction : {0.3f, 1.5f})
            for (const Phase& phase : {Phase{PhaseKind::isotropic}, forward_phase(0.6f)}) {
                const TestScene stage = glowing_stage({homogeneous_medium(extinction, {vec3(-50), vec3(50)}, phase)});
                const dvec3 expected = light_by_quadrature(double{extinction}, phase, ray);
                for (const RayEstimate& found :
                     {traced(stage.snapshot, ray, 1 << 12, 1), marched_light(stage.snapshot, ray, 1 << 11)})
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_NEAR(found.value[c], expected[c], 0.003 * expected[c] + sigmas * found.error[c]);
                        EXPECT_LT(found.error[c], 0.01 * expected[c]);
                    }
            }
}

TEST(MeshLight, MarchIsAsPathsOfOneOrder) {
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return 0.2f + p.x * p.y; }), 3);
    const Medium colored = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, forward_phase(0.8f), vec3(0.9f, 0.5f, 0.2f));
    const TestScene stage = glowing_stage({grid, colored}, {roof(0.3f, 0.8f)});
    for (const Ray& ray : {Ray{{0.3f, 0.4f, 2}, glm::normalize(vec3(0.05f, -0.1f, -1)), 4},
                           Ray{{0.1f, 0.9f, 2}, glm::normalize(vec3(-0.08f, 0.03f, -1)), 4}}) {
        const RayEstimate paths = traced(stage.snapshot, ray, 1 << 12, 1);
        for (const Settings& settings : {Settings{}, exact_settings()}) {
            const RayEstimate march = marched_light(stage.snapshot, ray, 1 << 9, settings);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(march.value[c], paths.value[c],
                            sigmas * std::hypot(march.error[c], paths.error[c]) + 0.003 * paths.value[c]);
        }
    }
}

// Under a square, and with half of it behind a shade; as Howell's B-4.
TEST(MeshLight, SurfacesGetThePublishedIrradiance) {
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double quarter = 2 * (x / root * std::atan(x / root)) / (2 * std::numbers::pi);
    std::vector<vec2> u(1 << 17); // which half of the square is picked is by chance: .3 % of it
    for (uint32_t i = 0; i < u.size(); ++i) {
        const Sample2 pair = sample2(i, 5);
        u[i] = {pair.x, pair.y};
    }
    SurfacePoint point;
    point.normal = point.face_normal = {0, 1, 0}, point.instance = 0;
    for (const bool shaded : {false, true}) {
        std::vector<Mesh> others{floor_of(0, 1, 0)};
        if (shaded) others.push_back(quad({0, 0.5f, -9}, {9, 0, 0}, {0, 0, 18}));
        const TestScene stage = glowing_stage({}, others);
        const double expected = (shaded ? 2 : 4) * quarter;
        vec3 found(0);
        add_emitted_light(emitters_of(stage.snapshot), stage.snapshot, {&point, 1}, u, {&found, 1});
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected * double{radiance[c]}, 0.01 * found[c]);
    }
}

TEST(MeshLight, ModesSayWhatBecomesOfIt) {
    TestScene stage = glowing_stage({homogeneous_medium(0.5f, {vec3(-3), vec3(3)})});
    const View view = view_of({0.3f, 0.4f, 4}, {0, 0, 0});
    for (const Mode& mode : modes()) {
        const bool without = mode.name == "billboard" || mode.name == "radial-blur";
        const bool lamps = !without && mode.name != "march" && mode.name != "path";
        EXPECT_EQ(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::emission_lights_no_fog),
                  without)
            << mode.name;
        EXPECT_EQ(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::lamps_for_surfaces), lamps)
            << mode.name;
        EXPECT_FALSE(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::emission_lights_nothing));
    }
    stage.scene->materials[1].alpha_mode = AlphaMode::blend;
    for (const Mode& mode : modes())
        EXPECT_EQ(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::emission_lights_nothing),
                  mode.name != "path")
            << mode.name;
}
}
}
