// Rectangles, discs and balls of light in fog and on surfaces: quadrature, march against paths, what the eye sees.
#include "base/gauss_legendre.h"
#include "base/image.h"
#include "base/random.h"
#include "modes/area_light_limitations.h"
#include "modes/light_filters.h"
#include "modes/path/path_rays.h"
#include "modes/shared_limitations.h"
#include "scene/lights/gobo.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/face_lights.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/surface.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double sigmas = 4.5;
const Box wide_box{vec3(-50), vec3(50)};

std::vector<Light> some_faces() {
    return {rectangle_light({0.2f, 1, -0.1f}, {0.2f, -1, 0.1f}, {1.2f, 0.5f}, vec3(1, 2, 3)),
            disc_light({-0.3f, 1, 0.2f}, {0, -1, -0.3f}, 0.4f, vec3(2, 1, 1)),
            sphere_light({0.4f, 1, 0.3f}, 0.35f, vec3(1, 1, 2)),
            face_light(LightKind::rectangle, {0, 0.6f, 0.1f}, {1, -0.3f, 0}, {0.8f, 0.6f}, vec3(1), true)};
}

void expect_near(const RayEstimate& got, dvec3 expected, double share, const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(got.value[c], expected[c], share * expected[c] + sigmas * got.error[c]) << what;
        EXPECT_LT(got.error[c], share * expected[c]) << what;
    }
}

RayEstimate marched_light(const Snapshot& snapshot, const Ray& ray, int samples, const Settings& settings = {}) {
    return estimate_ray(find_mode("march").prepare(View{}, snapshot, settings, nullptr), ray, samples, fog_light);
}

RayEstimate path_fog_light(const Snapshot& snapshot, const Ray& ray, int samples) {
    return estimate_ray(path_mode(snapshot, 1), ray, samples, fog_light);
}

// Points of a face, and the square meters that each stands for, as seen along its own normal.
struct FaceNode {
    dvec3 at, normal;
    double area;
};
std::vector<FaceNode> nodes_of(const AreaShape& shape) {
    std::vector<FaceNode> nodes;
    const dvec3 center(shape.center), x(shape.right), y(shape.up), z(shape.normal);
    constexpr int turns = 48;
    for (const QuadratureNode& u : gauss_legendre(24)) {
        if (shape.kind == LightKind::rectangle)
            for (const QuadratureNode& v : gauss_legendre(24))
                nodes.push_back({center + (2 * u.at - 1) * shape.half.x * x + (2 * v.at - 1) * shape.half.y * y, z,
                                 u.weight * v.weight * face_area(shape)});
        for (int k = 0; k < turns && shape.kind != LightKind::rectangle; ++k) {
            const double turn = 2 * std::numbers::pi * (k + 0.5) / turns, r = shape.half.x;
            const dvec3 across = std::cos(turn) * x + std::sin(turn) * y;
            if (shape.kind == LightKind::disc)
                nodes.push_back(
                    {center + r * u.at * across, z, u.weight * 2 * std::numbers::pi * r * r * u.at / turns});
            for (const double half : {-1.0, 1.0}) {
                if (shape.kind != LightKind::sphere) break;
                const dvec3 normal = half * u.at * z + std::sqrt(1 - u.at * u.at) * across;
                nodes.push_back({center + r * normal, normal, u.weight * 2 * std::numbers::pi * r * r / turns});
            }
        }
    }
    return nodes;
}

// Scattered once along a ray in fog that is the same everywhere.
dvec3 light_by_quadrature(const Light& light, const Phase& phase, double extinction, const Ray& ray) {
    const std::vector<FaceNode> nodes = nodes_of(*light.area);
    double sum = 0;
    constexpr int stretches = 12;
    for (int i = 0; i < stretches; ++i)
        for (const QuadratureNode& along : gauss_legendre(8)) {
            const double t = double(ray.t_max) * (i + along.at) / stretches;
            const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
            double arriving = 0;
            for (const FaceNode& node : nodes) {
                const dvec3 offset = node.at - point;
                const double distance = glm::length(offset), facing = -glm::dot(node.normal, offset) / distance;
                const double seen = light.area->two_sided ? std::abs(facing) : std::max(facing, 0.0);
                arriving += node.area * seen / (distance * distance) * std::exp(-extinction * distance) *
                            phase_value_of<double>(phase, glm::dot(offset, dvec3(ray.direction)) / distance);
            }
            sum += along.weight * double(ray.t_max) / stretches * extinction * std::exp(-extinction * t) * arriving;
        }
    return sum * dvec3(radiance_of(light));
}

const Ray below{{-2, 0.1f, 0.15f}, glm::normalize(vec3(1, 0.02f, -0.03f)), 4};

TEST(FaceLight, FogScattersOnceAsByQuadrature) {
    for (const Light& light : some_faces())
        for (const float extinction : {0.3f, 1.5f})
            for (const Phase& phase : {Phase{PhaseKind::isotropic}, forward_phase(0.6f)}) {
                const Ray ray = light.area->two_sided ? Ray{{-2, 0, -0.9f}, {1, 0, 0}, 4} : below;
                const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, wide_box, phase)}, {light});
                const dvec3 expected = light_by_quadrature(light, phase, double(extinction), ray);
                expect_near(path_fog_light(snapshot, ray, 1 << 10), expected, 0.005, "path");
                expect_near(marched_light(snapshot, ray, 1 << 8), expected, 0.005, "march");
            }
}

Ray towards_face(const Light& light) {
    return light.area->two_sided ? Ray{{-1, 0.5f, -0.6f}, glm::normalize(vec3(1, 0.1f, 0.5f)), 0.9f}
                                 : Ray{{0, -2, 0.1f}, glm::normalize(vec3(0.1f, 1, 0)), 2.6f};
}

// Directions are then picked by the phase function as well, near and far from discs.
TEST(FaceLight, NarrowPhaseFunctionsFindTheFace) {
    for (Light light : some_faces()) {
        const Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, wide_box, forward_phase(0.9f))}, {light});
        const Ray past = towards_face(light);
        const dvec3 expected = light_by_quadrature(light, forward_phase(0.9f), 0.5, past);
        expect_near(marched_light(snapshot, past, 1 << 11), expected, 0.005, "march");
        expect_near(path_fog_light(snapshot, past, 1 << 12), expected, 0.01, "path");
    }
}

// Of light without shadows paths find nothing by their directions: where there are no surfaces it has to be the same.
TEST(FaceLight, PathsFindTheSameByTheirDirectionsAndByAimingAlone) {
    const Medium fog = homogeneous_medium(1, {vec3(-1.5f), vec3(1.5f)}, forward_phase(0.95f), vec3(0.9f));
    for (Light light : some_faces()) {
        const Ray ray = towards_face(light);
        const auto estimate = [&](bool shadows) {
            light.shadows = shadows;
            return estimate_ray(path_mode(snapshot_of({fog}, {light}), 4), ray, 1 << 9, fog_light);
        };
        const RayEstimate both = estimate(true), aimed = estimate(false);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(both.value[c], aimed.value[c], sigmas * std::hypot(both.error[c], aimed.error[c]));
            EXPECT_LT(both.error[c], 0.7 * aimed.error[c]) << traits_of(light.area->kind).name;
            EXPECT_LT(both.error[c], 0.05 * both.value[c]);
        }
    }
}

TEST(FaceLight, MarchIsAsPathsOfOneOrder) {
    const Medium grid = medium_of(unit_volume(16, [](vec3 p) { return 0.2f + p.x * p.y; }), 3);
    Medium colored = homogeneous_medium(0.5f, {vec3(-1), vec3(2)}, forward_phase(0.8f), vec3(0.9f, 0.5f, 0.2f));
    Light lamp = point_light({0.8f, 0.9f, 0.5f}, 2);
    std::vector<Light> lights{lamp};
    for (Light& face : some_faces()) {
        face.intensity *= 0.5f;
        lights.push_back(face);
    }
    lights[2].shadows = false;
    for (const std::vector<Medium>& media : {std::vector{grid}, std::vector{grid, colored}}) {
        const TestScene stage = make_scene(media, lights, {roof(0.3f, 0.8f)});
        for (const Ray& ray : {Ray{{0.3f, 0.4f, 2}, glm::normalize(vec3(0.05f, -0.1f, -1)), 4},
                               Ray{{0.7f, 0.3f, 2}, glm::normalize(vec3(-0.08f, 0.15f, -1)), 4}}) {
            const RayEstimate paths = path_fog_light(stage.snapshot, ray, 1 << 9);
            for (const Settings& settings : {Settings{}, exact_settings()}) {
                const RayEstimate march = marched_light(stage.snapshot, ray, 1 << 7, settings);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(march.value[c], paths.value[c],
                                sigmas * std::hypot(march.error[c], paths.error[c]) + 0.003 * paths.value[c]);
            }
        }
    }
}

TEST(FaceLight, LightThatScattersOftenStartsAllOverTheFace) {
    const Medium fog = homogeneous_medium(1, {vec3(-1.5f), vec3(1.5f)}, forward_phase(0.3f), vec3(0.9f));
    Settings settings;
    settings.fluence.orders = all_orders;
    const Ray ray{{-0.5f, -0.6f, 3}, glm::normalize(vec3(0.1f, 0.08f, -1)), 6};
    for (Light light : some_faces()) {
        AreaShape hidden = *light.area;
        hidden.visible = false;
        light.area = std::make_shared<const AreaShape>(hidden);
        const Snapshot snapshot = snapshot_of({fog}, {light});
        const RayEstimate paths = traced(snapshot, ray, 1 << 9);
        const double march = marched_light(snapshot, ray, 1 << 6, settings).value.x;
        EXPECT_GT(march, 2 * marched_light(snapshot, ray, 1 << 6).value.x) << "most of it is scattered more than once";
        // Cells of 5 cm are 3 % off beside a face that stands in the fog, half as much at half their size.
        EXPECT_NEAR(march, paths.value.x, 0.04 * paths.value.x + sigmas * paths.error.x) << traits_of(hidden.kind).name;
    }
}

TEST(FaceLight, PartsOfTheFogAreThoseOfTheLights) {
    std::vector<Light> lights = some_faces();
    lights.insert(lights.begin(), point_light({0.8f, 0.9f, 0.5f}, 2));
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, wide_box)}, lights);
    for (const char* mode : {"march", "path"}) {
        std::vector<vec3> parts;
        const Scatter all = run_mode(mode, View{}, snapshot, {}, {below}, &parts).front();
        ASSERT_EQ(parts.size(), part_count(lights.size()));
        vec3 sum(0);
        for (const vec3& part : parts) sum += part;
        EXPECT_NEAR(luminance(sum), luminance(all.radiance), 1e-5f * luminance(sum)) << mode;
        if (mode != std::string_view("march")) continue;
        for (size_t l = 0; l < lights.size(); ++l) EXPECT_GT(max_component(parts[l]), 0) << l;
    }
}

TEST(FaceLight, SurfacesGetThePublishedIrradiance) {
    // Under a rectangle of 1.6 × 0.8 m, and half of it behind a shade; as Howell's B-4.
    const auto corner = [](double a, double b, double c) {
        const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
        return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
    };
    const Light light = rectangle_light({0, 1, 0}, {0, -1, 0}, {1.6f, 0.8f}, vec3(5));
    const double full = 4 * corner(0.8, 0.4, 1) * 5;
    constexpr size_t count = 4096;
    std::vector<vec2> u(count);
    for (uint32_t i = 0; i < count; ++i) {
        const Sample2 pair = sample2(i, 5);
        u[i] = {pair.x, pair.y};
    }
    SurfacePoint point;
    point.normal = point.face_normal = {0, 1, 0}, point.instance = 0;
    for (const bool shaded : {false, true}) {
        std::vector<Mesh> meshes{floor_of(0, 1, 0)};
        if (shaded) meshes.push_back(quad({0, 0.5f, -9}, {9, 0, 0}, {0, 0, 18}));
        TestScene stage = make_scene({}, {light}, meshes);
        vec3 radiance;
        shade_surfaces(stage.snapshot, {}, {&point, 1}, u, {&radiance, 1});
        EXPECT_NEAR(radiance.x, shaded ? 0.5 * full : full, 0.003 * full);

        stage.scene->materials = {lambert(vec3(1))};
        add_surfaces(*stage.scene, stage.snapshot);
        const Ray ray{{0.02f, 0.4f, 0.01f}, glm::normalize(vec3(-0.02f, -0.4f, -0.01f)), 3};
        const RayEstimate paths = estimate_ray(path_mode(stage.snapshot, 1), ray, 1 << 10, surface_light);
        EXPECT_NEAR(paths.value.x, shaded ? 0.5 * full : full, 0.004 * full);
    }
}

TEST(FaceLight, EyeSeesItThroughTheFog) {
    const Medium fog = homogeneous_medium(0.5f, wide_box);
    for (const Light& light : some_faces()) {
        const vec3 towards = light.area->kind == LightKind::sphere ? vec3(0, 1, 0) : -light.area->normal;
        const Ray ray{light.position - 2.0f * towards, towards, 100};
        const double distance = area_hit(*light.area, ray);
        const Snapshot snapshot = snapshot_of({fog}, {light});
        const RayEstimate seen = estimate_ray(path_mode(snapshot, 1), ray, 64, surface_light);
        const double expected = double(radiance_of(light).x) * std::exp(-0.5 * distance);
        EXPECT_NEAR(seen.value.x, expected, 1e-4 * expected);
        AreaShape hidden = *light.area;
        hidden.visible = false;
        Light unseen = light;
        unseen.area = std::make_shared<const AreaShape>(hidden);
        EXPECT_EQ(estimate_ray(path_mode(snapshot_of({fog}, {unseen})), ray, 16, surface_light).value.x, 0);
    }
}

// White at the left of who looks at it, black at the right.
std::shared_ptr<const Gobo> half_white() {
    Image<vec3> image({64, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 32; ++x) image.at(x, y) = vec3(1);
    return make_gobo(image);
}

TEST(FaceLight, PictureOfHalfIsHalfTheFace) {
    const Light whole = rectangle_light({0.2f, 1, -0.1f}, {0.2f, -1, 0.1f}, {1.2f, 0.5f}, vec3(1, 2, 3));
    const Light light = picture_light(whole, half_white());
    // The left of who looks at the face is the right of who looks along the light.
    const Light half =
        rectangle_light(whole.area->center + 0.3f * whole.area->right, whole.area->normal, {0.6f, 0.5f}, vec3(1, 2, 3));
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, wide_box, forward_phase(0.6f))}, {light});
    const dvec3 expected = light_by_quadrature(half, forward_phase(0.6f), 0.5, below);
    expect_near(path_fog_light(snapshot, below, 1 << 11), expected, 0.006, "path");
    expect_near(marched_light(snapshot, below, 1 << 9), expected, 0.006, "march");

    // The lamp that stands for it is the one that stands for half the face.
    tyndall::expect_near(light.position, half.position, 1e-5f);
    tyndall::expect_near(light.intensity, half.intensity, 1e-5f);
    EXPECT_NEAR(far_distance(*light.area, 0.1), far_distance(*half.area, 0.1), 0.1 * far_distance(*half.area, 0.1));

    // The eye sees the white half as bright as the face, the other black.
    for (const float side : {-1.0f, 1.0f}) {
        const vec3 at = whole.area->center + 0.2f * side * whole.area->right;
        const Ray ray{at + 0.5f * whole.area->normal, -whole.area->normal, 9};
        const RayEstimate seen = estimate_ray(path_mode(snapshot_of({}, {light})), ray, 4, surface_light);
        EXPECT_NEAR(seen.value.y, side > 0 ? 2 : 0, 1e-4);
    }
}

TEST(FaceLight, PictureOfHalfIsHalfTheFaceOnSurfacesAndAfterManyOrders) {
    const Light whole = rectangle_light({0, 1, 0}, {0, -1, 0}, {1.6f, 0.8f}, vec3(5));
    const Light light = picture_light(whole, half_white());
    const Light half = rectangle_light(0.4f * whole.area->right + vec3(0, 1, 0), {0, -1, 0}, {0.8f, 0.8f}, vec3(5));
    std::vector<vec2> u(4096);
    for (uint32_t i = 0; i < u.size(); ++i) {
        const Sample2 pair = sample2(i, 5);
        u[i] = {pair.x, pair.y};
    }
    SurfacePoint point;
    point.normal = point.face_normal = {0, 1, 0}, point.instance = 0;
    vec3 got[2], expected[2];
    for (int i = 0; i < 2; ++i) {
        point.position = {i == 0 ? -0.5f : 0.5f, 0, 0};
        shade_surfaces(make_scene({}, {light}, {floor_of(0, 1, 0)}).snapshot, {}, {&point, 1}, u, {&got[i], 1});
        shade_surfaces(make_scene({}, {half}, {floor_of(0, 1, 0)}).snapshot, {}, {&point, 1}, u, {&expected[i], 1});
        EXPECT_NEAR(got[i].x, expected[i].x, 0.004f * expected[i].x);
    }
    EXPECT_GT(std::abs(got[0].x - got[1].x), 0.2f * got[0].x);

    Settings settings;
    settings.fluence.orders = all_orders;
    const Medium fog = homogeneous_medium(1, {vec3(-1.5f), vec3(1.5f, 0.9f, 1.5f)}, {}, vec3(0.9f));
    const Ray ray{{-0.5f, -0.6f, 3}, glm::normalize(vec3(0.1f, 0.08f, -1)), 6};
    const double from_picture = marched_light(snapshot_of({fog}, {light}), ray, 1 << 6, settings).value.x;
    const double from_half = marched_light(snapshot_of({fog}, {half}), ray, 1 << 6, settings).value.x;
    EXPECT_NEAR(from_picture, from_half, 0.04 * from_half);
}

TEST(FaceLight, CosineEmissionIsNoProfile) {
    const Light face = rectangle_light({0, 1, -3}, {0, -1, 0}, {0.1f, 0.1f}, vec3(1));
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, wide_box)}, {face});
    const View view = view_of({0, 0, 0}, {0, 0, -1}, {48, 27});
    for (const Mode& mode : modes()) {
        const Limitations limitations = mode.limitations(view, snapshot, {});
        EXPECT_FALSE(has_limitation(limitations, limitation::blurred_filter)) << mode.name;
        EXPECT_FALSE(has_limitation(limitations, limitation::sampled_gobo)) << mode.name;
    }
}

TEST(FaceLight, OthersSayWhereALampStandsForIt) {
    const Snapshot with = snapshot_of({homogeneous_medium(0.5f, wide_box)}, {sphere_light({0, 1, -3}, 0.2f)});
    const Snapshot without = snapshot_of({homogeneous_medium(0.5f, wide_box)}, {point_light({0, 1, -3})});
    const View view = view_of({0, 0, 0}, {0, 0, -1});
    for (const Mode& mode : modes()) {
        const bool own = mode.name == "march" || mode.name == "path";
        EXPECT_EQ(has_limitation(mode.limitations(view, with, {}), limitation::lamp_for_face), !own) << mode.name;
        EXPECT_FALSE(has_limitation(mode.limitations(view, without, {}), limitation::lamp_for_face)) << mode.name;
    }
}
}
}
