// A frame's samples in parts that are rendered apart, and the frame they make together.
//
// The samples of a pixel come in groups, each scrambled by itself; those of a group, in their order, in sections,
// which tell how noisy the image is: a group is one, unless the plan has no other. Sections are cut into leaves. The
// samples of a leaf are summed in their order, leaves in a binary tree that is rounded to floats at every node: whoever
// adds up a node, its bits are the same. A part holds a range of leaves, as the largest nodes that lie in it. Where
// there are more parts than leaves, each leaf is cut into slices, every slice with some of the blocks of pixels; then a
// part's nodes are leaves.
#pragma once
#include "render/frame/frame.h"

#include <compare>
#include <functional>
#include <optional>
#include <span>

namespace tyndall {
struct FrameTask;
struct PixelTile;

// The leaves index·2^level to (index + 1)·2^level of a section; sections are counted through all groups.
struct SumNode {
    int section = 0, level = 0, index = 0;
    auto operator<=>(const SumNode&) const = default;
};

// Slices of leaves, counted leaf by leaf and section by section: from `first`, not including `last`.
struct PartRange {
    int64_t first = 0, last = 0;
    int slices = 1; // of a leaf
    bool operator==(const PartRange&) const = default;
};

// Blocks of pixels that may be told apart. `view` as for render_part().
int64_t count_blocks(const Mode& mode, const View& view);

// The share of part `part` of `parts`, counted from 1, of so many sections. Throws Error (usage) where there are more
// parts than slices: a leaf has no more of them than the frame has blocks.
PartRange part_range(int part, int parts, int first_section, int sections, int leaves, int64_t blocks);

// The nodes of a part, in order.
std::vector<SumNode> nodes_of(const PartRange& range, int leaves);

// Where the sums of a pixel's samples lie: colours as RGB, those of camera paths weighted by the pixel filter, samples
// kept and samples taken; after them RGB of each part of the fog light, and of the
// transmittance where the channels differ.
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
    int leaves = 1;       // of a section
    size_t numbers = 0;   // of a pixel and node
    bool covered = false; // whether the background is part of the image: then alpha is 1
    bool colored = false; // whether the last colour is the transmittance of the channels
    LightLayers lights;   // where those are wanted
    std::vector<SumNode> nodes;
    std::vector<std::vector<float>> sums; // of each node, pixel by pixel
    Image<float> depth, off_center;       // at the sample nearest the pixel's centre, and how far away, pixels squared
    Image<float> finished;                // while it is rendered: 1 where all samples of the part are there, else 0
};

// So many rows of all parts, from one on, with their sums.
using PartRows = std::function<std::vector<FramePart>(int first, int count)>;

// The image that parts make together which hold groups 0 to `groups`, in order, before what a mode does with finished
// images; `like` tells what all of them have in common, `nodes` is how many they have in all. `view` is the one they
// were rendered with. Few rows are in memory at once.
//
// Where samples are missing, a pixel leaves out sections that have too few to lower its noise. Pixels without samples
// are black and not valid; there is no noise where one has fewer than two sections.
struct MergedParts {
    Layers layers;
    FrameStats stats;
    int64_t empty_pixels = 0;
};
MergedParts merge_parts(const View& view, bool halves, const FramePart& like, size_t nodes, const PartRows& rows,
                        int groups);

// How a part that is being rendered outlives its process.
struct Checkpoints {
    double seconds = infinity; // between two
    // Gets what there is of the part: every so many seconds, and when cancelled. Nothing changes it meanwhile.
    std::function<void(const FramePart&)> keep{};
    std::optional<FramePart> last{}; // of an earlier run: the same part, to go on from
};

// Throws Error (internal) when cancelled. `view` has leaves; its batches are the groups of the plan, of which a part
// may go beyond.
FramePart render_part(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                      const FrameOptions& options, const PartRange& range, Checkpoints checkpoints, FrameStats& stats);

// A tile of a frame whose samples come in groups, in one go.
void render_grouped_tile(const FrameTask& task, const PixelTile& tile, Layers& layers, FrameStats& stats);

// Writes a pixel from the sums of its sections, one after the other; `parts` are where those of the fog light go.
void store_sections(std::span<const float> sums, size_t numbers, float depth, ivec2 p, Layers& layers,
                    std::span<Image<vec3>* const> parts);

int mean_samples(uint64_t samples, const Layers& layers);
}
