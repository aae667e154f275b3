// Light of surfaces that emitter, opaque or not, in fog and on other surfaces: quadrature, march against paths, what
// others say of it.
#include "base/gauss_legendre.h"
#include "base/random.h"
#include "modes/area_light_limitations.h"
#include "modes/path/path_rays.h"
#include "modes/shared_limitations.h"
#include "scene/scene.h"
#include "support/expect.h"
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

// What of the square glows, from this share of its width on, and how much of that the eye sees of it.
struct Emitter {
    const char* name = "opaque";
    AlphaMode mode = AlphaMode::opaque;
    float alpha = 1, start = 0;
};
constexpr Emitter with_alpha[] = {{"blend", AlphaMode::blend, 0.5f},
                                  {"mask", AlphaMode::mask, 1, 0.75f},
                                  {"blended texture", AlphaMode::blend, 0.8f, 0.75f}};

// A square of 1 m at y = 1 that glows on both sides, over fog below it; with more surfaces that do not.
TestScene glowing_stage(std::vector<Medium> media, std::vector<Mesh> others = {}, const Emitter& emitter = {}) {
    others.push_back(quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}));
    TestScene stage = make_scene(std::move(media), {}, others);
    Material glowing = lambert(vec3(0), radiance);
    glowing.name = "lamp", glowing.alpha_mode = emitter.mode, glowing.alpha = emitter.alpha;
    Image<vec4> columns(ivec2(4, 1), vec4(1));
    for (int x = 0; x < 4; ++x) columns.at(x, 0).w = static_cast<float>(x) < 4 * emitter.start ? 0.0f : 1.0f;
    Texture texture;
    texture.nearest = true, texture.texels = shared_texels(std::move(columns));
    if (emitter.start > 0) glowing.base_texture = 0;
    stage.scene->materials = {lambert(vec3(1)), glowing}, stage.scene->textures = {texture};
    for (Mesh& mesh : stage.scene->meshes) mesh.material = 0;
    stage.scene->meshes.back().material = 1;
    add_surfaces(*stage.scene, stage.snapshot);
    return stage;
}

dvec3 light_by_quadrature(double extinction, const Phase& phase, const Ray& ray, const Emitter& emitter = {}) {
    const double start = double{emitter.start}, width = 1 - start;
    double sum = 0;
    constexpr int stretches = 8;
    for (int i = 0; i < stretches; ++i)
        for (const QuadratureNode& along : gauss_legendre(8)) {
            const double t = double(ray.t_max) * (i + along.at) / stretches;
            const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
            double arriving = 0;
            for (const QuadratureNode& u : gauss_legendre(32))
                for (const QuadratureNode& v : gauss_legendre(32)) {
                    const dvec3 offset = dvec3(start + width * u.at - 0.5, 1, v.at - 0.5) - point;
                    const double distance = glm::length(offset);
                    arriving += width * u.weight * v.weight * std::abs(offset.y) / (distance * distance * distance) *
                                std::exp(-extinction * distance) *
                                phase_value_of<double>(phase, glm::dot(offset, dvec3(ray.direction)) / distance);
                }
            sum += along.weight * double(ray.t_max) / stretches * extinction * std::exp(-extinction * t) * arriving;
        }
    return double{emitter.alpha} * sum * dvec3(radiance);
}

RayEstimate marched_light(const Snapshot& snapshot, const Ray& ray, int samples, const Settings& settings = {}) {
    return estimate_ray(find_mode("march").prepare(View{}, snapshot, settings, nullptr), ray, samples, fog_light);
}

// Radiance of a white floor below the square at y = 0, from many points on it.
vec3 floor_light(const TestScene& stage, vec3 place) {
    std::vector<vec2> u(1 << 17); // which half of the square is picked is by chance: .3 % of it
    for (uint32_t i = 0; i < u.size(); ++i) {
        const Sample2 pair = sample2(i, 5);
        u[i] = {pair.x, pair.y};
    }
    SurfacePoint point;
    point.position = place, point.normal = point.face_normal = {0, 1, 0}, point.instance = 0;
    vec3 found(0);
    add_emitted_light(emitters_of(stage.snapshot), stage.snapshot, {&point, 1}, u, {&found, 1});
    return found;
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

TEST(MeshLight, FogScattersWhatAlphaLeavesAsByQuadrature) {
    const Phase phase = forward_phase(0.6f);
    for (const Emitter& emitter : with_alpha)
        for (const Ray& ray : {Ray{{-2, 0.3f, 0.15f}, glm::normalize(vec3(1, 0.02f, -0.03f)), 4},
                               Ray{{-2, 1.6f, 0}, glm::normalize(vec3(1, -0.02f, 0.03f)), 4}}) {
            const TestScene stage =
                glowing_stage({homogeneous_medium(0.5f, {vec3(-50), vec3(50)}, phase)}, {}, emitter);
            const dvec3 expected = light_by_quadrature(0.5, phase, ray, emitter);
            for (const RayEstimate& found :
                 {traced(stage.snapshot, ray, 1 << 13, 1), marched_light(stage.snapshot, ray, 1 << 11)}) {
                EXPECT_NEAR(found.value.x, expected.x, 0.003 * expected.x + sigmas * found.error.x) << emitter.name;
                EXPECT_LT(found.error.x, 0.02 * expected.x) << emitter.name;
            }
        }
}

// Across the square, from clear to opaque and back within its texture and from side to side.
TestScene faded_stage(std::vector<Medium> media, AlphaMode mode) {
    TestScene stage = glowing_stage(std::move(media), {roof(0.3f, 0.8f), floor_of(0, 1)});
    Image<vec4> stripes(ivec2(4, 1), vec4(1));
    for (int x = 0; x < 4; ++x) stripes.at(x, 0).w = x % 2 ? 1.0f : 0.2f;
    Texture& texture = stage.scene->textures[0];
    texture.nearest = false, texture.texels = shared_texels(std::move(stripes));
    stage.scene->materials[1].base_texture = 0, stage.scene->materials[1].alpha_mode = mode;
    stage.scene->materials[1].base_color = vec3(0.5f);
    stage.scene->meshes.back().alphas = {0.9f, 1, 0.6f, 0.3f};
    add_surfaces(*stage.scene, stage.snapshot);
    return stage;
}

// Down to the square, past it, and onto the floor.
TEST(MeshLight, MarchIsAsPathsOfOneOrderWithAlpha) {
    const Medium fog = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, forward_phase(0.8f), vec3(0.9f, 0.5f, 0.2f));
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        const TestScene stage = faded_stage({fog}, mode);
        for (const Ray& ray : {Ray{{0.1f, 1.7f, 0.1f}, glm::normalize(vec3(-0.1f, -1, 0.05f)), 0.65f},
                               Ray{{0.1f, 0.9f, 2}, glm::normalize(vec3(-0.08f, 0.03f, -1)), 4}}) {
            const RayEstimate paths = estimate_ray(path_mode(stage.snapshot, 1), ray, 1 << 14, fog_light),
                              march = marched_light(stage.snapshot, ray, 1 << 11);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(march.value[c], paths.value[c],
                            sigmas * std::hypot(march.error[c], paths.error[c]) + 0.003 * paths.value[c]);
        }
        const Ray down{{0.1f, 0.5f, 0.1f}, {0, -1, 0}, 1};
        const RayEstimate seen = estimate_ray(path_mode(stage.snapshot, 1), down, 1 << 14, surface_light);
        const double lit = floor_light(stage, {0.1f, 0, 0.1f}).y * std::exp(-0.5 * 0.5);
        EXPECT_NEAR(seen.value.y, lit, sigmas * seen.error.y + 0.01 * lit);
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

// Under the corner of a rectangle at a distance of 1; Howell's B-4.
double under_corner(double width, double depth) {
    const auto part = [](double a, double b) {
        const double root = std::sqrt(1 + a * a);
        return a / root * std::atan(b / root);
    };
    return (part(width, depth) + part(depth, width)) / (2 * std::numbers::pi);
}

// Under a square, and with half of it behind a shade.
TEST(MeshLight, SurfacesGetThePublishedIrradiance) {
    const double quarter = under_corner(0.5, 0.5);
    for (const bool shaded : {false, true}) {
        std::vector<Mesh> others{floor_of(0, 1, 0)};
        if (shaded) others.push_back(quad({0, 0.5f, -9}, {9, 0, 0}, {0, 0, 18}));
        const TestScene stage = glowing_stage({}, others);
        const double expected = (shaded ? 2 : 4) * quarter;
        const vec3 found = floor_light(stage, vec3(0));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected * double{radiance[c]}, 0.01 * found[c]);
    }
}

// Half of the light of an opaque square, and that of the quarter that a mask leaves; as a path sees them.
TEST(MeshLight, SurfacesGetWhatAlphaLeaves) {
    for (const Emitter& emitter : with_alpha) {
        const TestScene stage = glowing_stage({}, {floor_of(0, 1, 0)}, emitter);
        const double hidden = emitter.start > 0 ? under_corner(0.25, 0.5) : -under_corner(0.5, 0.5);
        const double expected = 2 * double{emitter.alpha} * (under_corner(0.5, 0.5) - hidden) * double{radiance.y};
        EXPECT_NEAR(floor_light(stage, vec3(0)).y, expected, 0.01 * expected) << emitter.name;
        const RayEstimate seen = traced(stage.snapshot, {{0, 0.5f, 0}, {0, -1, 0}, 1}, 1 << 14, 1);
        EXPECT_NEAR(seen.value.y, expected, sigmas * seen.error.y) << emitter.name;
        EXPECT_LT(seen.error.y, 0.015 * expected) << emitter.name;
    }
}

TEST(MeshLight, StyleTintsItInFog) {
    const TestScene stage = glowing_stage({homogeneous_medium(0.5f, {vec3(-3), vec3(3)})});
    const View view = view_of({0.3f, 0.4f, 4}, {0, 0, 0}, {8, 8});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot);
    Settings plain, tinted;
    tinted.style.tint = {0.5f, 1, 0};
    for (const char* mode : {"march", "froxel", "shadow-map", "shadow-volume", "cone"}) {
        const std::vector<Scatter> all = run_mode(mode, view, stage.snapshot, plain, rays);
        const std::vector<Scatter> some = run_mode(mode, view, stage.snapshot, tinted, rays);
        EXPECT_GT(mean_of(all), 0) << mode;
        for (size_t i = 0; i < rays.size(); ++i)
            expect_near(some[i].radiance, all[i].radiance * tinted.style.tint, 1e-5f * max_component(all[i].radiance));
    }
}

// As light of paths that scatter more than once, in the mean of some rays: lamps and cells blur it, but keep its sum.
TEST(MeshLight, MarchScattersItFurther) {
    const TestScene stage = glowing_stage({homogeneous_medium(0.5f, {vec3(-3), vec3(3)}, {}, vec3(0.9f))});
    Settings once, all;
    all.fluence.orders = all_orders;
    const Limitations said = find_mode("march").limitations(View{}, stage.snapshot, all);
    EXPECT_TRUE(has_limitation(said, limitation::cached_fluence));
    EXPECT_TRUE(has_limitation(said, limitation::fog_scatters_alone));
    all.fluence.resolution = 16, all.fluence.paths = 200'000;
    const std::vector<Ray> rays{{{0, -1, 4}, {0, 0, -1}, 8},
                                {{-1.5f, -0.5f, 4}, {0, 0, -1}, 8},
                                {{4, 0.5f, -1}, {-1, 0, 0}, 8},
                                {{4, 2, 1}, {-1, 0, 0}, 8}};
    const double march = mean_of(marched(stage.snapshot, all, rays)) - mean_of(marched(stage.snapshot, once, rays));
    double paths = 0, variance = 0;
    for (const Ray& ray : rays)
        for (const int orders : {1, all_orders}) {
            const RayEstimate found = traced(stage.snapshot, ray, 1 << 11, orders);
            paths += (orders == 1 ? -1 : 1) * luminance(vec3(found.value)) / 4;
            variance += std::pow(luminance(vec3(found.error)) / 4, 2);
        }
    EXPECT_NEAR(march, paths, 0.05 * paths + sigmas * std::sqrt(variance));
    EXPECT_LT(sigmas * std::sqrt(variance), 0.1 * paths);
}

TEST(MeshLight, ModesSayWhatBecomesOfIt) {
    const View view = view_of({0.3f, 0.4f, 4}, {0, 0, 0});
    std::vector<Emitter> emitters{{}, {"clear", AlphaMode::blend, 0}};
    emitters.insert(emitters.end(), std::begin(with_alpha), std::end(with_alpha));
    for (const Emitter& emitter : emitters) {
        const TestScene stage = glowing_stage({homogeneous_medium(0.5f, {vec3(-3), vec3(3)})}, {}, emitter);
        for (const Mode& mode : modes()) {
            const bool seen = emitter.alpha > 0;
            const bool without = mode.name == "billboard" || mode.name == "radial-blur";
            const bool lamps = seen && !without && mode.name != "march" && mode.name != "path";
            EXPECT_EQ(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::emission_lights_no_fog),
                      seen && without)
                << mode.name << ", " << emitter.name;
            EXPECT_EQ(has_limitation(mode.limitations(view, stage.snapshot, {}), limitation::lamps_for_surfaces), lamps)
                << mode.name << ", " << emitter.name;
        }
    }
}
}
}
