#include "scene/camera.h"
#include "support/expect.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
void expect_frame(const Camera& camera) {
    const mat3 frame(camera.right, camera.up, -camera.forward);
    const mat3 product = glm::transpose(frame) * frame;
    for (int i = 0; i < 3; ++i) expect_near(product[i], mat3(1)[i]);
    EXPECT_NEAR(glm::determinant(frame), 1, 1e-6) << "right, up and backward form a right-handed frame";
}

TEST(Camera, LookAtIsOrthonormalAndLooksAtItsTarget) {
    for (const vec3 target : {vec3(5, 1, -3), vec3(0, 9, 0), vec3(0, -9, 0), vec3(1e-4f, -1, 0), vec3(-4, 2, 8)}) {
        const Camera camera = look_at(vec3(0), target, vec3(0, 1, 0), 1);
        expect_frame(camera);
        expect_near(camera.forward, glm::normalize(target));
        EXPECT_GE(camera.up.y, -1e-6f) << "the picture's up does not point down";
    }
}

TEST(Camera, DegenerateAimsStillGiveAFrame) {
    expect_frame(look_at(vec3(1), vec3(1), vec3(0, 1, 0), 1));
    expect_frame(look_at(vec3(0), vec3(0, 0, -1), vec3(0), 1));
}

TEST(Camera, CenterAndEdges) {
    const float fov = glm::radians(60.0f);
    const Camera camera = look_at(vec3(1, 2, 3), vec3(1, 2, -7), vec3(0, 1, 0), fov);
    const ivec2 size(200, 100);
    const Ray center = camera_ray(camera, size, {100, 50});
    expect_near(center.direction, vec3(0, 0, -1));
    expect_near(center.origin, vec3(1, 2, 3));

    const float tangent = std::tan(fov / 2);
    const vec3 upper = camera_ray(camera, size, {100, 0}).direction,
               right = camera_ray(camera, size, {200, 50}).direction;
    EXPECT_NEAR(upper.y / -upper.z, tangent, 1e-6) << "half the field of view to the upper edge";
    EXPECT_NEAR(right.x / -right.z, 2 * tangent, 1e-6) << "times the aspect to the right edge";
    const vec3 corner = camera_ray(camera, size, {0, 100}).direction;
    EXPECT_NEAR(corner.x / -corner.z, -2 * tangent, 1e-5);
    EXPECT_NEAR(corner.y / -corner.z, -tangent, 1e-6);
    EXPECT_NEAR(glm::length(corner), 1, 1e-6);
}

TEST(Camera, FarIsAPlane) {
    Camera camera = look_at(vec3(0), vec3(0, 0, -1), vec3(0, 1, 0), 1.2f);
    camera.far = 25;
    for (const vec2 pixel : {vec2(0, 0), vec2(160, 90), vec2(320, 0), vec2(17, 133)}) {
        const Ray ray = camera_ray(camera, {320, 180}, pixel);
        EXPECT_NEAR(planar_depth(camera, ray, ray.t_max), 25, 1e-4);
    }
}

TEST(Camera, OrthographicRaysAreParallel) {
    Camera camera = look_at(vec3(0, 0, 5), vec3(0), vec3(0, 1, 0), 1);
    camera.ortho_height = 4;
    camera.far = 100;
    const Ray corner = camera_ray(camera, {300, 100}, {0, 0});
    expect_near(corner.direction, vec3(0, 0, -1));
    expect_near(corner.origin, vec3(-6, 2, 5), 1e-5f);
    EXPECT_EQ(corner.t_max, 100);
    EXPECT_EQ(camera_ray(camera, {300, 100}, {150, 50}).origin, vec3(0, 0, 5));
}
}
}
