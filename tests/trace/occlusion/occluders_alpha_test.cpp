
#include "scene/scene.h"
#include "support/meshes.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/shadow_rays.h"
#include "trace/small_scenes.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

// A square of 2×2 across z = `z`, seen along -z.
Mesh sheet(float z, int material) { return quad(vec3(-1, -1, z), vec3(2, 0, 0), vec3(0, 2, 0), material); }

void expect_transmission(const Scene& scene, float x, float y, float expected) {
    const auto occluders = Occluders::make(scene, 0, nullptr);
    Occluders::ShadowRays rays;
    set_ray(rays, -1, vec3(x, y, 0), vec3(0, 0, -1));
    float visibility[16];
    occluders->transmission(rays, visibility);
    for (int lane = 0; lane < 16; ++lane) EXPECT_FLOAT_EQ(visibility[lane], expected) << x << " " << y;
    EXPECT_FLOAT_EQ(occluders->transmission({vec3(x, y, 0), vec3(0, 0, -1)}, 0), expected);
}

TEST(OccludersAlpha, BlendSheetsMultiply) {
    Scene scene;
    scene.materials = {blend_material(0.5f)};
    add_mesh(scene, sheet(-1, 0));
    expect_transmission(scene, 0.3f, 0.1f, 0.5f);
    add_mesh(scene, sheet(-2, 0));
    expect_transmission(scene, 0.3f, 0.1f, 0.25f);
    expect_transmission(scene, 1.3f, 0.1f, 1);
    // Both sheets and the opaque one behind the ray's end.
    add_mesh(scene, sheet(-3, -1));
    expect_transmission(scene, 0.3f, 0.1f, 0);
}

TEST(OccludersAlpha, VerticesFadeBlendAndCutMasks) {
    Scene scene;
    scene.materials = {blend_material(1), blend_material(0.5f), blend_material(1)};
    scene.materials[2].alpha_mode = AlphaMode::mask;
    // From 0 at x = -1 to 1 at x = 1, whichever corner is where.
    for (const auto& [material, expected] : {std::pair{0, 0.25f}, {1, 0.625f}, {2, 0.0f}, {-1, 0.0f}}) {
        scene.meshes.clear(), scene.instances.clear();
        Mesh mesh = sheet(-1, material);
        for (const vec3& position : mesh.positions) mesh.alphas.push_back(0.5f + 0.5f * position.x);
        add_mesh(scene, mesh);
        expect_transmission(scene, 0.5f, 0.1f, expected);
        if (material == 2) expect_transmission(scene, -0.5f, 0.1f, 1);
    }
}

TEST(OccludersAlpha, WhatIsOpaqueCanBeLeftOut) {
    Scene scene;
    scene.materials = {blend_material(0.5f)};
    const auto alone = [&](float x) {
        Occluders::ShadowRays rays;
        set_ray(rays, -1, vec3(x, 0.1f, 0), vec3(0, 0, -1));
        float visibility[16];
        Occluders::make(scene, 0, nullptr)->alpha_transmission(rays, visibility);
        return visibility[0];
    };
    add_mesh(scene, sheet(-3, -1));
    EXPECT_EQ(alone(0.3f), 1);
    add_mesh(scene, sheet(-1, 0));
    EXPECT_EQ(alone(0.3f), 0.5f);
    EXPECT_EQ(alone(1.3f), 1);
    Node node;
    node.translation.times = {0, 1};
    node.translation.values = {vec3(0), vec3(0, 9, 0)};
    add_mesh(scene, sheet(-2, 0), node);
    EXPECT_EQ(alone(0.3f), 0.25f);
}

// The two triangles of a sheet share an edge; a ray on it meets one sheet, not two.
TEST(OccludersAlpha, SharedEdgesCountOnce) {
    Scene scene;
    scene.materials = {blend_material(0.5f)};
    add_mesh(scene, sheet(-1, 0));
    add_mesh(scene, sheet(-1.5f, 0));
    for (const float s : {-0.75f, -0.25f, 0.0f, 0.1f, 0.5f}) expect_transmission(scene, s, s, 0.25f);
}

TEST(OccludersAlpha, MovingAndStillSheetsMultiply) {
    Scene scene;
    scene.materials = {blend_material(0.5f), blend_material(0.75f)};
    add_mesh(scene, sheet(-1, 0));
    Node node;
    node.translation.times = {0, 1};
    node.translation.values = {vec3(0), vec3(0, 9, 0)};
    add_mesh(scene, sheet(-2, 1), node);
    expect_transmission(scene, 0.3f, 0.1f, 0.125f);
}

TEST(OccludersAlpha, OpaqueBlendBlocks) {
    Scene scene;
    scene.materials = {blend_material(1)};
    add_mesh(scene, sheet(-1, 0));
    expect_transmission(scene, 0.3f, 0.1f, 0);
}

// Left half of the texture clear, right half solid; nearest texels keep the border sharp.
Texture half_clear(float clear_alpha) {
    Texture texture;
    texture.nearest = true;
    Image<vec4> image(ivec2(2, 1), vec4(1));
    image.at(0, 0) = vec4(1, 0.5f, 0.25f, clear_alpha);
    texture.texels = shared_texels(std::move(image));
    return texture;
}

TEST(OccludersAlpha, MaskHolesArePassed) {
    Scene scene;
    Material material;
    material.alpha_mode = AlphaMode::mask;
    material.base_texture = 0;
    scene.materials = {material};
    scene.textures = {half_clear(0.4f)};
    add_mesh(scene, sheet(-1, 0));
    add_mesh(scene, quad(vec3(-1, -1, -2), vec3(2, 0, 0), vec3(0, 0.5f, 0)));
    expect_transmission(scene, -0.5f, 0.3f, 1);
    expect_transmission(scene, 0.5f, 0.3f, 0);
    expect_transmission(scene, -0.5f, -0.7f, 0);

    // The hole shows the wall behind; the solid half has the texture's color and is opaque.
    const auto occluders = Occluders::make(scene, 0, nullptr);
    const Ray rays[] = {{vec3(-0.5f, -0.7f, 0), vec3(0, 0, -1)}, {vec3(0.5f, -0.7f, 0), vec3(0, 0, -1)}};
    Hits hits;
    occluders->closest(rays, 0, hits);
    EXPECT_EQ(hits.instance[0], 1);
    EXPECT_EQ(hits.instance[1], 0);
    EXPECT_EQ(occluders->surface(rays[1], hits, 1).alpha, 1);
}

TEST(OccludersAlpha, BlendTexturesScaleLightAndAreHit) {
    Scene scene;
    Material material = blend_material(0.5f);
    material.base_texture = 0;
    material.base_color = vec3(0.5f);
    scene.materials = {material};
    scene.textures = {half_clear(0.25f)};
    add_mesh(scene, sheet(-1, 0));
    expect_transmission(scene, -0.5f, 0.3f, 0.875f);
    expect_transmission(scene, 0.5f, 0.3f, 0.5f);

    const auto occluders = Occluders::make(scene, 0, nullptr);
    const Ray ray{vec3(-0.5f, 0.3f, 0), vec3(0, 0, -1)};
    Hits hits;
    occluders->closest({&ray, 1}, 0, hits);
    ASSERT_EQ(hits.instance[0], 0);
    const SurfacePoint point = occluders->surface(ray, hits, 0);
    EXPECT_FLOAT_EQ(point.alpha, 0.125f);
    EXPECT_EQ(point.base_color, vec3(0.5f, 0.25f, 0.125f));
}

// A texture that could not be read leaves the material's own alpha.
TEST(OccludersAlpha, MissingTextureLeavesTheFactor) {
    Scene scene;
    Material material = blend_material(0.25f);
    material.base_texture = 0;
    scene.materials = {material};
    scene.textures = {Texture{}};
    add_mesh(scene, sheet(-1, 0));
    expect_transmission(scene, 0.3f, 0.1f, 0.75f);
}

TEST(OccludersAlpha, ManySheetsGoDark) {
    Scene scene;
    scene.materials = {blend_material(0.5f)};
    for (int i = 1; i <= 40; ++i) add_mesh(scene, sheet(-0.1f * static_cast<float>(i), 0));
    expect_transmission(scene, 0.3f, 0.1f, 0);
}
}
}
