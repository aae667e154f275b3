#include "base/parallel.h"
#include "modes/froxel/settings.h"
#include "modes/mode.h"
#include "render/adaptive/candidates.h"
#include "render/frame/frame.h"
#include "scene/light.h"
#include "viewer/painting/painting.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Request error_request(const char* mode) {
    flush_denormals();
    Request request = request_for(small_scene(), mode);
    request.max_samples = request.settings.pixel.samples;
    request.shown.layer = ShownLayer::error;
    return request;
}

ShownPicture last_picture(Painter& painter, const Request& request) {
    ShownPicture last;
    for (int i = 0; i < 50; ++i) {
        std::optional<ShownPicture> picture = paint(painter, request, never);
        if (!picture) return last;
        EXPECT_EQ(picture->error, "");
        last = std::move(*picture);
    }
    ADD_FAILURE() << "there is no end";
    return last;
}

// What tyndall render makes of the request.
Layers rendered(const Request& request, const Settings& settings) {
    const Snapshot snapshot = make_snapshot(*request.scene, moment_of(*request.scene, request.frame));
    FrameStats stats;
    return render_frame(find_mode(request.mode), view_of(request), snapshot, settings, {}, stats);
}

// Samples of the march of quality final, and what one sample at the pixels' middles says of the exact march.
Layers exact_march(Request request) {
    request.mode = "march";
    Request one = request;
    one.settings.pixel.samples = 1;
    Layers layers = rendered(request, final_march(request.settings));
    const Layers exact = rendered(one, truth_settings(one.settings)), coarse = rendered(one, final_march(one.settings));
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        layers.color.pixels[i] += exact.color.pixels[i] - coarse.color.pixels[i];
        layers.inscatter.pixels[i] += exact.inscatter.pixels[i] - coarse.inscatter.pixels[i];
    }
    return layers;
}

Layers even(ivec2 size, float color, float fog) {
    Layers layers;
    layers.size = size;
    layers.color = Image<vec3>(size, vec3(color)), layers.inscatter = Image<vec3>(size, vec3(fog));
    return layers;
}
}

TEST(ReferencePicture, IsTheExactMarchOfTheSameView) {
    Painter painter;
    Request request = error_request("cone");
    request.shown.layer = ShownLayer::picture, request.beside = "reference", request.shown.side_by_side = true;
    const ShownPicture picture = last_picture(painter, request);
    EXPECT_EQ(picture.beside, "reference");
    EXPECT_TRUE(picture.finished);
    ASSERT_EQ(picture.across, 2);
    ASSERT_EQ(picture.codes.size, ivec2(2 * request.size.x, request.size.y));
    const auto left = tone_map(rendered(request, request.settings), request.shown);
    const auto right = tone_map(exact_march(request), request.shown);
    ASSERT_NE(left.pixels, right.pixels);
    for (int y = 0; y < request.size.y; ++y)
        for (int x = 0; x < request.size.x; ++x) {
            ASSERT_EQ(picture.codes.at(x, y), left.at(x, y));
            ASSERT_EQ(picture.codes.at(request.size.x + x, y), right.at(x, y));
        }
}

TEST(ReferencePicture, FiguresAreThoseOfComparingTwoRenders) {
    Painter painter;
    const Request request = error_request("cone");
    const ShownPicture picture = last_picture(painter, request);
    const Layers test = rendered(request, request.settings), truth = exact_march(request);
    const Errors color = measure_errors(test.color, truth.color), fog = measure_errors(test.inscatter, truth.inscatter);
    ASSERT_TRUE(picture.errors);
    EXPECT_EQ(picture.errors->picture, color.rmse / color.mean_reference);
    EXPECT_EQ(picture.errors->fog, fog.rmse / fog.mean_reference);
    EXPECT_EQ(picture.errors->worst, std::max(picture.errors->picture, picture.errors->fog));
    EXPECT_GT(picture.errors->worst, 0);
    EXPECT_EQ(picture.errors->bias, color.bias / color.mean_reference);
    ASSERT_TRUE(picture.reference);
    EXPECT_EQ(picture.reference->samples, request.max_samples);
    EXPECT_LT(picture.reference->noise, 0) << "one round tells nothing of the noise";
    EXPECT_EQ(picture.codes.pixels, error_codes(test, truth).pixels);
}

TEST(ReferencePicture, AMarchOfFinalQualityIsOffByTheStepToTheExactOne) {
    Painter painter;
    Request request = error_request("march");
    request.settings = settings_for(Quality::final);
    request.settings.pixel.samples = 2, request.max_samples = 7; // over several rounds
    std::optional<ErrorFigures> before;
    ShownPicture picture;
    while (auto next = paint(painter, request, never)) {
        picture = *next;
        if (picture.reference && picture.reference->change < 0 && picture.samples == picture.reference->samples)
            before = picture.errors;
    }
    ASSERT_TRUE(before && picture.errors);
    EXPECT_EQ(picture.samples, 7);
    EXPECT_EQ(before->worst, 0) << "the same samples of the same march";
    EXPECT_NEAR(picture.errors->worst, picture.reference->change, 0.02 * picture.reference->change + 1e-6);
    EXPECT_LT(picture.reference->change, 0.02);
    EXPECT_GT(picture.reference->noise, 0);
}

TEST(ReferencePicture, StaysWhileTheTechniqueChangesAndBeginsAnewWithTheCamera) {
    Painter painter;
    Request request = error_request("cone");
    last_picture(painter, request);
    ++request.revision, request.mode = "shadow-map", request.settings.of<FroxelSettings>().depth_slices = 16;
    const auto first = paint(painter, request, never);
    ASSERT_TRUE(first && first->reference);
    EXPECT_TRUE(first->reference->finished);
    EXPECT_FALSE(first->finished);
    ++request.revision, request.camera = camera_at(*request.scene, 1, 0);
    const auto moved = paint(painter, request, never);
    ASSERT_TRUE(moved);
    EXPECT_FALSE(moved->reference) << "that of another view";
    EXPECT_TRUE(last_picture(painter, request).reference->finished);
    ++request.revision, request.settings.terms.phase = false; // another light, another truth
    EXPECT_FALSE(paint(painter, request, never)->reference);
}

TEST(ReferencePicture, IsNotMadeUnlessItIsShown) {
    Painter painter;
    Request request = error_request("cone");
    request.shown.layer = ShownLayer::picture;
    EXPECT_FALSE(last_picture(painter, request).reference);
    EXPECT_EQ(painter.reference.rounds.rounds, 0);
    ++request.shown_revision, request.shown.layer = ShownLayer::error;
    const auto again = paint(painter, request, never);
    ASSERT_TRUE(again);
    EXPECT_FALSE(again->finished);
    EXPECT_TRUE(last_picture(painter, request).errors);
}

TEST(ReferencePicture, BothTechniquesAreHeldAgainstIt) {
    Painter painter;
    Request request = error_request("cone");
    request.beside = "march";
    const ShownPicture picture = last_picture(painter, request);
    ASSERT_TRUE(picture.errors && picture.errors_beside);
    EXPECT_NE(picture.errors->worst, picture.errors_beside->worst);
    EXPECT_NE(error_text(*picture.errors).find("rmse_rel"), std::string::npos);
}

TEST(ReferencePicture, NoiseIsTheStandardErrorOfTheMeanOfBothHalves) {
    // Halves of 3 and 1 samples, 0.4 apart: 0.16 = v (1/3 + 1), so v = 0.12; of 4 samples √(v/4), of a mean of 2.
    ReferencePicture reference;
    Rounds& rounds = reference.rounds;
    rounds.samples = 4, rounds.layers = even({4, 4}, 2, 2), rounds.half_samples = {3, 1};
    for (size_t i = 0; i < 2; ++i) {
        const Layers half = even({4, 4}, i ? 9.0f : 1.0f, i ? 2.4f : 2.0f);
        rounds.halves[i] = {half.color, half.inscatter};
    }
    EXPECT_NEAR(facts_of(reference, error_request("cone")).noise, std::sqrt(0.03) / 2, 1e-7);

    // A picture that is twice as bright, noise and all, differs by just that noise; one that is the same, by none.
    Rounds picture = rounds;
    EXPECT_EQ(error_figures(picture, reference).noise, 0);
    picture.layers = even({4, 4}, 4, 4);
    for (ColorLayers& half : picture.halves) {
        for (vec3& color : half.color.pixels) color = vec3(0);
        for (vec3& fog : half.inscatter.pixels) fog *= 2;
    }
    // Of color the halves are 8 apart: 64 = v 4/3, √(48/4) of 2, which is more.
    EXPECT_NEAR(error_figures(picture, reference).noise, std::sqrt(12.0) / 2, 1e-6);
}

TEST(ReferencePicture, ColorsRiseWithTheErrorInPowersOfTen) {
    const Layers truth = even({1, 1}, 1, 1);
    const auto color = [&](float value) { return error_codes(even({1, 1}, value, 1), truth).at(0, 0); };
    EXPECT_EQ(color(1), glm::u8vec4(0, 0, 0, 255));
    EXPECT_EQ(color(2.5f), glm::u8vec4(255, 255, 255, 255));
    EXPECT_EQ(glm::u8vec3(color(1.5f)), heat_color(1 + std::log10(0.5) / 3)); // 50 %: on a scale from 0.1 to 100 %
    EXPECT_EQ(color(std::numeric_limits<float>::quiet_NaN()), glm::u8vec4(0, 255, 0, 255));
}
}
