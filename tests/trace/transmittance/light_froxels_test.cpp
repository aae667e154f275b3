// Optical depth to a light from froxels, against the exact march.
#include "scene/light.h"
#include "support/random_points.h"
#include "support/threads.h"
#include "trace/transmittance/depths_at.h"
#include "trace/transmittance/light_froxels.h"

#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/fog_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

// Noise of 30×20×17 voxels of a meter, seen from the side.
struct Stage {
    Snapshot snapshot;
    View view;

    Stage() {
        snapshot.media = {medium_of(volume_of(ivec3(0), ivec3(30, 20, 17), exact_noise), 0.05f)};
        snapshot.bounds = snapshot.media[0].world_bounds;
        view.camera = look_at(vec3(15, 14, 50), vec3(15, 10, 8), vec3(0, 1, 0), 0.8f);
        view.size = {64, 36};
    }
};

std::vector<Light> lights() {
    Light sun;
    sun.kind = LightKind::sun, sun.direction = glm::normalize(vec3(0.3f, -1, 0.2f));
    Light lamp;
    lamp.position = vec3(9, 8, 7), lamp.radius = 0.5f;
    return {sun, lamp};
}

// Points of the fog that the view sees.
std::vector<vec3> seen_points(const Stage& stage, uint32_t count) {
    std::vector<vec3> points;
    for (uint32_t i = 0; points.size() < count; ++i) {
        const vec3 point = random_point(i, 1, stage.snapshot.bounds);
        const auto pixel = pixel_of(stage.view.camera, stage.view.size, point);
        if (pixel && pixel->x >= 0 && pixel->y >= 0 && pixel->x <= 64 && pixel->y <= 36) points.push_back(point);
    }
    return points;
}

double rms_error(const Stage& stage, const Light& light, LightTransmittance method, int resolution) {
    const std::vector<vec3> points = seen_points(stage, 512);
    const auto found = depths_at(make_light_depth(stage.snapshot, light, method, resolution, &stage.view), points);
    const auto exact =
        depths_at(make_light_depth(stage.snapshot, light, LightTransmittance::marched, resolution), points);
    double squares = 0;
    for (size_t i = 0; i < points.size(); ++i) squares += std::pow(double(found[i]) - exact[i], 2);
    return std::sqrt(squares / static_cast<double>(points.size()));
}

TEST(LightFroxels, CornersAreExactUpToTheirQuadrature) {
    // Midpoints 1.5 voxels apart of a density that is linear within each voxel.
    Stage stage;
    for (const float ortho : {0.0f, 20.0f}) {
        stage.view.camera.ortho_height = ortho;
        for (const Light& light : lights()) {
            const LightDepth depth =
                make_light_depth(stage.snapshot, light, LightTransmittance::froxel, 16, &stage.view);
            const LightDepthFroxels& f = depth.froxels;
            ASSERT_EQ(f.size.z, 17);
            for (const ivec3 at : {ivec3(3, 5, 2), ivec3(9, 6, 8), ivec3(12, 2, 16), ivec3(5, 9, 0)}) {
                const float z = f.planar_depth(at.z);
                const vec2 across = (vec2(at) - f.offset) / f.scale * (ortho > 0 ? 1.0f : z);
                const Camera& camera = stage.view.camera;
                const vec3 point =
                    camera.position + z * camera.forward + across.x * camera.right + across.y * camera.up;
                const float found = (*f.depth)[static_cast<size_t>((at.z * f.size.y + at.y) * f.size.x + at.x)];
                EXPECT_NEAR(depths_at(depth, {point})[0], found, 1e-3f + 1e-3f * found);
                const LightDepth exact = make_light_depth(stage.snapshot, light, LightTransmittance::marched, 1);
                EXPECT_NEAR(found, depths_at(exact, {point})[0], 0.03f);
            }
        }
    }
}

TEST(LightFroxels, ComeCloserAsCellsShrink) {
    // Trilinear look-ups: an error of second order until cells meet the voxels. Within a factor of two of the light's
    // own grid at the same setting.
    Stage stage;
    for (const float ortho : {0.0f, 20.0f}) {
        stage.view.camera.ortho_height = ortho;
        for (const Light& light : lights()) {
            const double coarse = rms_error(stage, light, LightTransmittance::froxel, 16);
            const double fine = rms_error(stage, light, LightTransmittance::froxel, 64);
            EXPECT_LT(fine, 0.35 * coarse) << ortho;
            EXPECT_LT(fine, 2 * rms_error(stage, light, LightTransmittance::grid, 64) + 1e-3) << ortho;
        }
    }
}

TEST(LightFroxels, OutsideTheFogIsMarched) {
    const Stage stage;
    const std::vector<vec3> outside{{15, 14, 60}, {80, 3, 8}, {15, -40, 8}, {15, 10, -30}, {-20, 10, 25}};
    for (const Light& light : lights()) {
        const auto found =
            depths_at(make_light_depth(stage.snapshot, light, LightTransmittance::froxel, 16, &stage.view), outside);
        const auto exact = depths_at(make_light_depth(stage.snapshot, light, LightTransmittance::marched, 16), outside);
        for (size_t i = 0; i < outside.size(); ++i) EXPECT_EQ(found[i], exact[i]) << i;
    }
}

TEST(LightFroxels, FitTheFogHoweverLargeTheScene) {
    Stage stage;
    const auto froxels = [&] {
        return make_light_depth(stage.snapshot, lights()[0], LightTransmittance::froxel, 16, &stage.view).froxels;
    };
    const LightDepthFroxels close = froxels();
    stage.snapshot.bounds = {vec3(-2000), vec3(2000)};
    EXPECT_EQ(froxels().near, close.near);
    EXPECT_EQ(froxels().far, close.far);
}

TEST(LightFroxels, WithoutAViewThereIsAGrid) {
    const Stage stage;
    const LightDepth depth = make_light_depth(stage.snapshot, lights()[0], LightTransmittance::froxel, 16);
    EXPECT_EQ(depth.method, LightTransmittance::grid);
    EXPECT_FALSE(depth.grid.empty());
    EXPECT_TRUE(depth.marched.empty());
}

TEST(LightFroxels, FogOutOfViewIsMarched) {
    Stage stage;
    stage.view.camera = look_at(vec3(15, 14, 50), vec3(15, 10, 90), vec3(0, 1, 0), 0.8f);
    const LightDepth depth = make_light_depth(stage.snapshot, lights()[0], LightTransmittance::froxel, 16, &stage.view);
    EXPECT_TRUE(depth.froxels.empty());
    const LightDepth exact = make_light_depth(stage.snapshot, lights()[0], LightTransmittance::marched, 16);
    EXPECT_EQ(depths_at(depth, {vec3(15, 3, 8)})[0], depths_at(exact, {vec3(15, 3, 8)})[0]);
}

TEST(LightFroxels, ThreadsDoNotChangeThem) {
    const Stage stage;
    for (const Light& light : lights()) {
        const auto made = [&] {
            return make_light_depth(stage.snapshot, light, LightTransmittance::froxel, 24, &stage.view);
        };
        const LightDepth one = on_threads(1, made), many = on_threads(3, made);
        EXPECT_EQ(*one.froxels.depth, *many.froxels.depth);
    }
}
}
}
