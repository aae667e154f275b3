// A frame on its way through the stages of a sequence: loaded, rendered, written. For the files of this folder only.
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
struct Work {
    size_t index = 0; // in the request's frames
    FrameReport report;
    std::string hash;
    View view;
    Snapshot snapshot;
    Layers layers;
    FramePart part{};               // instead of layers, where one was asked for
    std::optional<RenderPlan> by{}; // rendered by, where that is not the sequence's
};

// What the stages share.
struct Pipeline {
    const Scene& scene;
    const RenderRequest& request;
    const RenderPlan& plan;
    Progress& progress;
    std::atomic<bool>& cancel;
    std::vector<std::string> channels; // of every file
    LoadedFrame first;                 // of the sequence, until it is taken
    std::shared_ptr<FileHashes> files = first.files;
    size_t next = 0; // index of the first frame not yet looked at
    RenderReport report{};
    std::mutex reporting{};       // held to change the report
    std::atomic<int> settled = 0; // frames rendered or kept
    int rendered = 0;             // frames
};

// The next frame that has to be rendered; kept ones on the way are reported.
std::optional<Work> load_next(Pipeline& pipeline, const Snapshot* previous);
void render(Pipeline& pipeline, Work& work);

void say(const Pipeline& pipeline, const Work& work, const std::string& what);
void report_frame(Pipeline& pipeline, const Work& work);

// The PNG beside a frame's EXR.
void write_picture(const Pipeline& pipeline, const Image<vec3>& color, FrameReport& report);

// The error again, with its frame before its place and the reason kept whole.
[[noreturn]] void fail_in_frame(int frame, const Error& error);
}
