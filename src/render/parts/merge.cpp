#include "render/parts/merge.h"

#include "base/error.h"
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
// Whether `after` begins where `before` ends. Blocks go into slices by their number: leaves cut into different numbers
// of slices may only meet at whole leaves.
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

[[noreturn]] void refuse_gap(const PartFile& beside, int64_t first, int64_t last, int leaves) {
    refuse(beside.file.string(), "a part is missing beside " + printable(beside.label, 20) + ", with " +
                                     leaves_text(first, last, leaves) + " (group/leaf)");
}

void check_alike(const PartFile& part, const PartFile& first) {
    const std::string file = part.file.string(), other = printable(first.file.filename().string(), 80);
    if (part.plan_hash != first.plan_hash) refuse(file, "is of another plan than " + other);
    if (part.frame != first.frame)
        refuse(file, formatted("is of frame %d, but %s of frame %d", part.frame, other.c_str(), first.frame));
    const FramePart &a = part.part, &b = first.part;
    if (part.hash != first.hash || a.display != b.display || a.low != b.low || a.size != b.size ||
        a.numbers != b.numbers || a.leaves != b.leaves || a.lights.names != b.lights.names)
        refuse(file, "was rendered from other inputs than " + other);
}
}

int check_parts(std::vector<PartFile>& parts, const SavedPlan& plan) {
    for (const PartFile& part : parts) {
        check_alike(part, parts[0]);
        if (part.plan_hash != plan.request.grouping.plan_hash)
            refuse(part.file.string(), "is not of " + plan.request.grouping.plan_file.string());
    }
    std::ranges::sort(parts, [](const PartFile& a, const PartFile& b) {
        const PartRange &one = a.part.range, &two = b.part.range;
        return std::pair(one.first * two.slices, a.file) < std::pair(two.first * one.slices, b.file);
    });
    const int leaves = parts[0].part.leaves;
    const PartRange& first = parts[0].part.range;
    if (first.first > 0) refuse_gap(parts[0], 0, (first.first + first.slices - 1) / first.slices, leaves);
    for (size_t i = 1; i < parts.size(); ++i) {
        const PartRange &before = parts[i - 1].part.range, &after = parts[i].part.range;
        const Meeting meeting = meeting_of(before, after);
        if (meeting == Meeting::overlap)
            refuse(parts[i].file.string(),
                   "holds samples that " + printable(parts[i - 1].file.filename().string(), 80) + " holds as well");
        if (meeting == Meeting::gap)
            refuse_gap(parts[i - 1], before.last / before.slices, (after.first + after.slices - 1) / after.slices,
                       leaves);
    }
    const PartRange& last = parts.back().part.range;
    const int64_t all = int64_t{plan.request.grouping.groups} * leaves, whole = last.last / last.slices;
    const int64_t end = std::max(all, (whole + leaves - 1) / leaves * leaves);
    if (last.last % last.slices != 0 || whole < end) refuse_gap(parts.back(), whole, end, leaves);
    return static_cast<int>(whole / leaves);
}

MergedFrame merge_frame(std::vector<PartFile> files, int groups, const Scene& scene, const SavedPlan& plan) {
    const RenderRequest& request = plan.request;
    const View view = view_of(scene, request, plan.plan.settings, files[0].frame);
    FileHashes hashes;
    const std::string hash = frame_hash(scene, request, plan.plan, view, hashes), part_hash = files[0].hash;
    if (hash != part_hash) refuse(files[0].file.string(), "the files it was rendered from have changed since");

    std::vector<FramePart> parts;
    for (PartFile& file : files) parts.push_back(std::move(file.part));
    const bool post = plan.plan.mode->surfaces == Surfaces::post, covered = parts[0].covered;
    MergedFrame merged;
    merged.layers =
        merge_parts(post ? view_before_post(view) : view, wants_layer(request, "halves"), parts, groups, merged.stats);
    parts.clear();
    const PlannedError& planned = request.grouping.error;
    LoadedFrame frame;
    if (post || (planned.integrator && !planned.is_truth)) {
        RenderRequest of_frame = request;
        of_frame.frames = {view.frame};
        frame = load_first_frame(scene, of_frame);
    }
    if (post) {
        add_post(*plan.plan.mode, view, frame.snapshot, plan.plan.settings, merged.layers, merged.stats);
        merged.stats.noise.reset();
    }
    judge_planned(planned, *plan.plan.mode, view, frame.snapshot, plan.plan.settings, merged.layers, {}, merged.stats);
    if (covered) std::ranges::fill(merged.layers.alpha.pixels, 1.0f);
    merged.provenance = provenance_of(scene, request, plan.plan, view, hash, merged.stats);
    return merged;
}
}
