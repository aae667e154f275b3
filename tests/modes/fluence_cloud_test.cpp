// The example cloud by march with the grid of fluence, against path tracing.
#include "base/parallel.h"
#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "path_rays.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <chrono>

namespace tyndall::test {
namespace {
// The fog light of every pixel of a small picture, the mean of some rays through each.
std::vector<vec3> picture(const char* mode, const Snapshot& snapshot, const View& view, const Settings& settings) {
    const ScatterFunction scatter = find_mode(mode).prepare(view, snapshot, settings, nullptr);
    std::vector<vec3> pixels(static_cast<size_t>(view.size.x) * static_cast<size_t>(view.size.y), vec3(0));
    parallel_for(static_cast<int64_t>(pixels.size()), [&](int64_t p) {
        const ivec2 pixel(static_cast<int>(p) % view.size.x, static_cast<int>(p) / view.size.x);
        for (int first = 0; first < view.pixel_samples; first += 16) {
            Ray rays[16];
            uint32_t ids[16];
            Scatter results[16];
            for (int i = 0; i < 16; ++i) {
                const uint32_t sample = static_cast<uint32_t>(first + i);
                const Sample2 u = sample2(sample, hash(static_cast<uint32_t>(p), view.seed, 3u));
                rays[i] = camera_ray(view.camera, view.size, vec2(pixel) + vec2(u.x, u.y));
                ids[i] = hash(static_cast<uint32_t>(p), sample, view.seed);
            }
            scatter({rays, ids, {}, {}}, results);
            for (const Scatter& result : results)
                pixels[static_cast<size_t>(p)] += result.radiance / static_cast<float>(view.pixel_samples);
        }
    });
    return pixels;
}

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

TEST(FluenceOfCloud, NightlyIsWithinFivePerCentOfPathAndTenTimesAsFast) {
    const Scene scene = load_scene(std::string(TYNDALL_SOURCE_DIR) + "/scenes/cloud.json");
    Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
    snapshot.ambient = vec3(0); // the march does not shadow it
    View view;
    view.camera = camera_at(scene, scene.camera, 0);
    view.size = {80, 45}, view.pixel_samples = 16;
    Settings settings = settings_for(Quality::final);
    settings.fluence.orders = all_orders;
    const double start = seconds();
    const std::vector<vec3> march = picture("march", snapshot, view, settings);
    const double march_seconds = seconds() - start;
    view.pixel_samples = 1024;
    const std::vector<vec3> first = picture("path", snapshot, view, settings);
    const double path_seconds = seconds() - start - march_seconds;
    view.seed = 1;
    const std::vector<vec3> second = picture("path", snapshot, view, settings);

    // Squared errors of march, against two independent truths, and of one of these.
    double mean = 0;
    std::vector<double> of_march, of_path;
    for (size_t i = 0; i < march.size(); ++i) {
        mean += glm::dot(first[i] + second[i], vec3(1)) / (6.0 * static_cast<double>(march.size()));
        of_march.push_back(glm::dot(march[i] - first[i], march[i] - second[i]) / 3);
        of_path.push_back(glm::dot(first[i] - second[i], first[i] - second[i]) / 6);
    }
    const Mean march_error = mean_of(of_march), path_error = mean_of(of_path);
    const double square = mean * mean, shown = std::sqrt(std::max(march_error.value, 0.0)) / mean;
    const double path_needs = path_seconds * path_error.value / std::max(march_error.value, 1e-12);
    std::printf("rmse_rel %.4f in %.1f s; path would need %.0f s\n", shown, march_seconds, path_needs);
    EXPECT_LT(march_error.value, 0.05 * 0.05 * square + 2 * march_error.error);
    EXPECT_LT(march_error.error, 0.04 * 0.04 * square) << "too noisy to tell";
    EXPECT_GT(path_needs, 10 * march_seconds);
}
}
}
