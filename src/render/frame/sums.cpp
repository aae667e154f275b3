#include "render/frame/sums.h"

#include "base/error.h"
#include "render/frame/camera_paths.h"
#include "render/frame/pixel_sum.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
void add_color(vec3 color, std::span<float> sums) {
    for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += color[c];
}

// Adds a finite sample; one that is not finite counts as taken only.
void add_sample(const PixelSample& sample, std::span<const vec3> parts, bool channels, std::span<float> sums) {
    add_color(sample.surface, sums.subspan(surface_sum));
    add_color(sample.background, sums.subspan(background_sum));
    add_color(sample.inscatter, sums.subspan(inscatter_sum));
    const float w = sample.weight;
    sums[weight_sum] += w, sums[alpha_sum] += w * sample.alpha, sums[transmittance_sum] += w * sample.transmittance,
        sums[validity_sum] += w * sample.validity;
    sums[kept_sum] += 1;
    for (size_t k = 0; k < parts.size(); ++k) add_color(parts[k], sums.subspan(fixed_sums + 3 * k));
    if (channels) add_color(w * sample.channels, sums.subspan(fixed_sums + 3 * parts.size()));
}

std::vector<float> leaf_sums(TileSums& tile, int section, int leaf) {
    const size_t count = tile.tile.count, stride = tile.stride(), part_count = tile.task.fog_parts;
    std::vector<float> sums(count * stride, 0.0f);
    std::vector<vec3> fog_parts(part_count * count);
    PixelSample samples[16];
    const auto cut = [&](int at) { return static_cast<int>(int64_t{tile.section_size} * at / tile.leaves); };
    for (int s = cut(leaf); s < cut(leaf + 1); ++s) {
        if (tile.task.cancel && *tile.task.cancel) fail(ExitCode::internal, "render", "cancelled");
        trace_samples(tile.task.tracer, {tile.tile.pixels, count}, section * tile.section_size + s, {samples, count},
                      fog_parts);
        for (size_t i = 0; i < count; ++i) {
            if (!contains(tile.layers, tile.tile.pixels[i])) continue;
            const std::span<float> own{sums.data() + i * stride, stride};
            const std::span<const vec3> parts{fog_parts.data() + i * part_count, part_count};
            ++tile.stats.camera_rays, tile.stats.steps += static_cast<uint64_t>(samples[i].steps), own[taken_sum] += 1;
            if (!samples[i].finite() || !std::ranges::all_of(parts, is_finite)) {
                tile.stats.drop(tile.tile.pixels[i]);
                continue;
            }
            add_sample(samples[i], parts, tile.task.parts.size() > part_count, own);
            if (samples[i].off_center < tile.off_center[i])
                tile.off_center[i] = samples[i].off_center, tile.depth[i] = samples[i].depth;
        }
    }
    return sums;
}

}

std::vector<float> node_sums(TileSums& tile, const SumNode& node) {
    if (node.level == 0) return leaf_sums(tile, node.section, node.index);
    std::vector<float> left = node_sums(tile, {node.section, node.level - 1, 2 * node.index});
    const std::vector<float> right = node_sums(tile, {node.section, node.level - 1, 2 * node.index + 1});
    for (size_t i = 0; i < left.size(); ++i) left[i] += right[i];
    return left;
}

int root_level(int leaves) {
    int level = 0;
    while (1 << level < leaves) ++level;
    return level;
}

namespace {
// The sums of a pixel's sections; those without samples are skipped.
struct PixelSections {
    std::span<const float> sums;
    size_t stride; // of each

    template<class Body> void for_each(const Body& body) const {
        for (size_t at = 0; at < sums.size(); at += stride)
            if (const std::span<const float> own = sums.subspan(at, stride); own[taken_sum] > 0) body(own);
    }
};

vec3 color_at(std::span<const float> sums, size_t at) { return {sums[at], sums[at + 1], sums[at + 2]}; }

// Moments of a value over the sections, in two passes: all sections are in memory, so no running moments are needed.
template<class Value> RunningSpread spread_of(const PixelSections& sections, const Value& value) {
    RunningSpread spread;
    sections.for_each([&](std::span<const float> own) { spread.mean += dvec3(value(own)), ++spread.count; });
    spread.mean *= 1.0 / std::max(spread.count, 1);
    sections.for_each([&](std::span<const float> own) {
        const dvec3 deviation = dvec3(value(own)) - spread.mean, square = deviation * deviation;
        spread.squares += square, spread.fourths += square * square;
    });
    return spread;
}

template<class Value> RunningMean mean_of(const PixelSections& sections, const Value& value) {
    RunningMean mean;
    sections.for_each([&](std::span<const float> own) { mean.mean += dvec3(value(own)), ++mean.count; });
    mean.mean *= 1.0 / std::max(mean.count, 1);
    return mean;
}

// Even sections go to the first half, odd ones to the second.
void add_halves(const PixelSections& sections, PixelSum& pixel) {
    int section = 0;
    sections.for_each([&](std::span<const float> own) {
        const vec3 color = color_at(own, surface_sum) + color_at(own, background_sum) + color_at(own, inscatter_sum);
        pixel.half_means[section++ % 2].add(color / own[taken_sum]);
    });
}

PixelSum pixel_of(const PixelSections& sections, bool halves) {
    PixelSum pixel;
    const auto mean = [](size_t at) {
        return [at](std::span<const float> own) { return color_at(own, at) * (1 / own[taken_sum]); };
    };
    pixel.surface_mean = mean_of(sections, mean(surface_sum));
    pixel.background_mean = mean_of(sections, mean(background_sum));
    pixel.inscatter_mean = spread_of(sections, mean(inscatter_sum));
    pixel.color_mean = spread_of(sections, [](std::span<const float> own) {
        return (color_at(own, surface_sum) + color_at(own, background_sum) + color_at(own, inscatter_sum)) *
               (1 / own[taken_sum]);
    });
    if (halves) add_halves(sections, pixel);
    sections.for_each([&](std::span<const float> own) {
        pixel.weight += own[weight_sum], pixel.alpha += own[alpha_sum], pixel.transmittance += own[transmittance_sum],
            pixel.validity += own[validity_sum];
        pixel.kept += static_cast<int>(own[kept_sum]);
    });
    return pixel;
}
}

void store_sections(std::span<const float> sums, size_t stride, float depth, ivec2 p, Layers& layers,
                    std::span<Image<vec3>* const> parts) {
    const PixelSections sections{sums, stride};
    PixelSum pixel = pixel_of(sections, !layers.half_a.empty());
    pixel.depth = depth;
    int samples = 0;
    sections.for_each([&](std::span<const float> own) { samples += static_cast<int>(own[taken_sum]); });
    store_pixel(pixel, samples, p, layers);
    for (size_t k = 0; k < parts.size(); ++k) {
        vec3 sum{0};
        sections.for_each([&](std::span<const float> own) { sum += color_at(own, fixed_sums + 3 * k); });
        parts[k]->at(p.x, p.y) += sum / static_cast<float>(samples);
    }
}

int mean_samples(uint64_t samples, const Layers& layers) {
    const double pixels = static_cast<double>(layers.size.x) * layers.size.y;
    return static_cast<int>(std::lround(static_cast<double>(samples) / pixels));
}

void render_grouped_tile(const FrameTask& task, const PixelTile& tile, Layers& layers, FrameStats& stats) {
    TileSums work{task, tile, stats};
    const size_t stride = work.stride();
    std::vector<std::vector<float>> sums;
    for (int i = 0; i < work.sections; ++i) sums.push_back(node_sums(work, {i, root_level(work.leaves), 0}));
    if (has_center_depths(task.tracer)) center_depths(task.tracer, {tile.pixels, tile.count}, work.depth);

    std::vector<float> of_pixel(sums.size() * stride);
    for (size_t i = 0; i < tile.count; ++i) {
        if (!contains(layers, tile.pixels[i])) continue;
        for (size_t g = 0; g < sums.size(); ++g)
            std::copy_n(sums[g].begin() + static_cast<ptrdiff_t>(i * stride), stride,
                        of_pixel.begin() + static_cast<ptrdiff_t>(g * stride));
        store_sections(of_pixel, stride, work.depth[i], tile.pixels[i] - layers.low, layers, task.parts);
    }
}
}
