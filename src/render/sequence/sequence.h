// Renders frames of a scene to files: resumable, atomic, with progress and statistics.
#pragma once
#include "base/io/progress.h"
#include "modes/limitation.h"
#include "render/frame/layers.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"
#include "trace/snapshot.h"

#include <atomic>
#include <string>
#include <vector>

namespace tyndall {
// A frame of a sequence, loaded for inspection before it is rendered.
struct LoadedFrame {
    Snapshot snapshot;
    double seconds = 0;                                                 // taken to load
    std::shared_ptr<FileHashes> files = std::make_shared<FileHashes>(); // of its fog files, taken before reading them
};

// Loads the first requested frame for inspection. Static data is shared with `previous`, if that is a frame of the same
// scene. Throws Error.
LoadedFrame load_first_frame(const Scene& scene, const RenderRequest& request, const Snapshot* previous = nullptr);

struct FrameReport {
    int frame = 0;
    std::string file;
    std::string mode{}; // that rendered it, if not the sequence's
    bool kept = false;  // by resume; nothing was rendered, noise and samples are those of the file
    double load_seconds = 0, write_seconds = 0;
    double seconds = 0; // since the frame before was rendered: waiting for this one's fog and surfaces, and rendering
    std::optional<double> exposure{}; // stops, of its PNG
    FrameStats stats;
};

struct RenderReport {
    std::vector<FrameReport> frames; // complete ones, in the order of the request
    Limitations limitations;         // of the mode in the first frame, if the caller checked them
    std::vector<std::string> notes;
    int missed = 0;         // frames whose error bound exceeds the target error
    double late = 0;        // seconds over the time budgets of all frames
    bool cancelled = false; // stopped early: the frames above are complete, no file is partial
    double seconds = 0;
    double loading = 0; // seconds taken before to load the first frame
    uint64_t non_finite = 0, peak_memory_bytes = 0;
};

// Renders the requested frames; while one renders, the next is loaded and the previous one is written. `first` (may be
// null) holds the first frame, which is taken from it instead of being loaded again. Before anything else, output names
// are checked and leftovers of killed runs removed. `progress` runs from 0 to the number of frames. A PNG is next to
// its EXR and has the same name. With `resume` a frame is kept if its file decodes completely, has the expected
// channels and size, and its `tyndall:hash` equals the expected one. Throws Error; one of a frame names it, and frames
// finished before it are written. If the exposure of PNGs has to be measured and is not in the plan, it is measured
// first.
RenderReport render_sequence(const Scene& scene, const RenderRequest& request, const RenderPlan& plan,
                             Progress& progress, std::atomic<bool>& cancel, LoadedFrame* first = nullptr);

// JSON of a report, with a schema version.
std::string stats_json(const RenderReport& report, const RenderRequest& request, const RenderPlan& plan);
}
