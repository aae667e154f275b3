#include "render/parts/merge.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/adaptive/planned.h"
#include "render/sequence/provenance.h"
#include "render/sequence/sequence.h"
#include "scene/scene.h"
#include "trace/view.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
// Whether `after` begins where `before` ends. A block's slice depends on the number of slices: leaves divided into
// different numbers of slices can only meet at whole leaves.
enum class Meeting { exact, gap, overlap };
Meeting meeting_of(const PartRange& before, const PartRange& after) {
    const int64_t end = before.last * after.slices, begin = after.first * before.slices;
    if (end < begin) return Meeting::gap;
    const bool whole = before.slices == after.slices || before.last % before.slices == 0;
    return end > begin || !whole ? Meeting::overlap : Meeting::exact;
}

std::string leaves_text(int64_t first, int64_t last, int leaves) {
    const auto text = [&](int64_t leaf) {
        return formatted("%lld/%lld", static_cast<long long>(leaf / leaves + 1),
                         static_cast<long long>(leaf % leaves + 1));
    };
    return last - first == 1 ? "leaf " + text(first) : "leaves " + text(first) + " to " + text(last - 1);
}

void check_alike(const PartFile& part, const PartFile& first) {
    const std::string file = part.file.string(), other = printable(first.file.filename().string(), 80);
    if (part.plan_hash != first.plan_hash) refuse(file, "belongs to a different plan than " + other);
    if (part.frame != first.frame)
        refuse(file, formatted("belongs to frame %d, but %s to frame %d", part.frame, other.c_str(), first.frame));
    const FramePart &a = part.part, &b = first.part;
    if (part.hash != first.hash || a.display != b.display || a.low != b.low || a.size != b.size ||
        a.stride != b.stride || a.leaves != b.leaves || a.lights.names != b.lights.names)
        refuse(file, "was rendered from different inputs than " + other);
}
}

namespace {
// The samples that parts hold, accumulated from the first part to the last.
struct Holdings {
    const int leaves; // per group
    PartGroups found{};
    double held = 0; // leaves

    // Records the first gap: leaves `first` to `last` (excluded).
    void add_gap(const PartFile& beside, int64_t first, int64_t last, const PartFile* next = nullptr) {
        if (!found.gap.empty()) return;
        found.beside = beside.file;
        found.gap = "a part is missing next to " + printable(beside.label, 20) + ", with " +
                    leaves_text(first, last, leaves) + " (group/leaf)";
        if (next) found.gap += ", before " + printable(next->file.filename().string(), 80);
    }
    void add(const PartRange& range) { held += static_cast<double>(range.last - range.first) / range.slices; }
};

int64_t first_whole_leaf(const PartRange& range) { return (range.first + range.slices - 1) / range.slices; }
}

PartGroups check_parts(std::vector<PartFile>& parts, const SavedPlan& plan) {
    for (const PartFile& part : parts) {
        check_alike(part, parts[0]);
        if (part.plan_hash != plan.request.grouping.plan_hash || part.part.leaves != plan.request.grouping.leaves)
            refuse(part.file.string(), "does not belong to " + plan.request.grouping.plan_file.string());
    }
    std::ranges::sort(parts, [](const PartFile& a, const PartFile& b) {
        const PartRange &one = a.part.range, &two = b.part.range;
        return std::pair(one.first * two.slices, a.file) < std::pair(two.first * one.slices, b.file);
    });

    Holdings holdings{parts[0].part.leaves * plan.request.grouping.sections};
    for (size_t i = 0; i < parts.size(); ++i) {
        const PartRange& range = parts[i].part.range;
        holdings.add(range);
        if (i == 0 && range.first > 0) holdings.add_gap(parts[0], 0, first_whole_leaf(range));
        if (i == 0) continue;
        const PartRange& before = parts[i - 1].part.range;
        const Meeting meeting = meeting_of(before, range);
        if (meeting == Meeting::overlap)
            refuse(parts[i].file.string(),
                   "has samples that are also in " + printable(parts[i - 1].file.filename().string(), 80));
        if (meeting == Meeting::gap)
            holdings.add_gap(parts[i - 1], before.last / before.slices, first_whole_leaf(range), &parts[i]);
    }
    const PartRange& last = parts.back().part.range;
    const int leaves = holdings.leaves;
    const int64_t whole = last.last / last.slices, begun = (last.last + last.slices - 1) / last.slices;
    const int64_t end =
        std::max<int64_t>(int64_t{plan.request.grouping.groups} * leaves, (begun + leaves - 1) / leaves * leaves);
    if (last.last % last.slices != 0 || whole < end) holdings.add_gap(parts.back(), whole, end);
    holdings.found.groups = static_cast<int>(end / leaves);
    holdings.found.share = holdings.held / static_cast<double>(end);
    return holdings.found;
}

namespace {
// Marks a frame with missing samples as partial, with another hash, so that --resume does not keep it.
void note_gap(const PartGroups& groups, Provenance& provenance) {
    if (groups.gap.empty()) return;
    provenance.attributes["tyndall:partial"] = formatted("%.4g of the samples", groups.share);
    provenance.attributes["tyndall:hash"] = content_hash("partial " + provenance.attributes["tyndall:hash"]);
}
}

MergedFrame merge_frame(std::span<const PartFile> files, const PartGroups& groups, const Scene& scene,
                        const SavedPlan& plan) {
    const RenderRequest& request = plan.request;
    const PartFile& first = files[0];
    const View view = view_of(scene, request, plan.plan.settings, first.frame);
    FileHashes hashes;
    const std::string hash = frame_hash(scene, request, plan.plan, view, hashes);
    if (hash != first.hash) refuse(first.file.string(), "the files it was rendered from have changed since");

    const auto [fewest, most] = samples_range(view);
    const int sections = view.batches * view.sections;
    const SectionSamples of_section{fewest / sections, most / sections};
    const auto rows = [&](int low, int count) {
        std::vector<FramePart> parts(files.size());
        parallel_for(static_cast<int64_t>(files.size()), [&](int64_t i) {
            parts[static_cast<size_t>(i)] = read_rows(files[static_cast<size_t>(i)], low, count, of_section);
        });
        return parts;
    };
    size_t nodes = 0;
    for (const PartFile& file : files) nodes += file.part.nodes.size();
    const bool post = plan.plan.mode->surfaces == Surfaces::post;
    auto [layers, stats, empty_pixels] = merge_parts(
        post ? view_before_post(view) : view, wants_layer(request, "halves"), first.part, nodes, rows, groups.groups);

    MergedFrame merged{std::move(layers), stats, {}, empty_pixels};
    const PlannedError& planned = request.grouping.error;
    LoadedFrame frame;
    if (post || planned.is_checked()) {
        RenderRequest of_frame = request;
        of_frame.frames = {view.frame};
        frame = load_first_frame(scene, of_frame);
    }
    if (post) {
        add_post(*plan.plan.mode, view, frame.snapshot, plan.plan.settings, merged.layers, merged.stats);
        merged.stats.noise.reset();
    }
    add_planned_error(planned, *plan.plan.mode, view, frame.snapshot, plan.plan.settings, merged.layers, {},
                      merged.stats);
    if (first.part.covered) std::ranges::fill(merged.layers.alpha.pixels, 1.0f);
    merged.provenance = provenance_of(scene, request, plan.plan, view, hash, merged.stats);
    note_gap(groups, merged.provenance);
    return merged;
}
}
