// Pictures through a thin lens, of planes that glow.
#include "modes/mode.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/threads.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
View lens_view(ivec2 size, int samples, float radius, float focus) {
    View view = plain_view(size, samples);
    view.camera.lens = {radius, focus, 0, 0};
    return view;
}

Layers pictured(const View& view, const Scene& scene) {
    FrameStats stats;
    return render_frame(mode_of(prepare_nothing), view, snapshot_of(scene), Settings{}, FrameOptions{}, stats);
}

double sum_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& pixel : image.pixels) sum += double(pixel.y);
    return sum;
}

TEST(LensPictures, WhatIsInFocusKeepsItsEdges) {
    Scene scene;
    add_plane(scene, -4, 1.013f, vec3(2, 1, 0.5f));
    const Layers sharp = pictured(lens_view({64, 48}, 16, 0, 4), scene);
    const Layers lens = pictured(lens_view({64, 48}, 16, 0.3f, 4), scene);
    for (size_t i = 0; i < sharp.color.pixels.size(); ++i) {
        ASSERT_EQ(lens.color.pixels[i], sharp.color.pixels[i]) << i;
        ASSERT_EQ(lens.alpha.pixels[i], sharp.alpha.pixels[i]) << i;
    }
}

// A square of three pixels becomes a disc, but for its own size: with mean square distance d²/8 from its middle, and as
// much light.
TEST(LensPictures, APointBecomesADiscOfTheThinLensDiameter) {
    const ivec2 size(96, 72);
    for (const float depth : {1.5f, 12.0f}) {
        Scene scene;
        const float pixel = 2 * std::tan(0.4f) * depth / static_cast<float>(size.y), half = 1.5f * pixel;
        add_plane(scene, -depth, half, vec3(1000));
        const View view = lens_view(size, 1024, 0.3f, 3);
        const Layers blurred = pictured(view, scene);
        const double light = sum_of(blurred.color), expected = 1000 * 3 * 3;
        EXPECT_NEAR(light, expected, 0.02 * expected) << "some 9000 samples meet it";

        double squares = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vec2 off = vec2(x, y) + 0.5f - 0.5f * vec2(size);
                squares += double(glm::dot(off, off)) * double(blurred.color.at(x, y).y) / light;
            }
        const double own = 2 * (3 * 3 + 1) / 12.0; // of the square, and of pixels
        const double disc = static_cast<double>(blur_diameter(view.camera, size, depth));
        EXPECT_GT(disc, 10);
        EXPECT_NEAR(std::sqrt(8 * (squares - own)), disc, 0.02 * disc);
    }
}

// Light rises behind an edge as the share of a disc that lies on its side: from 1/4 to 3/4 over 0.404 d.
TEST(LensPictures, AnEdgeIsAsWideAsItsCircle) {
    const ivec2 size(96, 72);
    Scene scene;
    add_plane(scene, -10, 500, vec3(1));
    for (vec3& corner : scene.meshes[0].positions) corner.x = std::max(corner.x, 0.0f);
    const View view = lens_view(size, 256, 0.2f, 2);
    const Layers blurred = pictured(view, scene);
    const auto column = [&](int x) {
        double sum = 0;
        for (int y = 0; y < size.y; ++y) sum += double(blurred.color.at(x, y).y);
        return sum / size.y;
    };
    const auto place_of = [&](double value) {
        int x = 0;
        while (column(x + 1) < value) ++x;
        return x + (value - column(x)) / (column(x + 1) - column(x));
    };
    const double disc = static_cast<double>(blur_diameter(view.camera, size, 10));
    EXPECT_GT(disc, 10);
    EXPECT_NEAR(place_of(0.75) - place_of(0.25), 0.404 * disc, 0.02 * 0.404 * disc);
}

TEST(LensPictures, BitsDoNotDependOnThreads) {
    Scene scene;
    add_plane(scene, -4, 1, vec3(2, 1, 0.5f), 0.5f);
    add_plane(scene, -9, 3, vec3(1));
    const View view = lens_view({61, 43}, 4, 0.3f, 5);
    const Layers one = on_threads(1, [&] { return pictured(view, scene); });
    const Layers two = on_threads(2, [&] { return pictured(view, scene); });
    EXPECT_TRUE(same_bits(one.color, two.color));
    EXPECT_TRUE(same_bits(one.depth, two.depth));
    EXPECT_TRUE(same_bits(one.alpha, two.alpha));
}

TEST(LensPictures, DepthIsSharp) {
    Scene scene;
    add_plane(scene, -2, 0.3f, vec3(1), 0.5f);
    add_plane(scene, -4, 1, vec3(1));
    const Layers sharp = pictured(lens_view({48, 36}, 8, 0, 1), scene),
                 lens = pictured(lens_view({48, 36}, 8, 0.5f, 1), scene);
    int both = 0;
    for (size_t i = 0; i < sharp.depth.pixels.size(); ++i) both += sharp.depth.pixels[i] == lens.depth.pixels[i];
    EXPECT_GE(both, int(sharp.depth.pixels.size()) - 60) << "but where an edge crosses a pixel";
    for (const float depth : lens.depth.pixels)
        EXPECT_TRUE(depth == 4 || std::isinf(depth) || std::abs(depth - 4) < 1e-5f);
}

TEST(LensPictures, NoiseOfTheLensIsSeenAsNoise) {
    Scene scene;
    add_plane(scene, -8, 0.4f, vec3(1));
    View sharp = lens_view({48, 36}, 16, 0, 2), lens = lens_view({48, 36}, 16, 0.3f, 2);
    sharp.batches = lens.batches = 8;
    const auto noise = [&](const View& view) {
        double sum = 0;
        for (const vec3& variance : pictured(view, scene).variance.pixels) sum += double(variance.y);
        return sum;
    };
    EXPECT_GT(noise(lens), 3 * noise(sharp));
}
}
}
