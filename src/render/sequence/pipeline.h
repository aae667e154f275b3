// The pipeline of a sequence: each frame is loaded, rendered and written. For the files of this folder only.
#pragma once
#include "render/frame/part.h"
#include "render/sequence/sequence.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <atomic>
#include <mutex>
#include <optional>

namespace tyndall {
// A frame ready to render, and after that ready to write.
struct FrameJob {
    size_t index = 0; // in the request's frames
    FrameReport report;
    std::string hash;
    View view;
    Snapshot snapshot;
    std::optional<Snapshot> finer{}; // with more moments, for the target error; it is rendered instead
    Layers layers;
    FramePart part{};               // instead of layers, if a part is requested
    std::optional<RenderPlan> by{}; // what it was rendered with, if not the sequence's plan
};

// What the stages share.
struct Pipeline {
    const Scene& scene;
    const RenderRequest& request;
    const RenderPlan& plan;
    Progress& progress;
    std::atomic<bool>& cancel;
    std::vector<std::string> channels; // of every file
    LoadedFrame first;                 // the sequence's first frame, until it is taken
    std::shared_ptr<FileHashes> files = first.files;
    size_t next = 0; // index of the next frame to load
    RenderReport report{};
    std::mutex reporting{};                  // protects the report
    int rendered = 0;                        // frames
    std::atomic<double> skipped_seconds = 0; // on finished frames that --resume skips
};

// Loads the next frame that has to be rendered; reports the ones kept on the way.
std::optional<FrameJob> load_next(Pipeline& pipeline, const Snapshot* previous);
void render(Pipeline& pipeline, FrameJob& work);

void say(const Pipeline& pipeline, const FrameJob& work, const std::string& what);
void report_frame(Pipeline& pipeline, const FrameJob& work);

// Writes the PNG next to a frame's EXR.
void write_frame_png(const Pipeline& pipeline, const Image<vec3>& color, FrameReport& report);

// Throws the error again, with the frame in front of its location and the reason unchanged.
[[noreturn]] void fail_in_frame(int frame, const Error& error);
}
