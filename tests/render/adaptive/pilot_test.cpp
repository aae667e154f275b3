// The few pixels that tell how wrong a picture will be.
#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/check.h"
#include "render/adaptive/scout.h"
#include "render/adaptive/to_target.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace tyndall::test {
namespace {
const Box room{vec3(-4), vec3(4)};
const FrameOptions plain{};
const vec3 out_of_view{0.3f, 8, 0};

View view_of(ivec2 size) {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = size, view.pixel_samples = 1;
    return view;
}

Settings truth() { return truth_settings(Settings{}); }

Pilot pilot_of(const View& view, const Snapshot& snapshot, TileChances chances, uint32_t salt = 0) {
    const Settings exact = truth();
    return make_pilot(main_mode(), view, snapshot, &exact, std::move(chances), salt, plain);
}

std::shared_ptr<const Scout> scout_of(const View& view, const Snapshot& snapshot) {
    return make_scout(main_mode(), view, snapshot, {"", settings_for(Quality::draft)}, plain, steady_seconds);
}

// As the march, but twice as bright within 6 cm of the place.
Mode bright_beside(vec3 place) {
    static vec3 wrong;
    wrong = place;
    Mode mode = find_mode("march");
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = main_mode().prepare(view, snapshot, settings, history);
        return ScatterFunction([right](const RayBatch& batch, std::span<Scatter> results) {
            right(batch, results);
            for (size_t i = 0; i < results.size(); ++i) {
                const Ray& ray = batch.rays[i];
                const vec3 to = wrong - ray.origin;
                if (glm::length(to - glm::dot(to, ray.direction) * ray.direction) < 0.06f) results[i].radiance *= 2;
            }
        });
    };
    return mode;
}

// Sums of a function of tiles, estimated from drawings, come out right on the average.
TEST(TileChances, DrawnTilesStandForAll) {
    TileChances tiles{{2, 1}, {12, 10}, {}};
    for (int i = 0; i < 120; ++i) tiles.chances.push_back((1.0 + i % 7 * (i % 7)) / 1668);
    tiles.chances[50] += 1 - std::accumulate(tiles.chances.begin(), tiles.chances.end(), 0.0);
    const auto value = [](ivec2 corner) { return 1.0 + corner.x * corner.y % 11; };
    double all = 0, mean = 0, squares = 0;
    for (int i = 0; i < 120; ++i) all += value(4 * (tiles.low + ivec2(i % 12, i / 12)));
    constexpr int drawings = 400;
    for (uint32_t seed = 0; seed < drawings; ++seed) {
        double sum = 0;
        for (const DrawnTile& tile : draw_tiles(tiles, 20, seed)) {
            EXPECT_LE(tile.chance, 1);
            sum += tile.weight * value(tile.corner);
        }
        mean += sum / drawings, squares += sum * sum / drawings;
    }
    EXPECT_NEAR(mean, all, 4 * std::sqrt((squares - mean * mean) / drawings));
    EXPECT_EQ(draw_tiles(tiles, 200, 1).size(), 120u) << "more than there are";
}

TEST(TileChances, ALikelyTileIsDrawnForCertain) {
    TileChances tiles{{0, 0}, {10, 10}, std::vector<double>(100, 0.5 / 99)};
    tiles.chances[37] = 0.5;
    for (uint32_t seed = 0; seed < 20; ++seed) {
        const std::vector<DrawnTile> drawn = draw_tiles(tiles, 16, seed);
        const auto found = std::ranges::find(drawn, ivec2(28, 12), &DrawnTile::corner);
        ASSERT_NE(found, drawn.end());
        EXPECT_EQ(found->weight, 1);
    }
}

TEST(TileChances, FollowNoiseAndLight) {
    const View view = view_of({160, 90});
    const vec3 place(0.3f, -0.7f, 0);
    const auto scout = scout_of(view, snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(place)}));
    const TileChances tiles = chances_in(scout->layers);
    EXPECT_NEAR(std::accumulate(tiles.chances.begin(), tiles.chances.end(), 0.0), 1, 1e-9);
    EXPECT_GE(*std::ranges::min_element(tiles.chances), 0.25 / static_cast<double>(tiles.chances.size()) - 1e-12);
    const ivec2 lamp = ivec2(*pixel_of(view.camera, view.size, place)) / 4;
    EXPECT_GT(tiles.chances[static_cast<size_t>(lamp.y) * tiles.size.x + lamp.x], 1.0 / drawing_tiles);
}

// Before there is an image to go by.
TEST(TileChances, EvenOnesDrawALampInViewForCertain) {
    View view = view_of({640, 360});
    view.filter = PixelFilter::blackman_harris;
    const vec3 place(0.3f, -0.7f, 0);
    const TileChances tiles =
        uniform_chances(view, snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(place)}));
    EXPECT_NEAR(std::accumulate(tiles.chances.begin(), tiles.chances.end(), 0.0), 1, 1e-9);
    EXPECT_GE(*std::ranges::min_element(tiles.chances), 0.5 / static_cast<double>(tiles.chances.size()) - 1e-12);
    const ivec2 lamp = ivec2(*pixel_of(view.camera, view.size, place)) / 4 * 4;
    for (uint32_t seed = 0; seed < 8; ++seed) {
        const std::vector<DrawnTile> drawn = draw_tiles(tiles, drawing_tiles, seed);
        const auto found = std::ranges::find(drawn, lamp, &DrawnTile::corner);
        ASSERT_NE(found, drawn.end());
        EXPECT_EQ(found->weight, 1);
    }
    const TileChances dark = uniform_chances(view, snapshot_of({homogeneous_medium(0.1f, room)}, {}));
    EXPECT_EQ(std::ranges::min(dark.chances), std::ranges::max(dark.chances));
}

TEST(TileChances, FollowWhatAnotherTechniqueShows) {
    const View view = view_of({160, 90});
    const auto scout = scout_of(view, snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(vec3(0))}));
    Layers other = scout->layers;
    for (int i = 0; i < 16; ++i) other.inscatter.at(80 + i % 4, 8 + i / 4) *= 1.5f;
    const TileChances tiles = chances_between(other, scout->layers);
    EXPECT_NEAR(std::accumulate(tiles.chances.begin(), tiles.chances.end(), 0.0), 1, 1e-9);
    EXPECT_GT(tiles.chances[2 * static_cast<size_t>(tiles.size.x) + 20], 0.24);
    EXPECT_EQ(chances_between(other, other).chances, chances_in(other).chances);
}

TEST(Pilot, ATinyPictureIsFollowedWhole) {
    const View view = view_of({3, 2});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light({0, 0, 0})});
    const Pilot pilot = pilot_of(view, snapshot, uniform_chances(view, snapshot));
    EXPECT_EQ(pilot.tiles.size(), 1u);
    EXPECT_TRUE(pilot.is_full());
}

TEST(Pilot, GrowsByIndependentDrawings) {
    const View view = view_of({160, 90});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(out_of_view)});
    Pilot pilot = pilot_of(view, snapshot, uniform_chances(view, snapshot));
    EXPECT_EQ(pilot.tiles.size(), drawing_tiles);
    grow(pilot), grow(pilot);
    EXPECT_EQ(pilot.truth.size(), pilot.tiles.size() * pilot_values);
    const double samples = pilot.samples();
    grow(pilot, true);
    EXPECT_EQ(pilot.samples(), 2 * samples);
    double stood_for = 0;
    for (const DrawnTile& tile : pilot.tiles) stood_for += tile.weight;
    EXPECT_NEAR(stood_for, pilot.all(), 1e-6);
    const Pilot other = pilot_of(view, snapshot, uniform_chances(view, snapshot), 1);
    EXPECT_NE(other.tiles[0].corner, pilot.tiles[0].corner);
    EXPECT_NE(other.view.seed, pilot.view.seed);
}

TEST(Pilot, KeepsToItsWork) {
    const View view = view_of({160, 90});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(out_of_view)});
    const double all = pilot_of(view, snapshot, uniform_chances(view, snapshot)).cost.work;
    const Settings exact = truth();
    for (const double share : {0.0, 0.5, 2.0}) {
        const Pilot pilot = make_pilot(main_mode(), view, snapshot, &exact, uniform_chances(view, snapshot), 0, plain,
                                       nullptr, {}, share * all);
        EXPECT_LT(pilot.cost.work, std::max(share, 0.25) * all * 1.2); // eight tiles at least
        EXPECT_GT(pilot.cost.work, std::min(share, 1.0) * all * 0.7);
        EXPECT_EQ(pilot.truth.size(), pilot.tiles.size() * pilot_values);
        double stood_for = 0;
        for (const DrawnTile& tile : pilot.tiles) stood_for += tile.weight;
        EXPECT_NEAR(stood_for, pilot.all(), 1e-6);
    }
}

// The whole error in the 14400th part of a picture, which few tiles drawn evenly would show.
TEST(Pilot, SeesWhatIsWrongInALampsPixelAlone) {
    const View view = view_of({96, 54});
    const vec3 place(0.3f, -0.7f, 0);
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(place)});
    const Pilot pilot = pilot_of(view, snapshot, chances_in(scout_of(view, snapshot)->layers));
    const Measurement right = measure(pilot, main_mode(), truth(), steady_seconds);
    const Measurement wrong = measure(pilot, bright_beside(place), truth(), steady_seconds);
    EXPECT_EQ(right.integrator.bound, 0);

    // Against whole pictures through the same rays, which differ there only.
    FrameStats stats;
    const View even = uniform_view(view, 16, 1);
    const Layers one = render_frame(main_mode(), even, snapshot, truth(), plain, stats);
    const Layers other = render_frame(bright_beside(place), even, snapshot, truth(), plain, stats);
    double squares = 0, mean = 0, differing = 0;
    for (size_t i = 0; i < one.inscatter.pixels.size(); ++i) {
        const dvec3 off = dvec3(other.inscatter.pixels[i]) - dvec3(one.inscatter.pixels[i]);
        squares += glm::dot(off, off) / 3, mean += one.inscatter.pixels[i].x, differing += glm::dot(off, off) > 0;
    }
    EXPECT_GT(differing, 0);
    EXPECT_LE(differing, 16);
    const double error = squares * static_cast<double>(one.inscatter.pixels.size()) / (mean * mean);
    EXPECT_GE(wrong.integrator.bound, error);
    EXPECT_LE(wrong.integrator.value, 4 * error);
}

// Bounds that are to hold with 97.5 %, for sums of which few tiles hold most: a tenth of them, other ones each time.
TEST(Pilot, BoundsHoldWhereFewTilesHoldMost) {
    const TileChances tiles{{0, 0}, {40, 40}, std::vector<double>(1600, 1.0 / 1600)};
    int held = 0;
    constexpr int times = 1000;
    for (uint32_t seed = 0; seed < times; ++seed) {
        const auto off_at = [seed](ivec2 corner) {
            const uint32_t x = static_cast<uint32_t>(corner.x), y = static_cast<uint32_t>(corner.y);
            return to_unit(hash(x, y, seed)) < 0.1 ? 1.0 : 0.02;
        };
        double all = 0;
        for (int i = 0; i < 1600; ++i) all += off_at(4 * ivec2(i % 40, i / 40)) / 1600;
        const std::vector<DrawnTile> drawn = draw_tiles(tiles, 64, seed);
        std::vector<Sums> sums;
        for (const DrawnTile& tile : drawn) {
            const double off = off_at(tile.corner);
            sums.push_back({{16 * off, 0}, {16 * off * off, 0}, 16, 16});
        }
        held += squared_error(sums, drawn, of_integrator).bound >= all;
    }
    EXPECT_GE(held, times * 965 / 1000);
}

namespace {
std::atomic<size_t> draft_rays = 0, right_draft_rays = 0;

// As the march, with a little noise; draft settings are 6 % off, which their first rays do not show.
ScatterFunction prepare_off_later(const View& view, const Snapshot& snapshot, const Settings& settings,
                                  History* history) {
    const ScatterFunction right = main_mode().prepare(view, snapshot, settings, history);
    const bool draft = settings.march.step_share == settings_for(Quality::draft).march.step_share;
    return [right, draft](const RayBatch& batch, std::span<Scatter> results) {
        right(batch, results);
        const bool off = draft && (draft_rays += results.size()) > right_draft_rays;
        for (size_t i = 0; i < results.size(); ++i)
            results[i].radiance *= (off ? 1.01f : 0.95f) + 0.1f * to_unit(hash(batch.ids[i], 1u));
    };
}
}

// What was chosen for lack of evidence gives way to a finer candidate when the pilot has grown.
TEST(Pilot, AChoiceGetsToTheErrorWhereAFinerCandidateDoes) {
    Mode mode = main_mode();
    mode.prepare = prepare_off_later;
    const View view = view_of({160, 90});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {sun_light({0, -1, -0.2f})});
    draft_rays = 0, right_draft_rays = 160 * 90 / 4 * scout_samples + drawing_tiles * 16 * 2; // scout and first drawing
    const Goal goal{0.02, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(mode, view, snapshot, settings_for(Quality::preview), goal, 0, plain);
    EXPECT_GT(choice.pilot->passes * choice.pilot->drawings, 1) << "the pilot has grown";
    EXPECT_NE(choice.candidate.name, "draft");
    EXPECT_LT(choice.work_to(goal.error), infinity);
}

namespace {
// As the march on the average; a ray is 70 % off.
std::atomic<size_t> flickering_rays;
ScatterFunction prepare_flickering(const View& view, const Snapshot& snapshot, const Settings& settings,
                                   History* history) {
    const ScatterFunction right = main_mode().prepare(view, snapshot, settings, history);
    return [right](const RayBatch& batch, std::span<Scatter> results) {
        right(batch, results);
        flickering_rays += results.size();
        for (size_t i = 0; i < results.size(); ++i) results[i].radiance *= hash(batch.ids[i], 1u) % 2 ? 1.7f : 0.3f;
    };
}
}

// Many samples are to come: looking longer at what they do not remove takes less than what that would take of the
// error asked for.
TEST(Pilot, GrowsUntilItsOwnNoiseLeavesTheErrorToTheImage) {
    Mode mode = main_mode();
    mode.prepare = prepare_flickering, mode.name = "flickering"; // nothing it does counts as free of error
    const View view = view_of({160, 90});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {sun_light({0, -1, -0.2f})});
    const Goal goal{0.05, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(mode, view, snapshot, settings_for(Quality::preview), goal, 0, plain);
    EXPECT_GT(choice.pilot->passes, 8);
    EXPECT_GT(noise_target(choice, goal.error), 0.8 * goal.error);
    EXPECT_LT(choice.pilot->cost.work, 0.5 * choice.work_to(goal.error));
}

// A finer candidate takes about as much as the picture did: no more than that is spent on whether one is needed.
TEST(Goal, DoubtsTakeNoMoreThanThePictureTook) {
    Mode mode = main_mode();
    mode.prepare = prepare_flickering;
    const View view = view_of({160, 90});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {sun_light({0, -1, -0.2f})});
    const Settings settings = settings_for(Quality::preview);
    Goal goal{0.5, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(mode, view, snapshot, settings, goal, 0, plain);
    ASSERT_FALSE(choice.is_truth);
    goal.error = 0.05;
    const Noise noise{0.04, 0.049, 0.045};
    const auto rays_for = [&](double samples) {
        flickering_rays = 0;
        check_choice(choice, {choice.scout->layers, noise, samples, samples, false}, infinity, mode, view, snapshot,
                     settings, goal, 1, plain);
        return static_cast<double>(flickering_rays) / (160 * 90);
    };
    EXPECT_LE(rays_for(1), 1.2 + 2.0 * drawing_tiles * 16 / (160 * 90)) << "and the first look";
    EXPECT_GT(rays_for(1000), 4 * rays_for(1)) << "what more would take is worth a longer one";
}

// A frame that glows, with settings of another that did not: it is held against its glow, and gets it back.
TEST(Goal, AFrameIsHeldAgainstTermsThatAnotherDidNotNeed) {
    Medium fog = homogeneous_medium(0.1f, room);
    fog.optics.emission.radiance = vec3(0.02f);
    const Snapshot snapshot = snapshot_of({fog}, {point_light({0, 5, 0}, 20)});
    Settings settings;
    settings.terms.emission = false;
    Goal goal{0.05};
    FrameStats stats;
    const View view = view_of({64, 36});
    render_to_target(find_mode("march"), view, snapshot, settings, goal, plain, stats);
    EXPECT_FALSE(stats.integrator->settings.terms.emission) << "nothing else was asked for";
    goal.wanted = std::make_shared<const Settings>();
    render_to_target(find_mode("march"), view, snapshot, settings, goal, plain, stats);
    EXPECT_TRUE(stats.integrator->settings.terms.emission);
    EXPECT_LE(stats.error()->bound, 0.05);
}
}
}
