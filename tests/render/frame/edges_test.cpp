// More rays where neighboring pixels differ.
#include "modes/limitation.h"
#include "modes/mode.h"
#include "render/fixtures.h"
#include "render/frame/edges.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr ivec2 size(32, 16);
constexpr int samples = 4;

// A bright square before black: seen from straight ahead without perspective its edges cut pixels at `covered`.
struct Edge {
    Scene scene;
    Snapshot snapshot;

    explicit Edge(float half) {
        add_plane(scene, -5, half, vec3(1));
        snapshot = snapshot_of(scene);
    }
};

View edge_view(int edge_samples, int of_pixel = samples) {
    View view = plain_view(size, of_pixel, 16); // a pixel is one meter
    view.edge_samples = edge_samples;
    return view;
}

Layers rendered(const Edge& edge, const View& view, FrameStats& stats) {
    return render_frame(mode_of(prepare_nothing), view, edge.snapshot, Settings{}, {}, stats);
}

// Root mean square error over seeds of the pixels that the square's right edge cuts at a share of them.
double edge_error(const Edge& edge, float covered, int edge_samples, double& mean) {
    double squares = 0, sum = 0;
    constexpr int seeds = 64, rows = 6;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        View view = edge_view(edge_samples);
        view.seed = seed;
        FrameStats stats;
        const Layers layers = rendered(edge, view, stats);
        for (int y = 5; y < 5 + rows; ++y) {
            const double value = layers.color.at(20, y).x;
            squares += (value - covered) * (value - covered), sum += value;
        }
    }
    mean = sum / (seeds * rows);
    return std::sqrt(squares / (seeds * rows));
}

TEST(Edges, TakeMoreRaysThereAndNowhereElse) {
    const Edge edge(7.3f);
    FrameStats plain, more;
    rendered(edge, edge_view(1), plain);
    EXPECT_EQ(plain.camera_rays, 512u * samples);
    rendered(edge, edge_view(4), more);
    // One probe a pixel. The square spans 8.7 to 23.3 and 0.7 to 15.3: its edges run through tiles of columns 2 to 5
    // and rows 0 to 3, all but the four in its middle.
    EXPECT_EQ(more.camera_rays, 512u + 512u * samples + 12u * 16 * 3 * samples);
}

TEST(Edges, AreCloserToTheTruthAndNotBiased) {
    const float covered = 0.3f;
    const Edge edge(4 + covered);
    double mean_plain = 0, mean_more = 0;
    const double plain = edge_error(edge, covered, 1, mean_plain), more = edge_error(edge, covered, 4, mean_more);
    // Stratified samples of a cut pixel: variance falls faster than 1/n.
    EXPECT_LT(more, 0.5 * plain);
    EXPECT_NEAR(mean_more, covered, 4 * more / std::sqrt(64.0 * 6));
}

TEST(Edges, NeedPixelsWithAreaAndSamples) {
    const Edge edge(4.3f);
    FrameStats stats;
    View view = edge_view(4);
    view.filter = PixelFilter::center;
    rendered(edge, view, stats);
    EXPECT_EQ(stats.camera_rays, 512u * samples);
    rendered(edge, edge_view(4, 2), stats);
    EXPECT_EQ(stats.camera_rays, 512u * 2);
    const Edge nothing(0.001f); // between the centers of pixels
    rendered(nothing, edge_view(4), stats);
    EXPECT_EQ(stats.camera_rays, 512u + 512u * samples);
}

TEST(Edges, DoNotDependOnTheCrop) {
    const Edge edge(4.3f);
    FrameStats stats;
    const Layers whole = rendered(edge, edge_view(4), stats);
    View view = edge_view(4);
    view.crop_low = {10, 3}, view.crop_high = {22, 9};
    const Layers part = rendered(edge, view, stats);
    for (int y = 3; y < 9; ++y)
        for (int x = 10; x < 22; ++x) EXPECT_EQ(part.color.at(x - 10, y - 3), whole.color.at(x, y));
}
}
}
