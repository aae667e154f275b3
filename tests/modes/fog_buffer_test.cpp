// Fog computed for a smaller picture and spread over the full one, alone and from frame to frame.
#include "modes/fog_buffer.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <atomic>

namespace tyndall {
namespace {
using namespace test;

struct Seen {
    std::vector<Ray> rays;
    std::vector<vec2> positions;
};

View small_view(ivec2 size = {24, 16}) {
    View view;
    view.camera = look_at(vec3(0, 0, 6), vec3(0), vec3(0, 1, 0), 0.7f);
    view.size = size;
    return view;
}

Snapshot lit_box() {
    return snapshot_of({homogeneous_medium(0.3f, Box{vec3(-2), vec3(2)})},
                       {point_light({0.4f, 1, 0.5f}, 20), sun_light({1, -1, 0}, 3)});
}

// Camera rays through the fog, those of odd rows cut off at `cut`.
Seen camera_rays(const View& view, float end, float cut) {
    Seen seen;
    for (int y = 0; y < view.size.y; ++y)
        for (int x = 0; x < view.size.x; ++x) {
            seen.positions.push_back(vec2(x, y) + 0.5f);
            Ray ray = camera_ray(view.camera, view.size, seen.positions.back());
            ray.t_max = y % 2 ? cut : end;
            seen.rays.push_back(ray);
        }
    return seen;
}

std::vector<Scatter> ask(const ScatterFunction& scatter, const Seen& seen, std::vector<vec3>* of_parts = nullptr) {
    std::vector<Scatter> results(seen.rays.size());
    const std::vector<uint32_t> ids(16, 3);
    const size_t lights = of_parts ? of_parts->size() / seen.rays.size() : 0;
    for (size_t i = 0; i < seen.rays.size(); i += 16) {
        const size_t n = std::min<size_t>(16, seen.rays.size() - i);
        std::span<vec3> parts;
        if (of_parts) parts = std::span(*of_parts).subspan(i * lights, n * lights);
        scatter({.rays = std::span(seen.rays).subspan(i, n),
                 .ids = std::span(ids).first(n),
                 .parts = parts,
                 .positions = std::span(seen.positions).subspan(i, n)},
                std::span(results).subspan(i, n));
    }
    return results;
}

Settings middle_of_steps() {
    Settings settings = settings_for(Quality::final);
    settings.march.visibility = Visibility::off;
    return settings;
}

ScatterFunction march_of(const View& view, const Snapshot& snapshot) {
    return main_mode().prepare(view, snapshot, middle_of_steps(), nullptr);
}

// Ends of rays as the fog picture finds them: the far side of the box.
Seen box_rays(const View& view, const Snapshot& snapshot) {
    Seen seen = camera_rays(view, 0, 0);
    for (Ray& ray : seen.rays)
        ray.t_max = std::max(clip(snapshot.bounds, ray.origin, ray.direction, {0, 1e6f}).high, 0.0f);
    return seen;
}

TEST(FogBuffer, AtFullSizeItIsTheSameAtPixelCenters) {
    View view = small_view();
    view.jitter = Jitter::none;
    const Snapshot snapshot = lit_box();
    const ScatterFunction whole = march_of(view, snapshot);
    const Seen seen = box_rays(view, snapshot);
    const std::vector<Scatter> direct = ask(whole, seen);
    const std::vector<Scatter> found = ask(from_fog_buffer(view, snapshot, {}, whole, nullptr), seen);
    for (size_t i = 0; i < direct.size(); ++i) {
        ASSERT_NEAR(found[i].radiance.x, direct[i].radiance.x, 1e-5f * (1 + direct[i].radiance.x)) << i;
        ASSERT_NEAR(found[i].transmittance, direct[i].transmittance, 1e-6f) << i;
    }
}

TEST(FogBuffer, AShareOfThePictureIsCloseInSmoothFogAndExactWhereDepthDiffers) {
    const View view = small_view({64, 48});
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.3f, Box{vec3(-20), vec3(20)})}, {sun_light({1, -1, 0}, 3)});
    int calls = 0;
    const ScatterFunction march = march_of(view, snapshot);
    const ScatterFunction whole = [&](const RayBatch& batch, std::span<Scatter> results) {
        calls += static_cast<int>(batch.rays.size()), march(batch, results);
    };
    for (const Resolution share : {Resolution::half, Resolution::third, Resolution::quarter}) {
        const ScatterFunction spread = from_fog_buffer(view, snapshot, {share}, whole, nullptr);
        const Seen seen = box_rays(view, snapshot);
        const std::vector<Scatter> direct = ask(march, seen);
        calls = 0;
        const std::vector<Scatter> found = ask(spread, seen);
        EXPECT_LT(calls, static_cast<int>(seen.rays.size()) / 10);
        double error = 0, sum = 0;
        for (size_t i = 0; i < direct.size(); ++i)
            error += std::abs(found[i].radiance.x - direct[i].radiance.x), sum += direct[i].radiance.x;
        // Of second order in the size of a pixel.
        EXPECT_LT(error / sum, 0.0015 * std::pow(static_cast<int>(share) + 1, 2)) << static_cast<int>(share);

        // Every second row ends early: its rays are like no neighbor's.
        const Seen edges = camera_rays(view, 25, 7);
        const std::vector<Scatter> exact = ask(march, edges), edge = ask(spread, edges);
        for (size_t i = 0; i < edges.rays.size(); ++i) {
            if (edges.rays[i].t_max != 7) continue;
            ASSERT_EQ(edge[i].radiance, exact[i].radiance) << i;
        }
    }
}

// Whether a surface or the fog ends a ray is passed on: for the picture's own rays, and for those that are not in it.
TEST(FogBuffer, RaysThatNothingEndsStayOpen) {
    const View view = small_view();
    const TestScene stage = make_scene({homogeneous_medium(0.3f, Box{vec3(-2), vec3(2)})}, {},
                                       {quad({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0})});
    std::atomic<int> open = 0, closed = 0;
    const ScatterFunction whole = [&](const RayBatch& batch, std::span<Scatter> results) {
        ASSERT_EQ(batch.open.size(), batch.rays.size());
        for (size_t i = 0; i < results.size(); ++i) {
            const bool at_surface = std::abs(batch.rays[i].at(batch.rays[i].t_max).z) < 1e-3f;
            EXPECT_EQ(batch.open[i], !at_surface);
            ++(batch.open[i] ? open : closed);
        }
        std::ranges::fill(results, Scatter{});
    };
    from_fog_buffer(view, stage.snapshot, {}, whole, nullptr);
    EXPECT_GT(open, 0);
    EXPECT_GT(closed, 0);

    // From another eye: no ray is in the picture.
    const Ray aside{{9, 0, 6}, {0, 0, -1}, 5};
    for (const bool is_open : {true, false}) {
        bool passed = !is_open;
        const ScatterFunction seen = [&](const RayBatch& batch, std::span<Scatter> results) {
            if (batch.rays.size() == 1 && batch.open.size() == 1) passed = batch.open[0];
            std::ranges::fill(results, Scatter{});
        };
        Scatter result;
        const uint32_t id = 1;
        from_fog_buffer(view, stage.snapshot, {}, seen,
                        nullptr)({.rays = {&aside, 1}, .ids = {&id, 1}, .open = {&is_open, 1}}, {&result, 1});
        EXPECT_EQ(passed, is_open);
    }
}

// Open rays of a frame end where the fog of no channel reaches, the buffer's where that of its own does.
TEST(FogBuffer, OpenRaysBeyondItsFogAreInIt) {
    const View view = small_view();
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.3f)}, {});
    int calls = 0;
    const ScatterFunction whole = [&](const RayBatch& batch, std::span<Scatter> results) {
        calls += static_cast<int>(batch.rays.size());
        std::ranges::fill(results, Scatter{});
    };
    const ScatterFunction spread = from_fog_buffer(view, snapshot, {}, whole, nullptr);
    const Seen seen = camera_rays(view, 1000, 30);
    const bool open[2] = {true, false};
    const uint32_t id = 1;
    for (size_t i = 0; i < seen.rays.size(); ++i) {
        calls = 0;
        Scatter result;
        const bool far = seen.rays[i].t_max == 1000;
        spread({.rays = {&seen.rays[i], 1},
                .ids = {&id, 1},
                .positions = {&seen.positions[i], 1},
                .open = {&open[far ? 0 : 1], 1}},
               {&result, 1});
        ASSERT_EQ(calls, far ? 0 : 1) << i;
    }
}

TEST(FogBuffer, LightsAddUp) {
    View view = small_view();
    view.fog_parts = true;
    const Snapshot snapshot = lit_box();
    const Seen seen = box_rays(view, snapshot);
    std::vector<vec3> parts(seen.rays.size() * part_count(2), vec3(0));
    History history;
    for (int frame = 0; frame < 3; ++frame) {
        parts.assign(parts.size(), vec3(0));
        const ScatterFunction scatter =
            from_fog_buffer(view, snapshot, {Resolution::half, true}, march_of(view, snapshot), &history);
        const std::vector<Scatter> results = ask(scatter, seen, &parts);
        for (size_t i = 0; i < results.size(); ++i)
            ASSERT_NEAR((parts[part_count(2) * i] + parts[part_count(2) * i + 1]).x, results[i].radiance.x, 1e-4f)
                << frame;
    }
}

// White jitter of 16 frames: the spread around the mean falls as 1/√age.
TEST(FogBuffer, FramesAverageTheirJitter) {
    View view = small_view({32, 32});
    view.jitter = Jitter::white;
    const Snapshot snapshot = lit_box();
    const ScatterFunction noisy = [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(batch.jitter[i]), 0.5f, 1, 1, vec3(0)};
    };
    const auto spread = [&](const ScatterFunction& scatter) {
        double sum = 0, squares = 0;
        const std::vector<Scatter> results = ask(scatter, box_rays(view, snapshot));
        for (const Scatter& result : results) sum += result.radiance.x, squares += std::pow(result.radiance.x, 2);
        const double n = static_cast<double>(results.size());
        EXPECT_NEAR(sum / n, 0.5, 4 * 0.29 / std::sqrt(n));
        return std::sqrt(squares / n - std::pow(sum / n, 2));
    };
    History history;
    const double alone = spread(from_fog_buffer(view, snapshot, {}, noisy, &history));
    double averaged = alone;
    for (view.frame = 1; view.frame < 10; ++view.frame)
        averaged = spread(from_fog_buffer(view, snapshot, {}, noisy, &history));
    EXPECT_NEAR(alone, 1 / std::sqrt(12), 0.02);
    EXPECT_NEAR(averaged / alone, 1 / std::sqrt(10), 0.08);
}

TEST(FogBuffer, ALightThatGoesOutLeavesNothing) {
    const View view = small_view();
    const Snapshot lit = lit_box();
    Snapshot dark = lit;
    dark.lights.clear();
    History history;
    ScatterFunction before;
    for (int frame = 0; frame < 8; ++frame)
        before = from_fog_buffer(view, lit, {Resolution::half}, march_of(view, lit), &history);
    float shown = 0;
    for (const Scatter& result : ask(before, box_rays(view, lit))) shown += result.radiance.x;
    EXPECT_GT(shown, 0);
    const ScatterFunction after = from_fog_buffer(view, dark, {Resolution::half}, march_of(view, dark), &history);
    for (const Scatter& result : ask(after, box_rays(view, lit))) ASSERT_EQ(result.radiance, vec3(0));
}

// A 4×4 pattern blurred is even.
TEST(FogBuffer, TheBlurRemovesAnOrderedPattern) {
    View view = small_view({32, 32});
    view.jitter = Jitter::ordered;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.3f, Box{vec3(-20), vec3(20)})}, {});
    const ScatterFunction pattern = [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(batch.jitter[i]), 0.5f, 1, 1, vec3(0)};
    };
    const std::vector<Scatter> results =
        ask(from_fog_buffer(view, snapshot, {Resolution::full, true}, pattern, nullptr), box_rays(view, snapshot));
    for (int y = 2; y < 30; ++y)
        for (int x = 2; x < 30; ++x) ASSERT_NEAR(results[y * 32 + x].radiance.x, 0.5f, 1e-5f) << x << " " << y;
}

TEST(FogBuffer, AnEyeThatMovesAsideRemembersLess) {
    // Fog 4 to 8 m away: its near half moves against the far one by a tenth of a pixel for each 5 mm of the eye's way.
    const Snapshot snapshot = lit_box();
    const auto oldest = [&](float way) {
        History history;
        for (int frame = 0; frame < 8; ++frame) {
            View view = small_view({240, 160});
            view.camera.position.x += way * static_cast<float>(frame);
            from_fog_buffer(view, snapshot, {}, march_of(view, snapshot), &history);
        }
        return history.buffer->age.at(120, 80);
    };
    EXPECT_EQ(oldest(0), 8);
    EXPECT_GT(oldest(0.003f), oldest(0.03f));
    EXPECT_GT(oldest(0.03f), 1);
    EXPECT_EQ(oldest(0.3f), 1);
}
}
}
