// Pictures whose samples go on where an earlier one's ended: together they are one of all samples.
#include "modes/mode.h"
#include "render/adaptive/target_rounds.h"
#include "render/frame/noise_fixtures.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
constexpr ivec2 size(16, 8);

std::shared_ptr<const TileFactors> tiles_of(std::vector<uint16_t> values) {
    auto tiles = std::make_shared<TileFactors>();
    tiles->factors = Image<uint16_t>(size / 4);
    tiles->factors.pixels = std::move(values);
    return tiles;
}

// So many samples of each of two batches of a tile's pixels, after those there are.
View part_view(std::vector<uint16_t> before, std::vector<uint16_t> added, uint32_t seed) {
    View view = batched_view(size, 2, 2);
    view.seed = seed, view.before = tiles_of(std::move(before)), view.allotted = tiles_of(std::move(added));
    return view;
}

// Samples of a batch, by tile.
using Counts = std::vector<uint16_t>;
const Counts none(8, 0);
const Counts some = {3, 1, 5, 16, 2, 7, 8, 4};
const Counts rest = {5, 15, 11, 0, 6, 9, 24, 4};
const Counts all = {8, 16, 16, 16, 8, 16, 32, 8};

Layers in_two_parts(const Mode& mode, const Snapshot& snapshot, uint32_t seed, uint32_t second_seed) {
    Layers layers = rendered(mode, part_view(none, some, seed), snapshot);
    TileShares shares{{}, Image<float>(size / 4)};
    for (size_t i = 0; i < all.size(); ++i)
        shares.shares.pixels[i] = static_cast<float>(rest[i]) / static_cast<float>(all[i]);
    blend_layers(layers, rendered(mode, part_view(some, rest, second_seed), snapshot), shares);
    return layers;
}

double mean_square_of(const Image<vec3>& image, float mean) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += (value.x - mean) * (value.x - mean);
    return sum / static_cast<double>(image.pixels.size());
}
}

TEST(GoingOn, TakesThePlacesThatTheEarlierPictureLeft) {
    const View first = part_view(none, some, 7), second = part_view(some, rest, 7), whole = part_view(none, all, 7);
    for (const ivec2 pixel : {ivec2(1, 2), ivec2(5, 3), ivec2(13, 1), ivec2(9, 6)}) {
        std::set<std::pair<uint32_t, uint32_t>> parts, together;
        for (const View* view : {&first, &second})
            for (int sample = 0; sample < samples_of(*view, pixel); ++sample) {
                const SampleIndex point = sample_index(*view, pixel, sample);
                EXPECT_TRUE(parts.insert({point.sequence, point.index}).second) << "taken twice";
            }
        for (int sample = 0; sample < samples_of(whole, pixel); ++sample) {
            const SampleIndex point = sample_index(whole, pixel, sample);
            together.insert({point.sequence, point.index});
        }
        EXPECT_EQ(parts, together) << pixel.x << " " << pixel.y;
    }
}

TEST(GoingOn, TwoPartsAreThePictureOfAllSamples) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    for (const auto prepare : {prepare_random, prepare_place}) {
        const Mode mode = own_mode(prepare);
        const Layers whole = rendered(mode, part_view(none, all, 7), snapshot);
        const Layers parts = in_two_parts(mode, snapshot, 7, 7);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                ASSERT_NEAR(parts.color.at(x, y).x, whole.color.at(x, y).x, 2e-7);
                ASSERT_NEAR(parts.inscatter.at(x, y).x, whole.inscatter.at(x, y).x, 2e-7);
                const float variance = whole.variance.at(x, y).x, spread = std::sqrt(variance);
                ASSERT_NEAR(parts.variance.at(x, y).x, variance, 4e-7 * spread + 1e-13) << x << " " << y;
                ASSERT_NEAR(parts.inscatter_variance.at(x, y).x, whole.inscatter_variance.at(x, y).x,
                            4e-7 * spread + 1e-13);
                ASSERT_NEAR(parts.variance_error.at(x, y), variance * variance, 1e-6 * spread * variance + 1e-13);
            }
    }
}

// Means of many seeds against the variance that each picture tells of itself.
TEST(GoingOn, ToldVarianceIsThatOfThePicture) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    constexpr int seeds = 200;
    for (const auto prepare : {prepare_random, prepare_place, prepare_jitter}) {
        double told = 0, found = 0, squares = 0;
        for (uint32_t seed = 0; seed < seeds; ++seed) {
            const Layers layers = in_two_parts(own_mode(prepare), snapshot, seed, seed);
            const double one = mean_square_of(layers.color, 0.5f), own = mean_red(layers.variance);
            found += one / seeds, told += own / seeds, squares += (one - own) * (one - own) / seeds;
        }
        ASSERT_GT(told, 0);
        EXPECT_NEAR(found, told, 4 * std::sqrt(squares / seeds));
    }
}

TEST(GoingOn, LeavesLessNoiseThanIndependentParts) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    double going_on = 0, apart = 0;
    for (uint32_t seed = 0; seed < 50; ++seed) {
        going_on += mean_square_of(in_two_parts(own_mode(prepare_place), snapshot, seed, seed).color, 0.5f);
        apart += mean_square_of(in_two_parts(own_mode(prepare_place), snapshot, seed, seed + 1000).color, 0.5f);
    }
    EXPECT_LT(going_on, 0.5 * apart);
}

// Two batches tell little of one pixel: what a few of them hold is told by parts of more batches.
TEST(GoingOn, IsForPicturesWhoseNoiseManyPixelsHold) {
    const Mode march = find_mode("march"), path = own_mode(prepare_random);
    Goal goal{0.05, 0, Quality::preview, {}};
    const auto rounds_with = [&](const Mode& mode, double pixels, int batches) {
        TargetRounds rounds{mode, batched_view(size, 4, batches), goal, 0, false, {}};
        rounds.allotment.emplace();
        rounds.allotment->samples = Image<float>(size / 4, 80.0f), rounds.allotment->pixels = pixels;
        return rounds;
    };
    const auto views_of = [](TargetRounds rounds) {
        std::vector<View> views;
        for (const double from : {0.0, 0.4}) {
            const AllottedPart part =
                allotted_part(*rounds.allotment, from, from + 0.4, rounds.unit(), rounds.continues());
            double work = 0.4;
            views.push_back(rounds.round_view(work, from > 0 ? 5 : 4, &part));
        }
        return views;
    };
    const std::vector<View> many = views_of(rounds_with(march, 300, 1));
    EXPECT_EQ(many[0].seed, many[1].seed);
    EXPECT_EQ(batches_of(many[1], {0, 0}), 2);
    EXPECT_EQ(sample_index(many[1], {0, 0}, 0).index, 16u);
    for (const auto& views : {views_of(rounds_with(march, 200, 1)), views_of(rounds_with(path, 300, 1)),
                              views_of(rounds_with(march, 300, 64))}) {
        EXPECT_NE(views[0].seed, views[1].seed);
        EXPECT_GE(batches_of(views[1], {0, 0}), 8);
        EXPECT_EQ(sample_index(views[1], {0, 0}, 0).index, 0u);
    }
}
}
