// A lamp that passes at a constant speed while the shutter is open: its closed form on a wall, its integral in fog.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "render/sequence/job.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tyndall::test {
namespace {
// From x = -0.4 to 0.4 m at 0.5 m before a wall at z = -2, seen by an orthographic camera 2 m high and wide.
constexpr double way = 0.8, height = 0.5, candela = 3, extinction = 0.3;
constexpr int side = 8;

Scene passing_lamp() {
    Scene scene;
    scene.frame_rate = 1, scene.resolution = {side, side};
    add_plane(scene, -2, 9, vec3(0));
    scene.materials[0].base_color = vec3(1);
    CameraSource camera;
    camera.name = "camera", camera.ortho_height = 2, camera.shutter = {0, 1, {}};
    camera.position = vec3(0), camera.target = vec3(0, 0, -1);
    scene.cameras.push_back(camera);
    LightSource lamp;
    lamp.name = "lamp", lamp.intensity = float(candela);
    lamp.position.times = {0, 1}, lamp.position.values = {vec3(-way / 2, 0, height - 2), vec3(way / 2, 0, height - 2)};
    scene.lights.push_back(lamp);
    return scene;
}

Layers rendered(const Scene& scene, const char* mode, int samples, std::vector<std::string> layers = {}) {
    RenderRequest request;
    request.settings = settings_for(Quality::final);
    request.settings.pixel.filter = PixelFilter::center, request.settings.pixel.samples = samples;
    request.settings.path.orders = request.settings.fluence.orders = 1;
    request.time_samples = 64;
    request.exr.layers = std::move(layers);
    FrameStats stats;
    Layers picture = render_frame(find_mode(mode), view_of(scene, request, request.settings, 0),
                                  make_snapshot(scene, moments_of(scene, request, 0)), request.settings, {}, stats);
    EXPECT_EQ(stats.moments, 64);
    return picture;
}

glm::dvec2 place_of(int x, int y) { return 2.0 / side * (glm::dvec2(x, y) + 0.5) - 1.0; }

// The mean of I h / (a² + (x - s)²)^(3/2) over the way s, with a² = h² + y², is its antiderivative at the ends.
double on_wall(glm::dvec2 at) {
    const double square = height * height + at.y * at.y;
    const auto antiderivative = [&](double s) { return s / (square * std::sqrt(square + s * s)); };
    const double mean = (antiderivative(way / 2 - at.x) - antiderivative(-way / 2 - at.x)) / way;
    return std::numbers::inv_pi * candela * height * mean;
}

// 64 moments that are Δ apart differ from it by (Δ / h)² / 8 or 8e-5 at most.
TEST(MovingLamp, LightsAWallAsItsClosedForm) {
    const Scene scene = passing_lamp();
    for (const char* mode : {"march", "path"}) {
        const Layers layers = rendered(scene, mode, 64);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                EXPECT_NEAR(layers.color.at(x, y).x / on_wall(place_of(x, y)), 1, 2e-4) << mode << " " << x << " " << y;
    }
}

// Scattered once by even fog 1 m deep before the wall: a mean over the way of integrals along the ray.
double in_fog(glm::dvec2 at) {
    constexpr int moments = 200, steps = 400;
    double sum = 0;
    for (int i = 0; i < moments; ++i)
        for (int k = 0; k < steps; ++k) {
            const double across = at.x - way * ((i + 0.5) / moments - 0.5), depth = (k + 0.5) / steps;
            const double distance = glm::length(dvec3(across, at.y, 1 - depth - height));
            sum += std::exp(-extinction * (depth + distance)) / (distance * distance);
        }
    return candela * extinction / (4 * std::numbers::pi) * sum / moments / steps;
}

// Moments Δ apart differ from their integral by (Δ / d)² / 12 at a ray d from the lamp: at most 1e-3. Paths by chance.
TEST(MovingLamp, LightsFogAsItsIntegral) {
    Scene scene = passing_lamp();
    MediumSource fog;
    fog.extinction = static_cast<float>(extinction), fog.albedo = vec3(1);
    fog.bounds = {vec3(-9, -9, -3), vec3(9, 9, -1)};
    scene.media.push_back(fog);
    const Layers marched = rendered(scene, "march", 64), traced = rendered(scene, "path", 1024, {"variance"});
    double expected = 0, sum = 0, variance = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double light = in_fog(place_of(x, y));
            EXPECT_NEAR(marched.inscatter.at(x, y).x / light, 1, 1e-3) << x << " " << y;
            expected += light, sum += double{traced.inscatter.at(x, y).x};
            variance += double{traced.inscatter_variance.at(x, y).x};
        }
    EXPECT_NEAR(sum, expected, 4.5 * std::sqrt(variance));
    EXPECT_LT(4.5 * std::sqrt(variance), 0.005 * expected);
}
}
}
