// Lamps that stand for glowing surfaces: candela and reach by quadrature, and what techniques make of them.
#include "integrate/lights/mesh_lamps.h"

#include "base/gauss_legendre.h"
#include "modes/path/path_rays.h"
#include "scene/lights/light_filter.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/small_scenes.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const vec3 radiance(2, 3, 1);
const Medium far_fog = homogeneous_medium(0.05f, {{-1, -6, -1}, {1, -4, 1}}, forward_phase(0.3f));

// Meshes that glow, and others that do not.
TestScene stage_with(std::vector<Mesh> glowing, std::vector<Mesh> others = {}, std::vector<Medium> media = {far_fog}) {
    const size_t dark = others.size();
    others.insert(others.end(), glowing.begin(), glowing.end());
    TestScene stage = make_scene(std::move(media), {}, others);
    Material material = lambert(vec3(0));
    material.name = "lamp", material.emission = radiance;
    stage.scene->materials = {lambert(vec3(1)), material};
    for (size_t i = 0; i < others.size(); ++i) stage.scene->meshes[i].material = i < dark ? 0 : 1;
    add_surfaces(*stage.scene, stage.snapshot);
    return stage;
}

Mesh square(float y = 0) { return quad({-0.5f, y, -0.5f}, {1, 0, 0}, {0, 0, 1}); }

const dvec3 some_directions[] = {{0, -1, 0}, {0, 1, 0}, {0.6, -0.8, 0}, {-0.5, 0.5, 0.7}, {0.9, -0.2, -0.3}};

dvec3 candela(const Light& lamp, dvec3 direction) {
    return dvec3(lamp.intensity) * (lamp.filter ? filtered(*lamp.filter, direction) : dvec3(1));
}

TEST(MeshLamps, SquareHasItsCandelaInEveryDirection) {
    const auto found = mesh_lamps(stage_with({square()}).snapshot);
    ASSERT_EQ(found->lamps.size(), 1u);
    EXPECT_LT(glm::length(found->lamps[0].position), 0.02f);
    for (const dvec3& way : some_directions) {
        const dvec3 direction = glm::normalize(way);
        EXPECT_NEAR(candela(found->lamps[0], direction).y, 3 * std::abs(direction.y), 0.03) << way.y;
    }
}

// Half of the light where half of it gets through, and that of the half that a mask leaves, from its middle.
TEST(MeshLamps, AlphaTakesItsShareOfTheCandela) {
    for (const bool mask : {false, true}) {
        TestScene stage = stage_with({square()});
        Image<vec4> halves(ivec2(2, 1), vec4(1));
        if (mask) halves.at(0, 0).w = 0;
        Texture texture;
        texture.nearest = true, texture.texels = shared_texels(std::move(halves));
        Material& lamp = stage.scene->materials[1];
        lamp.alpha_mode = mask ? AlphaMode::mask : AlphaMode::blend, lamp.alpha = mask ? 1 : 0.5f;
        lamp.base_texture = 0, stage.scene->textures = {texture};
        add_surfaces(*stage.scene, stage.snapshot);
        const auto found = mesh_lamps(stage.snapshot);
        ASSERT_EQ(found->lamps.size(), 1u);
        EXPECT_LT(glm::distance(found->lamps[0].position, {mask ? 0.25f : 0.0f, 0, 0}), 0.02f);
        for (const dvec3& way : some_directions) {
            const dvec3 direction = glm::normalize(way);
            EXPECT_NEAR(candela(found->lamps[0], direction).y, 1.5 * std::abs(direction.y), 0.03) << way.y;
        }
    }
}

// What leaves a closed mesh is its area as seen from there: the light inside stays inside.
TEST(MeshLamps, BoxHasItsCandelaInEveryDirection) {
    const auto found = mesh_lamps(stage_with({box_of({-0.5f, -0.25f, -0.1f}, {0.5f, 0.25f, 0.1f})}).snapshot);
    ASSERT_EQ(found->lamps.size(), 1u);
    for (const dvec3& way : some_directions) {
        const dvec3 d = glm::abs(glm::normalize(way));
        const double area = 0.5 * 0.2 * d.x + 1 * 0.2 * d.y + 1 * 0.5 * d.z;
        EXPECT_NEAR(candela(found->lamps[0], glm::normalize(way)).x, 2 * area, 0.08 * 2 * area);
    }
}

// Light of the square at a place, by quadrature.
double exact_light(dvec3 place) {
    double sum = 0;
    for (const QuadratureNode& u : gauss_legendre(24))
        for (const QuadratureNode& v : gauss_legendre(24)) {
            const dvec3 offset = dvec3(u.at - 0.5, 0, v.at - 0.5) - place;
            const double distance = glm::length(offset);
            sum += u.weight * v.weight * std::abs(offset.y) / (distance * distance * distance);
        }
    return 3 * sum;
}

TEST(MeshLamps, ReachIsWhereTheSquareIsOffByATenth) {
    const auto found = mesh_lamps(stage_with({square()}).snapshot);
    const Light& lamp = found->lamps[0];
    const auto off = [&](dvec3 direction, double d) {
        const dvec3 place = dvec3(lamp.position) + d * glm::normalize(direction);
        return std::abs(candela(lamp, glm::normalize(direction)).y / (d * d) / exact_light(place) - 1);
    };
    double worst = 0;
    for (const dvec3 direction : {dvec3(0, -1, 0), dvec3(0, 1, 0), dvec3(1, -1, 0), dvec3(1, 1, 1), dvec3(0, -1, 1)}) {
        EXPECT_LT(off(direction, 1.1 * found->reach), 0.12);
        worst = std::max(worst, off(direction, 0.8 * found->reach));
    }
    EXPECT_GT(worst, 0.1) << "nearer it is further off";
}

TEST(MeshLamps, AtMostFourStandForManyMeshesWithAllTheirLight) {
    std::vector<Mesh> squares;
    for (int i = 0; i < 9; ++i) {
        const float x = static_cast<float>(3 * i);
        squares.push_back(quad({x - 0.5f, 0, -0.5f}, {1, 0, 0}, {0, 0, 1}));
    }
    const auto found = mesh_lamps(stage_with(squares).snapshot);
    EXPECT_EQ(found->lamps.size(), 4u);
    double sum = 0;
    for (const Light& lamp : found->lamps) sum += candela(lamp, {0, -1, 0}).y;
    EXPECT_NEAR(sum, 9 * 3, 0.02 * 9 * 3);
    EXPECT_EQ(mesh_lamps(make_scene({far_fog}, {}, {square()}).snapshot), nullptr) << "nothing glows";
}

// A camera that sees the fog far below the lamps.
View far_view() { return view_of({0, -5, 5}, {0, -5, 0}); }

// Some rays through the fog.
std::vector<Ray> some_rays(const TestScene& stage) {
    const std::vector<Ray> all = pixel_rays(far_view(), stage.snapshot, 10);
    std::vector<Ray> some;
    for (size_t i = all.size() / 3; i < all.size(); i += 101) some.push_back(all[i]);
    return some;
}

double fog_light_of(std::string_view mode, const TestScene& stage) {
    Settings settings = settings_for(Quality::preview);
    settings.fluence.orders = 1;
    return mean_of(run_mode(mode, far_view(), stage.snapshot, settings, some_rays(stage)));
}

// Of each ray the mean of many samples.
double marched_fog_light(const TestScene& stage) {
    const ScatterFunction march = find_mode("march").prepare(View{}, stage.snapshot, {}, nullptr);
    double sum = 0;
    const std::vector<Ray> rays = some_rays(stage);
    for (const Ray& ray : rays) sum += luminance(vec3(estimate_ray(march, ray, 1 << 9, fog_light).value));
    return sum / static_cast<double>(rays.size());
}

constexpr const char* with_lamps[] = {"froxel", "shadow-map", "shadow-volume", "cone"};

TEST(MeshLamps, FarFogIsAsInMarch) {
    for (const bool box : {false, true}) {
        const Mesh glowing = box ? box_of({-0.3f, -0.2f, -0.3f}, {0.3f, 0.2f, 0.3f}) : square();
        const TestScene stage = stage_with({glowing});
        const double march = marched_fog_light(stage);
        EXPECT_GT(march, 0);
        for (const char* mode : with_lamps)
            EXPECT_NEAR(fog_light_of(mode, stage), march, 0.08 * march) << mode << (box ? " box" : " square");
    }
}

TEST(MeshLamps, OthersShadowThemAndTheirLightCountsAsEmission) {
    const TestScene shaded = stage_with({square()}, {quad({-9, -1, -9}, {18, 0, 0}, {0, 0, 18})}),
                    open = stage_with({square()});
    for (const char* mode : {"froxel", "shadow-map", "shadow-volume"})
        EXPECT_LT(fog_light_of(mode, shaded), 0.02 * fog_light_of(mode, open)) << mode;
    const View view = far_view();
    const std::vector<Ray> rays = pixel_rays(view, open.snapshot, 10);
    for (const char* mode : with_lamps) {
        std::vector<vec3> parts;
        const auto whole = run_mode(mode, view, open.snapshot, settings_for(Quality::preview), rays, &parts);
        double emission = 0, all = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            emission += double{luminance(parts[i * part_count(0) + static_cast<size_t>(OtherLight::emission)])},
                all += double{luminance(whole[i].radiance)};
        EXPECT_NEAR(emission, all, 2e-3 * all) << mode;
        Settings off = settings_for(Quality::preview);
        off.terms.emission = false;
        EXPECT_EQ(mean_of(run_mode(mode, view, open.snapshot, off, rays)), 0) << mode;
    }
}
}
}
