#include "render/frame/sums.h"

#include "base/error.h"
#include "render/frame/pixel_sum.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
void add_color(vec3 color, std::span<float> sums) {
    for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += color[c];
}

// One that is not finite counts as taken only.
void add_sample(const PixelSample& sample, std::span<const vec3> parts, std::span<float> sums) {
    add_color(sample.surface, sums.subspan(surface_sum));
    add_color(sample.background, sums.subspan(background_sum));
    add_color(sample.inscatter, sums.subspan(inscatter_sum));
    const float w = sample.weight;
    sums[weight_sum] += w, sums[alpha_sum] += w * sample.alpha, sums[transmittance_sum] += w * sample.transmittance,
        sums[validity_sum] += w * sample.validity;
    sums[kept_sum] += 1;
    for (size_t k = 0; k < parts.size(); ++k) add_color(parts[k], sums.subspan(fixed_sums + 3 * k));
}

std::vector<float> leaf_sums(TileSums& tile, int section, int leaf) {
    const size_t count = tile.tile.count, numbers = tile.numbers(), part_count = tile.task.parts.size();
    std::vector<float> sums(count * numbers, 0.0f);
    std::vector<vec3> fog_parts(part_count * count);
    PixelSample samples[16];
    const auto cut = [&](int at) { return static_cast<int>(int64_t{tile.section_size} * at / tile.leaves); };
    for (int s = cut(leaf); s < cut(leaf + 1); ++s) {
        if (tile.task.cancel && *tile.task.cancel) fail(ExitCode::internal, "render", "cancelled");
        trace_samples(tile.task.tracer, {tile.tile.pixels, count}, section * tile.section_size + s, {samples, count},
                      fog_parts);
        for (size_t i = 0; i < count; ++i) {
            if (!contains(tile.layers, tile.tile.pixels[i])) continue;
            const std::span<float> own{sums.data() + i * numbers, numbers};
            const std::span<const vec3> parts{fog_parts.data() + i * part_count, part_count};
            ++tile.stats.camera_rays, tile.stats.steps += static_cast<uint64_t>(samples[i].steps), own[taken_sum] += 1;
            if (!samples[i].finite() || !std::ranges::all_of(parts, is_finite)) {
                tile.stats.drop(tile.tile.pixels[i]);
                continue;
            }
            add_sample(samples[i], parts, own);
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
void add_group(std::span<const float> sums, PixelSum& pixel) {
    const auto color = [&](size_t at) { return vec3(sums[at], sums[at + 1], sums[at + 2]); };
    if (sums[taken_sum] == 0) return;
    pixel.surface = color(surface_sum), pixel.background = color(background_sum),
    pixel.inscatter = color(inscatter_sum);
    pixel.weight += sums[weight_sum], pixel.alpha += sums[alpha_sum], pixel.transmittance += sums[transmittance_sum],
        pixel.validity += sums[validity_sum];
    pixel.kept += static_cast<int>(sums[kept_sum]);
    pixel.end_batch(static_cast<int>(sums[taken_sum]));
}
}

void store_sections(std::span<const float> sums, size_t numbers, float depth, ivec2 p, Layers& layers,
                    std::span<Image<vec3>* const> parts) {
    PixelSum pixel;
    int samples = 0;
    std::vector<vec3> part_sums(parts.size(), vec3(0));
    for (size_t at = 0; at < sums.size(); at += numbers) {
        const std::span<const float> group = sums.subspan(at, numbers);
        add_group(group, pixel), samples += static_cast<int>(group[taken_sum]);
        for (size_t k = 0; k < parts.size(); ++k)
            part_sums[k] +=
                vec3(group[fixed_sums + 3 * k], group[fixed_sums + 3 * k + 1], group[fixed_sums + 3 * k + 2]);
    }
    pixel.depth = depth;
    store_pixel(pixel, samples, p, layers);
    for (size_t k = 0; k < parts.size(); ++k) parts[k]->at(p.x, p.y) += part_sums[k] / static_cast<float>(samples);
}

int mean_samples(uint64_t samples, const Layers& layers) {
    const double pixels = static_cast<double>(layers.size.x) * layers.size.y;
    return static_cast<int>(std::lround(static_cast<double>(samples) / pixels));
}

void render_grouped_tile(const FrameTask& task, const PixelTile& tile, Layers& layers, FrameStats& stats) {
    TileSums work{task, tile, stats};
    const size_t numbers = work.numbers();
    std::vector<std::vector<float>> sums;
    for (int i = 0; i < work.sections; ++i) sums.push_back(node_sums(work, {i, root_level(work.leaves), 0}));

    std::vector<float> of_pixel(sums.size() * numbers);
    for (size_t i = 0; i < tile.count; ++i) {
        if (!contains(layers, tile.pixels[i])) continue;
        for (size_t g = 0; g < sums.size(); ++g)
            std::copy_n(sums[g].begin() + static_cast<ptrdiff_t>(i * numbers), numbers,
                        of_pixel.begin() + static_cast<ptrdiff_t>(g * numbers));
        store_sections(of_pixel, numbers, work.depth[i], tile.pixels[i] - layers.low, layers, task.parts);
    }
}
}
