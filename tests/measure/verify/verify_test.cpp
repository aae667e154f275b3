// The tools of the proof: they must notice what is wrong and let pass what is right.
#include "measure/metrics/tile_scores.h"
#include "measure/verify/scaled_scene.h"
#include "measure/verify/verify.h"

#include "base/random.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Twelve uniform numbers less 6: mean 0, variance 1, nearly normal.
float normal(uint32_t pixel, uint32_t seed) {
    float sum = -6;
    for (uint32_t i = 0; i < 12; ++i) sum += random_unit(pixel, i, 0, seed);
    return sum;
}

struct NoisyPicture {
    Image<vec3> noisy, variance, reference;
};
// A gradient with gray noise of 5 % per pixel, times `gain`.
NoisyPicture noisy_picture(float gain, float said_variance = 1) {
    const ivec2 size(640, 320);
    NoisyPicture p{Image<vec3>(size), Image<vec3>(size), Image<vec3>(size)};
    for (uint32_t i = 0; i < p.noisy.pixels.size(); ++i) {
        const float value = 0.2f + static_cast<float>(i % 640) / 640, sigma = 0.05f * value;
        p.reference.pixels[i] = vec3(value);
        p.noisy.pixels[i] = vec3(gain * value + sigma * normal(i, 5));
        p.variance.pixels[i] = vec3(said_variance * sigma * sigma);
    }
    return p;
}

TEST(TileScores, AreStandardForAnUnbiasedPicture) {
    const NoisyPicture p = noisy_picture(1);
    const TileScores scores = tile_scores(p.noisy, p.variance, p.reference);
    ASSERT_EQ(scores.scores, 3 * 80 * 40);
    EXPECT_EQ(scores.dark, 0);
    EXPECT_NEAR(scores.mean, 0, 4.5 / std::sqrt(3200));
    EXPECT_NEAR(scores.deviation, 1, 4.5 / std::sqrt(6400));
    EXPECT_NEAR(scores.within_3, 0.9973, 4.5 * std::sqrt(0.0027 / 3200));
    EXPECT_EQ(scores.precise, 1); // 5 % over 64 pixels: 0.6 %
}

TEST(TileScores, NoticeABiasOfThreePerMille) {
    // A tile is known to 0.6 %, so 0.3 % are half a standard error in every tile.
    const NoisyPicture p = noisy_picture(1.003f);
    EXPECT_NEAR(tile_scores(p.noisy, p.variance, p.reference).mean, 0.48, 4.5 / std::sqrt(3200));
}

TEST(TileScores, NoticeAVarianceThatIsNotTrue) {
    const NoisyPicture p = noisy_picture(1, 0.25f);
    EXPECT_NEAR(tile_scores(p.noisy, p.variance, p.reference).deviation, 2, 0.12);
}

TEST(TileScores, LeaveOutWhatIsDark) {
    NoisyPicture p = noisy_picture(1);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) p.reference.at(x, y) = vec3(0);
    const TileScores scores = tile_scores(p.noisy, p.variance, p.reference);
    EXPECT_EQ(scores.scores, 3 * (80 * 40 - 2));
    EXPECT_GT(scores.dark, 100); // 0.2 where there should be nothing, known to 5 %
    const Image<vec3> black(ivec2(16), vec3(0));
    EXPECT_EQ(tile_scores(black, black, black).scores, 0);
}

TEST(ScaledScene, ScalesEveryLengthAndWhatIsPerLength) {
    Scene scene;
    Node node;
    node.translation = vec3(1, 2, 3);
    node.matrix = glm::translate(mat4(1), vec3(4, 5, 6));
    scene.nodes = {node};
    Mesh mesh;
    mesh.positions = {{1, 0, 0}};
    scene.meshes = {mesh};
    LightSource point, sun, screen, panel;
    point.position = vec3(1, 1, 1), point.intensity = 3.0f, point.radius = 0.1f, point.range = 5;
    sun.kind = LightKind::sun, sun.intensity = 7.0f;
    screen.kind = panel.kind = LightKind::rectangle, screen.width = 2.0f, screen.height = 3.0f;
    screen.intensity = panel.intensity = 5.0f, panel.unit = LightUnit::lumen;
    scene.lights = {point, sun, screen, panel};
    MediumSource fog;
    fog.extinction = 0.5f, fog.emission = vec3(2), fog.height_base = 1.0f, fog.height_falloff = 2.0f;
    scene.media = {fog};
    CameraSource camera;
    camera.position = vec3(1, 0, 0), camera.near = 0.1f, camera.far = 10;
    scene.cameras = {camera};

    const Scene large = scaled(scene, 4);
    EXPECT_EQ(large.nodes[0].translation.at(0), vec3(4, 8, 12));
    EXPECT_EQ(*large.nodes[0].matrix, glm::translate(mat4(1), vec3(16, 20, 24)));
    EXPECT_EQ(large.meshes[0].positions[0], vec3(4, 0, 0));
    EXPECT_EQ(large.lights[0].position.at(0), vec3(4));
    EXPECT_EQ(large.lights[0].intensity.at(0), 48);
    EXPECT_EQ(large.lights[0].radius.at(0), 0.4f);
    EXPECT_EQ(large.lights[0].range.at(0), 20);
    EXPECT_EQ(large.lights[1].intensity.at(0), 7);
    EXPECT_EQ(large.lights[2].width.at(0), 8);
    EXPECT_EQ(large.lights[2].height.at(0), 12);
    EXPECT_EQ(large.lights[2].intensity.at(0), 5) << "nits";
    EXPECT_EQ(large.lights[3].intensity.at(0), 80) << "lumens";
    EXPECT_EQ(large.media[0].extinction.at(0), 0.125f);
    EXPECT_EQ(large.media[0].emission.at(0), vec3(0.5f));
    EXPECT_EQ(large.media[0].scale.at(0), vec3(4));
    EXPECT_EQ(large.media[0].height_base.at(0), 4);
    EXPECT_EQ(large.media[0].height_falloff.at(0), 8);
    EXPECT_EQ(large.cameras[0].position.at(0), vec3(4, 0, 0));
    EXPECT_EQ(large.cameras[0].near, 0.4f);
    EXPECT_EQ(large.cameras[0].far, 40);
}

TEST(Verify, ACheckHoldsWithinItsTolerance) {
    Check check{"topic", "name", 1.01, 1, 0.011, "1 %"};
    EXPECT_TRUE(check.holds());
    check.measured = 1.02;
    EXPECT_FALSE(check.holds());
    check.measured = std::nan("");
    EXPECT_FALSE(check.holds());
}

TEST(Verify, NightlyTheProgramHolds) {
    const std::vector<Check> checks = verify_program({});
    EXPECT_GE(checks.size(), 50u);
    for (const Check& check : checks)
        EXPECT_TRUE(check.holds()) << check.topic << ": " << check.name << " is " << check.measured;
}
}
}
