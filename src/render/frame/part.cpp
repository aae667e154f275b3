#include "render/frame/part.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/frame/camera_paths.h"
#include "render/frame/edges.h"
#include "render/frame/sums.h"
#include "render/image/exr.h"
#include "trace/mattes.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <cassert>
#include <mutex>
#include <shared_mutex>
#include <utility>

namespace tyndall {
int64_t count_blocks(const Mode& mode, const View& view) {
    const bool cropped = view.crop_low != view.crop_high && mode.surfaces != Surfaces::post;
    return cropped ? count_blocks(view.crop_low, view.crop_high - view.crop_low) : count_blocks(ivec2(0), view.size);
}

PartRange part_range(int part, int parts, int first_section, int sections, int leaves, int64_t blocks) {
    const int64_t all_leaves = int64_t{sections} * leaves, slices = (parts + all_leaves - 1) / all_leaves;
    if (slices > blocks)
        fail(ExitCode::usage, "--part",
             formatted("this frame can have at most %lld parts", static_cast<long long>(all_leaves * blocks)));
    const int64_t all = all_leaves * slices, before = int64_t{first_section} * leaves * slices;
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
// Whether a part holds a block of a leaf.
bool holds(const PartRange& range, int64_t leaf, int64_t block) {
    const int64_t slice = leaf * range.slices + block % range.slices;
    return slice >= range.first && slice < range.last;
}

// A part while all threads work on it.
struct PartWork {
    FramePart& part;
    const Checkpoints& checkpoints;
    std::shared_mutex storing{}; // shared while tiles are stored, exclusive while a checkpoint is written
    std::atomic<double> next = steady_seconds() + checkpoints.seconds;

    size_t place(ivec2 pixel) const {
        const ivec2 p = pixel - part.low;
        return static_cast<size_t>(p.y) * static_cast<size_t>(part.size.x) + static_cast<size_t>(p.x);
    }
    // Tiles are finished as a whole.
    bool is_finished(const PixelTile& tile, const Layers& layers) const {
        for (size_t i = 0; i < tile.count; ++i)
            if (contains(layers, tile.pixels[i])) return part.finished.pixels[place(tile.pixels[i])] > 0;
        return true;
    }
};

void store_tile(const TileSums& tile, const std::vector<std::vector<float>>& sums, PartWork& work) {
    FramePart& part = work.part;
    const std::shared_lock lock(work.storing);
    for (size_t i = 0; i < tile.tile.count; ++i) {
        if (!contains(tile.layers, tile.tile.pixels[i])) continue;
        const size_t at = work.place(tile.tile.pixels[i]);
        for (size_t n = 0; n < sums.size(); ++n)
            if (!sums[n].empty())
                std::copy_n(sums[n].begin() + static_cast<ptrdiff_t>(i * part.stride), part.stride,
                            part.sums[n].begin() + static_cast<ptrdiff_t>(at * part.stride));
        part.depth.pixels[at] = tile.depth[i], part.off_center.pixels[at] = tile.off_center[i];
        part.finished.pixels[at] = 1;
    }
}

// Writes a checkpoint when one is due, on the first thread to notice.
void keep_in_time(PartWork& work) {
    double due = work.next;
    if (steady_seconds() < due || !work.next.compare_exchange_strong(due, infinity)) return;
    const std::unique_lock lock(work.storing);
    work.checkpoints.keep(work.part);
    work.next = steady_seconds() + work.checkpoints.seconds;
}

void render_part_tile(const FrameTask& task, const PixelTile& tile, int64_t block, PartWork& work, FrameStats& stats) {
    const FramePart& part = work.part;
    TileSums sums_of{task, tile, stats};
    std::vector<std::vector<float>> sums(part.nodes.size());
    for (size_t n = 0; n < part.nodes.size(); ++n) {
        const SumNode& node = part.nodes[n];
        if (part.range.slices == 1 || holds(part.range, int64_t{node.section} * part.leaves + node.index, block))
            sums[n] = node_sums(sums_of, node);
    }
    if (has_center_depths(task.tracer)) center_depths(task.tracer, {tile.pixels, tile.count}, sums_of.depth);
    store_tile(sums_of, sums, work);
    keep_in_time(work);
}

// Also counts the samples that an earlier run dropped.
void count_dropped(const FramePart& part, FrameStats& stats) {
    for (int y = 0; y < part.size.y; ++y)
        for (int x = 0; x < part.size.x; ++x)
            for (const std::vector<float>& sums : part.sums) {
                const float* own = &sums[static_cast<size_t>(y * part.size.x + x) * part.stride];
                if (const float dropped = own[taken_sum] - own[kept_sum]; dropped > 0)
                    stats.drop(part.low + ivec2(x, y), static_cast<uint64_t>(dropped));
            }
}

bool is_same(const FramePart& a, const FramePart& b) {
    return a.display == b.display && a.low == b.low && a.size == b.size && a.range == b.range && a.leaves == b.leaves &&
           a.stride == b.stride && a.covered == b.covered && a.lights.names == b.lights.names;
}

// Throws Error (usage) for a part that does not fit into an EXR file.
void check_size(const FramePart& part) {
    const size_t channels = nodes_of(part.range, part.leaves).size() * part.stride + 3; // Z, offset and finished
    const double bytes = sizeof(float) * static_cast<double>(channels) * part.size.x * part.size.y;
    if (bytes > static_cast<double>(max_decoded_bytes) || channels > max_channels)
        fail(
            ExitCode::usage, "--part",
            formatted("a part of this frame would take %zu channels and %.1f GiB; %d channels and 4 GiB are the limit: "
                      "use more parts or fewer layers",
                      channels, bytes / (1 << 30), max_channels));
}

// The part without samples, or with those of an earlier run.
FramePart begun_part(FramePart part, std::optional<FramePart> last) {
    if (last && is_same(*last, part)) return std::move(*last);
    part.nodes = nodes_of(part.range, part.leaves);
    const size_t pixels = static_cast<size_t>(part.size.x) * static_cast<size_t>(part.size.y);
    part.sums.assign(part.nodes.size(), std::vector<float>(pixels * part.stride, 0.0f));
    part.depth = part.off_center = Image<float>(part.size, infinity);
    part.finished = Image<float>(part.size, 0.0f);
    return part;
}

// Renders all tiles that are not finished.
FrameStats render_tiles(const FrameTask& task, const FrameOptions& options, const Checkpoints& checkpoints,
                        FramePart& part) {
    PartWork work{part, checkpoints};
    try {
        return for_each_tile(task.layers, options, [&](const PixelTile& tile, int64_t block, FrameStats& stats) {
            if (!work.is_finished(tile, task.layers)) render_part_tile(task, tile, block, work, stats);
        });
    } catch (const Error&) {
        if (checkpoints.keep && options.cancel && *options.cancel) checkpoints.keep(part);
        throw;
    }
}
}

FramePart render_part(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                      const FrameOptions& options, const PartRange& range, Checkpoints checkpoints, FrameStats& stats) {
    View view = given;
    assert(view.leaves > 0 && view.pixel_samples % view.batches == 0);
    if (mode.surfaces == Surfaces::shared) view.lamps = lamps_in(view, snapshot);
    if (mode.surfaces == Surfaces::post) view = view_before_post(view);
    const double start = steady_seconds();
    FrameTask task = make_task(mode, view, snapshot, settings, options);
    const LightLayers lights = view.fog_parts ? light_layers(snapshot) : LightLayers{};
    find_parts(view, lights, task);
    const double prepared = steady_seconds();
    FramePart part;
    part.display = task.layers.display, part.low = task.layers.low, part.size = task.layers.size;
    part.range = range, part.leaves = view.leaves;
    part.stride = fixed_sums + 3 * task.parts.size(), part.lights = lights;
    part.colored = task.parts.size() > task.fog_parts;
    part.covered = given.background && has_background(snapshot.background) && !has_mattes(snapshot);
    check_size(part);
    part = begun_part(std::move(part), std::exchange(checkpoints.last, {}));

    FrameStats probed;
    count_dropped(part, probed);
    if (mode.surfaces == Surfaces::shared) view.edges = edge_factors(task, probed);
    stats = render_tiles(task, options, checkpoints, part);
    stats.prepare_seconds = prepared - start, stats.render_seconds = steady_seconds() - prepared;
    stats.fog_seconds = task.mode_seconds + *task.fog_seconds / thread_count();
    stats.moments = static_cast<int>(std::max<size_t>(task.prepared->moments.size(), 1));
    stats.add(probed);
    part.finished = {};
    return part;
}
}
