// Merges the parts of a frame into its image: nodes are summed into groups as in a single run.
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/frame/sums.h"
#include "trace/view.h"

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>

namespace tyndall {
namespace {
// The sums of a node, from several parts if they hold slices of it.
using Nodes = std::map<SumNode, std::vector<const std::vector<float>*>>;

Nodes nodes_in(std::span<const FramePart> parts) {
    Nodes nodes;
    for (const FramePart& part : parts)
        for (size_t n = 0; n < part.nodes.size(); ++n) nodes[part.nodes[n]].push_back(&part.sums[n]);
    return nodes;
}

void add(std::span<const float> from, std::span<float> to) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += from[i];
}

// A range of a node's sums; zeros if it is missing.
std::vector<float> node_sums(const Nodes& nodes, const SumNode& node, size_t first, size_t count) {
    std::vector<float> sums(count, 0.0f);
    if (const auto found = nodes.find(node); found != nodes.end()) {
        for (const std::vector<float>* part : found->second) add(std::span(*part).subspan(first, count), sums);
    } else if (node.level > 0) {
        sums = node_sums(nodes, {node.section, node.level - 1, 2 * node.index}, first, count);
        add(node_sums(nodes, {node.section, node.level - 1, 2 * node.index + 1}, first, count), sums);
    }
    return sums;
}

// Depth of the sample nearest the pixel's center; the first of several at the same distance.
float nearest_depth(std::span<const FramePart> parts, size_t pixel) {
    float nearest = infinity, depth = infinity;
    for (const FramePart& part : parts)
        if (part.off_center.pixels[pixel] < nearest)
            nearest = part.off_center.pixels[pixel], depth = part.depth.pixels[pixel];
    return depth;
}

// Zeroes sections that would add noise: the mean of k section means has the variance of one sample times Σ(1 / n) / k²,
// with n samples in each. Returns how many are left.
int keep_helpful_sections(std::span<float> sums, size_t stride) {
    std::vector<float*> groups;
    for (size_t at = 0; at < sums.size(); at += stride)
        if (sums[at + taken_sum] > 0) groups.push_back(&sums[at]);
    std::ranges::stable_sort(groups, std::greater(), [](const float* group) { return group[taken_sum]; });
    size_t best = 0;
    double inverse = 0, least = infinity;
    for (size_t k = 1; k <= groups.size(); ++k) {
        inverse += 1 / static_cast<double>(groups[k - 1][taken_sum]);
        if (const double variance = inverse / static_cast<double>(k * k); variance <= least) least = variance, best = k;
    }
    for (size_t k = best; k < groups.size(); ++k) std::fill_n(groups[k], stride, 0.0f);
    return static_cast<int>(best);
}

// What all rows of a merge share.
struct Merging {
    const FramePart& like;
    int sections = 0;
    MergedParts& merged;
    std::vector<Image<vec3>*> lights; // of the merged layers; then channel_transmittance
    bool alone = false;               // whether a pixel has fewer than two sections
    std::mutex counting{};            // protects `alone` and the counts in `merged`
};

// Row `row` of the image, which is row `row - first` of the parts.
void merge_row(std::span<const FramePart> parts, const Nodes& nodes, int first, int row, Merging& merging) {
    const size_t stride = merging.like.stride, width = static_cast<size_t>(merging.like.size.x);
    const size_t begin = static_cast<size_t>(row - first) * width;
    std::vector<std::vector<float>> sums;
    const int root = root_level(merging.like.leaves);
    for (int i = 0; i < merging.sections; ++i)
        sums.push_back(node_sums(nodes, {i, root, 0}, begin * stride, width * stride));

    FrameStats counted;
    int64_t empty = 0;
    bool alone = false;
    std::vector<float> of_pixel(sums.size() * stride);
    for (size_t x = 0; x < width; ++x) {
        const ivec2 p(static_cast<int>(x), row);
        for (size_t g = 0; g < sums.size(); ++g) {
            const std::span<const float> group = std::span(sums[g]).subspan(x * stride, stride);
            std::ranges::copy(group, of_pixel.begin() + static_cast<ptrdiff_t>(g * stride));
            counted.camera_rays += static_cast<uint64_t>(group[taken_sum]);
            if (const float dropped = group[taken_sum] - group[kept_sum]; dropped > 0)
                counted.drop(merging.like.low + p, static_cast<uint64_t>(dropped));
        }
        const int kept = keep_helpful_sections(of_pixel, stride);
        alone |= kept < 2, empty += kept == 0;
        const float depth = nearest_depth(parts, begin + x);
        if (kept > 0)
            store_sections(of_pixel, stride, depth, p, merging.merged.layers, merging.lights);
        else
            merging.merged.layers.depth.at(p.x, p.y) = infinity;
    }
    const std::scoped_lock lock(merging.counting);
    merging.merged.stats.add(counted), merging.merged.empty_pixels += empty, merging.alone |= alone;
}

// Lines that are compressed together lie in one band; a band's sums take about 256 MB.
int rows_of_band(const FramePart& like, size_t nodes) {
    constexpr size_t packed = 16, bytes = size_t{256} << 20;
    const size_t row = nodes * like.stride * static_cast<size_t>(like.size.x) * sizeof(float);
    return static_cast<int>(std::max<size_t>(bytes / row / packed, 1) * packed);
}
}

MergedParts merge_parts(const View& view, bool halves, const FramePart& like, size_t nodes, const PartRows& rows,
                        int groups) {
    View of_all = view;
    of_all.batches = groups;
    MergedParts merged{make_layers(of_all, halves), {}};
    Merging merging{like, groups * view.sections, merged, {}};
    if (view.fog_parts) merging.lights = add_light_layers(like.lights, merged.layers);
    if (like.colored) {
        merged.layers.channel_transmittance = Image<vec3>(merged.layers.size);
        merging.lights.push_back(&merged.layers.channel_transmittance);
    }

    const int step = rows_of_band(like, nodes);
    for (int first = 0; first < like.size.y; first += step) {
        const int count = std::min(step, like.size.y - first);
        const std::vector<FramePart> parts = rows(first, count);
        const Nodes found = nodes_in(parts);
        parallel_for(count,
                     [&](int64_t row) { merge_row(parts, found, first, first + static_cast<int>(row), merging); });
    }
    add_up(merged.layers);
    if (!merging.alone) merged.stats.noise = noise_of(merged.layers);
    merged.stats.samples = mean_samples(merged.stats.camera_rays, merged.layers);
    return merged;
}
}
