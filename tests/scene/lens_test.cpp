// The thin lens against its closed forms, and what scene files say of it.
#include "scene/lens.h"

#include "base/random.h"
#include "scene/camera.h"
#include "support/expect.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"
#include "trace/moment.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
constexpr float radius = 0.05f, focus = 3;

Camera lens_camera() {
    Camera camera = look_at({1, 2, 3}, {2, 1, -4}, {0, 1, 0}, glm::radians(40.0f));
    camera.lens = {radius, focus, 0, 0};
    return camera;
}

std::vector<vec2> aperture_points(const Lens& lens) {
    std::vector<vec2> points;
    for (uint32_t i = 0; i < 4096; ++i) {
        const Sample2 u = sample2(i, 5);
        points.push_back(aperture_point(lens, {u.x, u.y}));
    }
    return points;
}

TEST(Lens, PointsFillTheApertureEvenly) {
    for (const int blades : {0, 3, 5, 6, 9}) {
        SCOPED_TRACE(blades);
        vec2 sum(0);
        double squares = 0;
        for (const vec2 point : aperture_points({radius, focus, blades, 0.3f})) {
            sum += point, squares += glm::dot(point, point);
            ASSERT_LE(glm::length(point), radius * 1.0001f);
        }
        // Polar moment over area: r²/2 of a disc, r² (2 + cos 2π/n) / 6 of a regular polygon.
        const double expected = blades ? (2 + std::cos(2 * double(pi) / blades)) / 6 : 0.5;
        EXPECT_NEAR(squares / 4096 / (radius * radius), expected, 0.005 * expected);
        EXPECT_LT(glm::length(sum) / 4096, 0.003f * radius);
    }
}

TEST(Lens, BladesPointWhereTheyAreTurned) {
    float highest = 0;
    for (const vec2 point : aperture_points({radius, focus, 3, pi / 2})) highest = std::max(highest, point.y);
    EXPECT_GT(highest, 0.98f * radius) << "a corner up";
    for (const vec2 point : aperture_points({radius, focus, 3, pi / 2})) EXPECT_GE(point.y, -0.501f * radius);
}

TEST(Lens, AllRaysOfAPointMeetInFocus) {
    Camera camera = lens_camera();
    camera.far = 40;
    const ivec2 size(320, 180);
    for (const vec2 pixel : {vec2(160, 90), vec2(0, 0), vec2(300, 20)}) {
        const Ray middle = camera_ray(camera, size, pixel);
        const vec3 meeting = middle.at(focus / glm::dot(middle.direction, camera.forward));
        for (const vec2 on : {vec2(0), vec2(radius, 0), vec2(-0.02f, 0.03f)}) {
            const Ray ray = lens_ray(camera, size, pixel, on);
            EXPECT_NEAR(planar_depth(camera, ray, 0), 0, 1e-6);
            EXPECT_NEAR(planar_depth(camera, ray, ray.t_max), 40, 1e-3) << "far is a plane";
            expect_near(ray.at(focus / glm::dot(ray.direction, camera.forward)), meeting, 1e-5f);
            EXPECT_NEAR(glm::distance(ray.origin, camera.position), glm::length(on), 1e-6);
        }
    }
}

// A photographer's numbers: with focal length F and magnification F / (focus - F) on a sensor of height h, the circle
// of confusion is aperture · |z - focus| / z · F / (focus - F). A sensor that stands F behind a pinhole stands
// F focus / (focus - F) behind the lens when it is focused, where the same field of view needs a higher one by that.
TEST(Lens, BlurIsTheCircleOfConfusion) {
    const Camera camera = lens_camera();
    const ivec2 size(320, 180);
    const double sensor = 0.024, distance = sensor / 2 / std::tan(double(camera.vertical_fov) / 2);
    for (const double z : {0.5, 1.0, 2.0, 3.0, 6.0, 50.0}) {
        const double confusion = 2 * double(radius) * std::abs(z - focus) / z * distance / focus; // on the sensor
        EXPECT_NEAR(blur_diameter(camera, size, static_cast<float>(z)), confusion / sensor * size.y, 1e-3) << z;

        // As far apart as rays through both rims meet the plane there.
        const Ray left = lens_ray(camera, size, {160, 90}, {-radius, 0});
        const Ray right = lens_ray(camera, size, {160, 90}, {radius, 0});
        const float t = static_cast<float>(z) / glm::dot(left.direction, camera.forward);
        EXPECT_NEAR(glm::distance(left.at(t), right.at(t)), 2 * lens_reach(camera.lens, static_cast<float>(z)), 1e-4);
    }
}

Camera camera_of(const TempFolder& folder, const std::string& fields, double seconds = 0) {
    const LoadResult answer = load(folder.put("scene.json", R"({"tyndall": 1, )" + fields + "}"));
    EXPECT_TRUE(answer.loaded) << answer.message;
    return camera_at(answer.scene, answer.scene.camera, seconds);
}

TEST(Lens, OfASceneFile) {
    const TempFolder folder;
    const std::string placed = R"("camera": {"position": [0, 0, 5], "target": [0, 0, 1])";
    EXPECT_FALSE(camera_of(folder, placed + "}").lens);
    const Lens plain = camera_of(folder, placed + R"(, "aperture_radius": 0.02})").lens;
    EXPECT_EQ(plain.radius, 0.02f);
    EXPECT_EQ(plain.focus, 4) << "at the target";

    const std::string keyed = placed + R"(, "aperture_radius": {"keys": [[0, 0.02], [1, 0.04]]},
        "focus_distance": {"keys": [[0, 1], [1, 3]]}, "aperture_blades": 6, "blade_rotation": 30})";
    const Lens middle = camera_of(folder, keyed, 0.5).lens;
    EXPECT_FLOAT_EQ(middle.radius, 0.03f);
    EXPECT_FLOAT_EQ(middle.focus, 2);
    EXPECT_EQ(middle.blades, 6);
    EXPECT_FLOAT_EQ(middle.rotation, pi / 6);
}

TEST(Lens, OnACameraOfTheGltf) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    gltf.members["cameras"] = R"([{"type":"perspective","perspective":{"yfov":0.5,"znear":0.2}}])";
    gltf.members["nodes"] = R"([{"mesh":0},{"name":"Shot","camera":0},{"name":"Wide","camera":0}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1,2]}])";
    folder.put("room.gltf", gltf.json());
    const std::string lens = R"({"name": "Wide", "aperture_radius": 0.02, "focus_distance": 7})";
    for (const std::string& fields : {R"("camera": )" + lens, R"("camera": "Wide", "cameras": [)" + lens + "]"}) {
        const Camera camera = camera_of(folder, R"("gltf": "room.gltf", )" + fields);
        EXPECT_EQ(camera.name, "Wide");
        EXPECT_EQ(camera.vertical_fov, 0.5f);
        EXPECT_EQ(camera.lens.radius, 0.02f);
        EXPECT_EQ(camera.lens.focus, 7);
    }
    EXPECT_FALSE(camera_of(folder, R"("gltf": "room.gltf", "cameras": [)" + lens + "]").lens) << "Shot is the default";
    const LoadResult answer = load(folder.put(
        "scene.json", R"({"tyndall": 1, "gltf": "room.gltf", "camera": {"name": "Shot", "aperture_radius": 1}})"));
    EXPECT_FALSE(answer.loaded);
    EXPECT_NE(answer.message.find("focus_distance"), std::string::npos) << answer.message;
}
}
}
