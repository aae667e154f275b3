// How many samples a pixel takes, and where they lie: a scrambled (0,2)-sequence warped by the pixel filter.
#include "trace/view.h"
#include "base/random.h"
#include "trace/sampling/lamp_samples.h"

#include <algorithm>
#include <bit>

namespace tyndall {
namespace {
constexpr uint32_t use_lens = 0x1e45u, use_shutter = 0x5477u;

int lamp_factor(const View& view, ivec2 tile) {
    if (view.lamps.empty()) return 1;
    constexpr float reach = 8; // pixels around a lamp in which one sample is too few
    const vec2 low = vec2(tile * tile_side), high = low + static_cast<float>(tile_side);
    float nearest = reach;
    for (const View::Lamp& lamp : view.lamps) {
        const float away = glm::distance(glm::clamp(lamp.at, low, high), lamp.at);
        nearest = std::min(nearest, std::max({away, lamp.radius, 1.0f}));
    }
    return std::clamp(static_cast<int>((reach / nearest) * (reach / nearest)), 1, view.lamp_samples);
}
}

int samples_of(const View& view, ivec2 pixel) {
    const ivec2 tile = pixel / tile_side;
    if (view.allotted) return view.pixel_samples * view.allotted->at(tile);
    return view.pixel_samples * std::max(lamp_factor(view, tile), view.edges ? view.edges->at(tile) : 1);
}

std::pair<int, int> samples_range(const View& view) {
    const int samples = view.pixel_samples;
    if (!view.allotted) return {samples, samples * std::max({view.lamp_samples, view.edge_samples, 1})};
    const auto [fewest, most] = std::ranges::minmax(view.allotted->factors.pixels);
    return {samples * fewest, samples * most};
}

int batches_of(const View& view, ivec2 pixel) {
    if (view.leaves > 0 || view.before) return view.batches;
    const int factor = view.allotted ? view.allotted->at(pixel / tile_side) : 1;
    return view.batches * (factor >= many_allotted && factor % more_batches == 0 ? more_batches : 1);
}

BatchSample batch_sample(const View& view, ivec2 pixel, int sample) {
    const int size = samples_of(view, pixel) / batches_of(view, pixel);
    const int before = view.before ? view.before->at(pixel / tile_side) : 0;
    return {static_cast<uint32_t>(sample / size), static_cast<uint32_t>(before + sample % size),
            static_cast<uint32_t>(before + size)};
}

SampleIndex sample_index(const View& view, ivec2 pixel, int sample) {
    const auto [batch, index, count] = batch_sample(view, pixel, sample);
    const uint32_t key = hash(static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y), view.seed,
                              static_cast<uint32_t>(view.frame));
    return {batch ? hash(key, batch) : key, index};
}

int moment_at(const View& view, ivec2 pixel, int sample) {
    const auto [batch, index, count] = batch_sample(view, pixel, sample);
    const ivec2 tile = pixel / tile_side;
    const uint32_t key = hash(static_cast<uint32_t>(tile.x), static_cast<uint32_t>(tile.y), view.seed,
                              static_cast<uint32_t>(view.frame), use_shutter, batch);
    // The samples of all pixels of a tile share the points of one scrambled sequence ...
    uint32_t time = radical_inverse(shuffle_index(index, hash(key, 0u)), hash(key, 1u));
    // ... except that each pixel of 2×2 takes its own quarter of the gap between two points.
    const uint32_t quarter = static_cast<uint32_t>(pixel.x & 1) | static_cast<uint32_t>(pixel.y & 1) << 1;
    const int bits = std::bit_width(std::bit_ceil(count)) - 1;
    time ^= quarter << 30 >> bits;
    const uint64_t moments = view.shutter->cameras.size();
    return static_cast<int>(time * moments >> 32);
}

Ray sample_ray(const View& view, const Camera& camera, vec2 position, SampleIndex sample) {
    if (!camera.lens) return camera_ray(camera, view.size, position);
    const Sample2 u = sample2(sample.index, hash(sample.sequence, use_lens));
    return lens_ray(camera, view.size, position, aperture_point(camera.lens, {u.x, u.y}));
}

SamplePoint sample_point(const View& view, ivec2 pixel, int sample) {
    const vec2 center = vec2(pixel) + 0.5f;
    if (samples_of(view, pixel) == 1 || view.filter == PixelFilter::center) return {center};
    const SampleIndex point = sample_index(view, pixel, sample);
    if (beside_lamp(view, center)) return lamp_sample(view, center, point);
    const Sample2 u = sample2(point.index, point.sequence);
    return {center + view.filter_radius * filter_point(view.filter, {u.x, u.y})};
}
}
