// Parts of a frame into its image: nodes add up to groups as they do in one run.
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/frame/frame_task.h"
#include "render/frame/part.h"
#include "trace/view.h"

#include <algorithm>
#include <map>
#include <mutex>

namespace tyndall {
namespace {
// The sums of a node, which lies in several parts where those hold slices of it.
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

// A stretch of a node's numbers; zeros where it is missing.
std::vector<float> node_sums(const Nodes& nodes, const SumNode& node, size_t first, size_t count) {
    std::vector<float> sums(count, 0.0f);
    if (const auto found = nodes.find(node); found != nodes.end()) {
        for (const std::vector<float>* part : found->second) add(std::span(*part).subspan(first, count), sums);
    } else if (node.level > 0) {
        sums = node_sums(nodes, {node.group, node.level - 1, 2 * node.index}, first, count);
        add(node_sums(nodes, {node.group, node.level - 1, 2 * node.index + 1}, first, count), sums);
    }
    return sums;
}

// That of the sample nearest the pixel's centre; the first of those that are as near.
float nearest_depth(std::span<const FramePart> parts, size_t pixel) {
    float nearest = infinity, depth = infinity;
    for (const FramePart& part : parts)
        if (part.off_center.pixels[pixel] < nearest)
            nearest = part.off_center.pixels[pixel], depth = part.depth.pixels[pixel];
    return depth;
}
}

Layers merge_parts(const View& view, bool halves, std::span<const FramePart> parts, int groups, FrameStats& stats) {
    const FramePart& first = parts[0];
    const size_t numbers = first.numbers, width = static_cast<size_t>(first.size.x);
    View of_all = view;
    of_all.batches = groups;
    Layers layers = make_layers(of_all, halves);
    std::vector<Image<vec3>*> lights;
    if (view.fog_parts) lights = add_light_layers(first.lights, layers);

    const Nodes nodes = nodes_in(parts);
    int root = 0;
    while (1 << root < first.leaves) ++root;
    std::mutex counting;
    parallel_for(layers.size.y, [&](int64_t row) {
        FrameStats counted;
        std::vector<std::vector<float>> sums;
        for (int g = 0; g < groups; ++g)
            sums.push_back(node_sums(nodes, {g, root, 0}, static_cast<size_t>(row) * width * numbers, width * numbers));
        std::vector<float> of_pixel(static_cast<size_t>(groups) * numbers);
        for (size_t x = 0; x < width; ++x) {
            const ivec2 p(static_cast<int>(x), static_cast<int>(row));
            for (size_t g = 0; g < sums.size(); ++g) {
                const std::span<const float> group = std::span(sums[g]).subspan(x * numbers, numbers);
                std::ranges::copy(group, of_pixel.begin() + static_cast<ptrdiff_t>(g * numbers));
                counted.camera_rays += static_cast<uint64_t>(group[14]);
                for (float dropped = group[14] - group[13]; dropped > 0; --dropped) counted.drop(first.low + p);
            }
            store_groups(of_pixel, numbers, nearest_depth(parts, static_cast<size_t>(row) * width + x), p, layers,
                         lights);
        }
        const std::scoped_lock lock(counting);
        stats.add(counted);
    });
    add_up(layers);
    if (groups > 1) stats.noise = noise_of(layers);
    stats.samples = mean_samples(stats.camera_rays, layers);
    return layers;
}
}
