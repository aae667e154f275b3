#include "render/frame/part.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/frame/edges.h"
#include "render/frame/frame_task.h"
#include "render/frame/pixel_sum.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
int64_t count_blocks(const Mode& mode, const View& view) {
    const bool cropped = view.crop_low != view.crop_high && mode.surfaces != Surfaces::post;
    return cropped ? count_blocks(view.crop_low, view.crop_high - view.crop_low) : count_blocks(ivec2(0), view.size);
}

PartRange part_range(int part, int parts, int first_group, int groups, int leaves, int64_t blocks) {
    const int64_t all_leaves = int64_t{groups} * leaves, slices = (parts + all_leaves - 1) / all_leaves;
    if (slices > blocks)
        fail(ExitCode::usage, "--part",
             formatted("this frame has %lld parts at most", static_cast<long long>(all_leaves * blocks)));
    const int64_t all = all_leaves * slices, before = int64_t{first_group} * leaves * slices;
    return {before + (part - 1) * all / parts, before + part * all / parts, static_cast<int>(slices)};
}

std::vector<SumNode> nodes_of(const PartRange& range, int leaves) {
    std::vector<SumNode> nodes;
    const int64_t last = (range.last + range.slices - 1) / range.slices;
    for (int64_t leaf = range.first / range.slices; leaf < last;) {
        SumNode node{static_cast<int>(leaf / leaves), 0, static_cast<int>(leaf % leaves)};
        int64_t size = 1;
        while (range.slices == 1 && size < leaves && node.index % 2 == 0 && leaf + 2 * size <= last)
            node.index /= 2, ++node.level, size *= 2;
        nodes.push_back(node), leaf += size;
    }
    return nodes;
}

namespace {
struct TileSums {
    const FrameTask& task;
    const PixelTile& tile;
    FrameStats& stats;
    const Layers& layers = task.layers; // whose pixels count
    int leaves = task.tracer.view.leaves;
    int group_size = samples_of(task.tracer.view, tile.corner) / task.tracer.view.batches;
    std::vector<float> depth = std::vector<float>(16, infinity), off_center = depth;

    size_t numbers() const { return fixed_sums + 3 * task.parts.size(); }
};

void add_color(vec3 color, std::span<float> sums) {
    for (int c = 0; c < 3; ++c) sums[static_cast<size_t>(c)] += color[c];
}

// One that is not finite counts as taken only.
void add_sample(const PixelSample& sample, std::span<const vec3> parts, std::span<float> sums) {
    add_color(sample.surface, sums), add_color(sample.background, sums.subspan(3));
    add_color(sample.inscatter, sums.subspan(6));
    const float w = sample.weight;
    sums[9] += w, sums[10] += w * sample.alpha, sums[11] += w * sample.transmittance, sums[12] += w * sample.validity;
    sums[13] += 1;
    for (size_t k = 0; k < parts.size(); ++k) add_color(parts[k], sums.subspan(fixed_sums + 3 * k));
}

std::vector<float> leaf_sums(TileSums& tile, int group, int leaf) {
    const size_t count = tile.tile.count, numbers = tile.numbers(), part_count = tile.task.parts.size();
    std::vector<float> sums(count * numbers, 0.0f);
    std::vector<vec3> fog_parts(part_count * count);
    PixelSample samples[16];
    const auto cut = [&](int at) { return static_cast<int>(int64_t{tile.group_size} * at / tile.leaves); };
    for (int s = cut(leaf); s < cut(leaf + 1); ++s) {
        trace_samples(tile.task.tracer, {tile.tile.pixels, count}, group * tile.group_size + s, {samples, count},
                      fog_parts);
        for (size_t i = 0; i < count; ++i) {
            if (!contains(tile.layers, tile.tile.pixels[i])) continue;
            const std::span<float> own{sums.data() + i * numbers, numbers};
            const std::span<const vec3> parts{fog_parts.data() + i * part_count, part_count};
            ++tile.stats.camera_rays, tile.stats.steps += static_cast<uint64_t>(samples[i].steps), own[14] += 1;
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

std::vector<float> node_sums(TileSums& tile, const SumNode& node) {
    if (node.level == 0) return leaf_sums(tile, node.group, node.index);
    std::vector<float> left = node_sums(tile, {node.group, node.level - 1, 2 * node.index});
    const std::vector<float> right = node_sums(tile, {node.group, node.level - 1, 2 * node.index + 1});
    for (size_t i = 0; i < left.size(); ++i) left[i] += right[i];
    return left;
}

int root_level(int leaves) {
    int level = 0;
    while (1 << level < leaves) ++level;
    return level;
}

void add_group(std::span<const float> sums, PixelSum& pixel) {
    const auto color = [&](size_t at) { return vec3(sums[at], sums[at + 1], sums[at + 2]); };
    if (sums[14] == 0) return;
    pixel.surface = color(0), pixel.background = color(3), pixel.inscatter = color(6);
    pixel.weight += sums[9], pixel.alpha += sums[10], pixel.transmittance += sums[11], pixel.validity += sums[12];
    pixel.kept += static_cast<int>(sums[13]);
    pixel.end_batch(static_cast<int>(sums[14]));
}
}

void store_groups(std::span<const float> sums, size_t numbers, float depth, ivec2 p, Layers& layers,
                  std::span<Image<vec3>* const> parts) {
    PixelSum pixel;
    int samples = 0;
    std::vector<vec3> part_sums(parts.size(), vec3(0));
    for (size_t at = 0; at < sums.size(); at += numbers) {
        const std::span<const float> group = sums.subspan(at, numbers);
        add_group(group, pixel), samples += static_cast<int>(group[14]);
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
    const size_t groups = static_cast<size_t>(task.tracer.view.batches), numbers = work.numbers();
    std::vector<std::vector<float>> sums;
    for (size_t g = 0; g < groups; ++g)
        sums.push_back(node_sums(work, {static_cast<int>(g), root_level(work.leaves), 0}));

    std::vector<float> of_pixel(groups * numbers);
    for (size_t i = 0; i < tile.count; ++i) {
        if (!contains(layers, tile.pixels[i])) continue;
        for (size_t g = 0; g < groups; ++g)
            std::copy_n(sums[g].begin() + static_cast<ptrdiff_t>(i * numbers), numbers,
                        of_pixel.begin() + static_cast<ptrdiff_t>(g * numbers));
        store_groups(of_pixel, numbers, work.depth[i], tile.pixels[i] - layers.low, layers, task.parts);
    }
}

namespace {
// Whether a part holds a block of a leaf.
bool holds(const PartRange& range, int64_t leaf, int64_t block) {
    const int64_t slice = leaf * range.slices + block % range.slices;
    return slice >= range.first && slice < range.last;
}

void render_part_tile(const FrameTask& task, const PixelTile& tile, int64_t block, FramePart& part, FrameStats& stats) {
    TileSums work{task, tile, stats};
    const auto place = [&](size_t i) {
        const ivec2 p = tile.pixels[i] - part.low;
        return static_cast<size_t>(p.y) * static_cast<size_t>(part.size.x) + static_cast<size_t>(p.x);
    };
    for (size_t n = 0; n < part.nodes.size(); ++n) {
        const SumNode& node = part.nodes[n];
        if (part.range.slices > 1 && !holds(part.range, int64_t{node.group} * part.leaves + node.index, block))
            continue;
        const std::vector<float> sums = node_sums(work, node);
        for (size_t i = 0; i < tile.count; ++i)
            if (contains(task.layers, tile.pixels[i]))
                std::copy_n(sums.begin() + static_cast<ptrdiff_t>(i * part.numbers), part.numbers,
                            part.sums[n].begin() + static_cast<ptrdiff_t>(place(i) * part.numbers));
    }
    for (size_t i = 0; i < tile.count; ++i)
        if (contains(task.layers, tile.pixels[i]))
            part.depth.pixels[place(i)] = work.depth[i], part.off_center.pixels[place(i)] = work.off_center[i];
}
}

FramePart render_part(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                      const FrameOptions& options, const PartRange& range, FrameStats& stats) {
    View view = given;
    assert(view.leaves > 0 && view.pixel_samples % view.batches == 0);
    if (mode.surfaces == Surfaces::shared) view.lamps = lamps_in(view, snapshot);
    if (mode.surfaces == Surfaces::post) view = view_before_post(view);
    const double start = steady_seconds();
    FrameTask task = make_task(mode, view, snapshot, settings, options);
    const LightLayers lights = view.fog_parts ? light_layers(snapshot) : LightLayers{};
    if (view.fog_parts) task.parts = add_light_layers(lights, task.layers);
    const double prepared = steady_seconds();
    FrameStats probed;
    if (mode.surfaces == Surfaces::shared) view.edges = edge_factors(task, probed);

    FramePart part;
    part.display = task.layers.display, part.low = task.layers.low, part.size = task.layers.size;
    part.range = range, part.leaves = view.leaves, part.nodes = nodes_of(range, view.leaves);
    part.covered = given.background && has_background(snapshot.background), part.lights = lights;
    part.numbers = fixed_sums + 3 * task.parts.size();
    const size_t pixels = task.layers.color.pixels.size();
    part.sums.assign(part.nodes.size(), std::vector<float>(pixels * part.numbers, 0.0f));
    part.depth = part.off_center = Image<float>(part.size, infinity);
    stats = for_each_tile(task.layers, options, [&](const PixelTile& tile, int64_t block, FrameStats& block_stats) {
        render_part_tile(task, tile, block, part, block_stats);
    });
    stats.prepare_seconds = prepared - start, stats.render_seconds = steady_seconds() - prepared;
    stats.fog_seconds = task.mode_seconds + *task.scatter_seconds / thread_count();
    stats.add(probed);
    return part;
}
}
