// The loading stage: loads frames, unless those of an earlier run can be kept.
#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "render/parts/part_file.h"
#include "render/sequence/pipeline.h"
#include "render/sequence/provenance.h"
#include "render/sequence/resume.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
ExpectedFrame expected_frame(const Pipeline& pipeline, const FrameJob& work) {
    const View& view = work.view;
    const bool cropped = view.crop_low != view.crop_high;
    return {view.size, cropped ? view.crop_low : ivec2(0), cropped ? view.crop_high - view.crop_low : view.size,
            pipeline.channels, work.hash};
}

// Keeps a frame that is already finished; its PNG is written again, since it has no hash.
bool keep(Pipeline& pipeline, FrameJob& work) {
    std::string why;
    if (is_part(pipeline.request.grouping)) {
        work.report.kept = is_finished_part(work.report.file, work.hash, pipeline.request.grouping, why);
        if (!why.empty()) say(pipeline, work, "rendering again: " + why);
        if (work.report.kept) say(pipeline, work, "kept " + work.report.file);
        return work.report.kept;
    }
    const std::optional<ExrFile> exr = finished_frame(work.report.file, expected_frame(pipeline, work), why);
    if (!exr) {
        if (!why.empty()) say(pipeline, work, "rendering again: " + why);
        return false;
    }
    if (pipeline.request.png) write_frame_png(pipeline, color_of(*exr), work.report);
    work.report.kept = true;
    read_noise(exr->attributes, work.report.stats);
    say(pipeline, work, "kept " + work.report.file);
    return true;
}

// The snapshot of a frame, which shares data with the one before; the first one may be loaded already.
LoadedFrame loaded(Pipeline& pipeline, int frame, const Snapshot* previous) {
    LoadedFrame first = std::exchange(pipeline.first, {});
    if (first.snapshot.scene == &pipeline.scene && first.snapshot.frame == frame) return first;
    const double start = steady_seconds();
    if (!previous) previous = &first.snapshot;
    Snapshot snapshot = make_snapshot(pipeline.scene, moments_of(pipeline.scene, pipeline.request, frame), previous,
                                      pipeline.request.missing, pipeline.request.files);
    return {std::move(snapshot), steady_seconds() - start};
}

void report_notes(Pipeline& pipeline, const Snapshot& snapshot) {
    const std::scoped_lock lock(pipeline.reporting);
    for (const std::string& note : snapshot.notes)
        if (!std::ranges::count(pipeline.report.notes, note)) pipeline.report.notes.push_back(note);
}

}

std::optional<FrameJob> load_next(Pipeline& pipeline, const Snapshot* previous) {
    while (pipeline.next < pipeline.request.frames.size() && !pipeline.cancel) {
        const double start = steady_seconds();
        FrameJob work;
        work.index = pipeline.next++;
        const int frame = work.report.frame = pipeline.request.frames[work.index];
        work.report.file = frame_name(pipeline.request.output, frame);
        if (is_part(pipeline.request.grouping))
            work.report.file = part_name(work.report.file, pipeline.request.grouping);
        try {
            work.view = view_of(pipeline.scene, pipeline.request, pipeline.plan.settings, frame);
            work.hash = frame_hash(pipeline.scene, pipeline.request, pipeline.plan, work.view, *pipeline.files);
            if (pipeline.request.resume && keep(pipeline, work)) {
                work.report.load_seconds = steady_seconds() - start;
                pipeline.skipped_seconds += work.report.load_seconds;
                report_frame(pipeline, work);
                pipeline.progress.skip(1);
                continue;
            }
            work.report.load_seconds = steady_seconds() - start;
            LoadedFrame frame_now = loaded(pipeline, frame, previous);
            work.report.load_seconds += frame_now.seconds;
            work.snapshot = std::move(frame_now.snapshot);
        } catch (const Error& error) {
            fail_in_frame(frame, error);
        }
        report_notes(pipeline, work.snapshot);
        return work;
    }
    return {};
}
}
