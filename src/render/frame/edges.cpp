#include "render/frame/edges.h"

#include "base/parallel.h"
#include "render/frame/frame.h"
#include "render/frame/samples.h"
#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <algorithm>
#include <mutex>

namespace tyndall {
namespace {
constexpr int fewest_samples = 4; // per pixel, for probing to pay off
// Contrast, (max - min) / (max + min), at which a tile starts to take more samples, and at which it takes the most.
constexpr float min_contrast = 0.15f, full_contrast = 0.6f;

// Values at pixel centers: channel sums of color and of inscatter.
struct Probes {
    ivec2 low;
    Image<vec2> values;
};

Probes probe(const FrameTracer& tracer, ivec2 low, ivec2 high, FrameStats& stats) {
    View centers = tracer.view;
    centers.pixel_samples = centers.batches = 1, centers.lamps.clear(), centers.filter = PixelFilter::center;
    centers.background = true; // does not affect the other layers
    FrameTracer prober = tracer.with(centers);
    prober.covered = false, prober.fog_seconds = nullptr;
    Probes probes{low, Image<vec2>(high - low)};
    std::mutex counting;
    parallel_for((high.y - low.y + tile_side - 1) / tile_side, [&](int64_t row) {
        FrameStats counted;
        const int top = low.y + static_cast<int>(row) * tile_side, bottom = std::min(top + tile_side, high.y);
        for (int left = low.x; left < high.x; left += tile_side) {
            ivec2 pixels[16];
            size_t count = 0;
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < std::min(left + tile_side, high.x); ++x) pixels[count++] = {x, y};
            PixelSample samples[16];
            trace_samples(prober, {pixels, count}, 0, {samples, count}, {});
            for (size_t i = 0; i < count; ++i) {
                ++counted.camera_rays, counted.steps += static_cast<uint64_t>(samples[i].steps);
                const vec3 a = samples[i].color(), b = samples[i].inscatter;
                if (samples[i].finite())
                    probes.values.at(pixels[i].x - low.x, pixels[i].y - low.y) = {a.x + a.y + a.z, b.x + b.y + b.z};
            }
        }
        const std::scoped_lock lock(counting);
        stats.add(counted);
    });
    return probes;
}

// Contrast of a tile and the pixels around it.
float contrast(const Probes& probes, ivec2 corner) {
    const ivec2 size = probes.values.size;
    const ivec2 low = glm::max(corner - 1 - probes.low, 0), high = glm::min(corner + tile_side + 1 - probes.low, size);
    vec2 least(infinity), most(0);
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            least = glm::min(least, probes.values.at(x, y)), most = glm::max(most, probes.values.at(x, y));
    const vec2 both = (most - least) / glm::max(most + least, 1e-30f);
    return std::max(both.x, both.y);
}

// Cache key: everything that the factors depend on; empty without cache files.
std::string edges_content(const FrameTask& task) {
    const FrameTracer& tracer = task.tracer;
    const CacheFolder* folder = cache_folder(tracer.snapshot);
    if (!folder) return {};
    CacheKey key;
    key.add(tracer.view).add(tracer.view.frame).add(tracer.view.seed).add(tracer.view.edge_samples);
    key.add(task.layers.low).add(task.layers.size);
    if (const OpenShutter* shutter = tracer.view.shutter.get())
        for (const Camera& camera : shutter->cameras) {
            View at_moment = tracer.view;
            at_moment.camera = camera;
            key.add(at_moment);
        }
    for (const Medium& medium : tracer.snapshot.media)
        if (medium.density.bricks) key.add(medium.density.bricks);
    key.bits += task.made_by;
    return content_of(key, *folder);
}

TileFactors factors_by_contrast(const FrameTracer& tracer, ivec2 low, ivec2 high, FrameStats& stats) {
    const View& view = tracer.view;
    const ivec2 first = low / tile_side, last = (high - 1) / tile_side;
    const Probes probes =
        probe(tracer, glm::max(first - 1, 0) * tile_side, glm::min((last + 2) * tile_side, view.size), stats);
    TileFactors tiles{first, Image<uint16_t>(last - first + 1, uint16_t{1})};
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            const float share =
                (contrast(probes, ivec2(x, y) * tile_side) - min_contrast) / (full_contrast - min_contrast);
            const float most = static_cast<float>(view.edge_samples);
            tiles.factors.at(x - first.x, y - first.y) =
                static_cast<uint16_t>(std::clamp(1 + share * (most - 1), 1.0f, most));
        }
    return tiles;
}
}

std::shared_ptr<const TileFactors> edge_factors(const FrameTask& task, FrameStats& stats) {
    const View& view = task.tracer.view;
    if (view.edge_samples <= 1 || view.allotted || view.filter == PixelFilter::center ||
        view.pixel_samples < fewest_samples)
        return nullptr;
    const ivec2 low = task.layers.low, high = low + task.layers.size;
    return std::make_shared<const TileFactors>(
        load_or_build<TileFactors>(cache_folder(task.tracer.snapshot), "edges", edges_content(task),
                                   [&] { return factors_by_contrast(task.tracer, low, high, stats); }));
}
}
