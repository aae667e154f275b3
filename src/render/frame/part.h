// A frame's samples in parts that are rendered separately, and the frame they add up to.
//
// The samples of a pixel come in groups, each with its own scrambling. The samples of a group, in order, are divided
// into sections, whose variance shows the noise of the image: a group is one section, unless the plan has only one
// group. Sections are divided into leaves. The samples of a leaf are summed in order, leaves in a binary tree that is
// rounded to float at every node: a node has the same bits wherever it is summed. A part holds a range of leaves, as
// the largest nodes inside it. If there are more parts than leaves, each leaf is divided into slices, each with some of
// the blocks of pixels; a part's nodes are then leaves.
#pragma once
#include "render/frame/frame.h"

#include <compare>
#include <functional>
#include <optional>
#include <span>

namespace tyndall {
struct FrameTask;
struct PixelTile;

// The leaves index·2^level to (index + 1)·2^level of a section; sections are numbered through all groups.
struct SumNode {
    int section = 0, level = 0, index = 0;
    auto operator<=>(const SumNode&) const = default;
};

// Slices `first` to `last` (excluded), numbered leaf by leaf and section by section.
struct PartRange {
    int64_t first = 0, last = 0;
    int slices = 1; // per leaf
    bool operator==(const PartRange&) const = default;
};

// The number of blocks of pixels among which leaves can be sliced. `view` as for render_part().
int64_t count_blocks(const Mode& mode, const View& view);

// The range of part `part` of `parts`, counted from 1. Throws Error (usage) if there are more parts than slices: a leaf
// has at most one per block.
PartRange part_range(int part, int parts, int first_section, int sections, int leaves, int64_t blocks);

// The nodes of a part, in order.
std::vector<SumNode> nodes_of(const PartRange& range, int leaves);

// Offsets of the sums of a pixel's samples: colors as RGB, values of camera paths weighted by the pixel filter, samples
// kept and samples taken; after them RGB of each part of inscatter, and of the transmittance if fog is chromatic.
enum PixelSums : size_t {
    surface_sum = 0,
    background_sum = 3,
    inscatter_sum = 6,
    weight_sum = 9,
    alpha_sum,
    transmittance_sum,
    validity_sum,
    kept_sum,
    taken_sum,
    fixed_sums
};

struct FramePart {
    ivec2 display{0}, low{0}, size{0};
    PartRange range;
    int leaves = 1;       // per section
    size_t stride = 0;    // floats per pixel and node
    bool covered = false; // whether the background is part of the image: then alpha is 1
    bool colored = false; // whether the last RGB sum is channel_transmittance
    LightLayers lights;   // if requested
    std::vector<SumNode> nodes;
    std::vector<std::vector<float>> sums; // of each node, pixel by pixel
    Image<float> depth, off_center; // of the sample nearest the pixel's center, and its squared distance, pixels²
    Image<float> finished;          // while rendering: 1 where all samples of the part are taken, else 0
};

// Reads `count` rows of all parts, from row `first` on, with their sums.
using PartRows = std::function<std::vector<FramePart>(int first, int count)>;

// Merges parts that hold groups 0 to `groups`, in order, before any Surfaces::post mode adds to the image. `like` holds
// what all parts have in common; `nodes` is how many they have in all. `view` is the one they were rendered with. Only
// a few rows are in memory at once.
//
// If samples are missing, a pixel leaves out sections with too few to lower its noise. Pixels without samples are black
// and invalid; noise is unknown if a pixel has fewer than two sections.
struct MergedParts {
    Layers layers;
    FrameStats stats;
    int64_t empty_pixels = 0;
};
MergedParts merge_parts(const View& view, bool halves, const FramePart& like, size_t nodes, const PartRows& rows,
                        int groups);

// Checkpoints of a part, for another process to continue from.
struct Checkpoints {
    double seconds = infinity; // between two checkpoints
    // Receives the unfinished part: every `seconds`, and when cancelled. It does not change during the call.
    std::function<void(const FramePart&)> keep{};
    std::optional<FramePart> last{}; // the same part from an earlier run, to continue from
};

// Renders a part. `view` must have leaves; its batches are the plan's groups, and `range` may go beyond them. Throws
// Error (internal) when cancelled.
FramePart render_part(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                      const FrameOptions& options, const PartRange& range, Checkpoints checkpoints, FrameStats& stats);

// Renders a tile of a frame whose samples come in groups, in a single run.
void render_grouped_tile(const FrameTask& task, const PixelTile& tile, Layers& layers, FrameStats& stats);

// Writes a pixel from the concatenated sums of its sections; `parts` receive the parts of inscatter.
void store_sections(std::span<const float> sums, size_t stride, float depth, ivec2 p, Layers& layers,
                    std::span<Image<vec3>* const> parts);

int mean_samples(uint64_t samples, const Layers& layers);
}
