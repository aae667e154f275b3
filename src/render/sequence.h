// Frames of a scene to files: resumable, atomic, with progress and statistics.
#pragma once
#include "base/progress.h"
#include "render/exr.h"
#include "render/goal.h"

#include <atomic>
#include <string>
#include <vector>

namespace tyndall {
struct RenderJob {
    std::filesystem::path scene_file;
    std::string output; // pattern
    std::vector<int> frames;
    std::string mode = "march";
    Quality quality = Quality::preview;
    Settings settings;   // quality and --set already applied
    std::string camera;  // empty = the scene's
    ivec2 resolution{0}; // 0 = the scene's
    ivec2 crop_low{0}, crop_high{0};
    uint32_t seed = 0;
    std::string isa;
    MissingFrame missing = MissingFrame::error;
    LightUnits light_units = LightUnits::spec; // how the scene was loaded; for the header
    float exposure = 0;                        // added to the scene's, for PNGs
    ExrOptions exr;
    double target_error = 0; // render until the error is below this share of the picture's mean; 0 = none is asked for
    double time_budget = 0;  // seconds for each frame, loading and writing apart; 0 = as many as it takes
    int history = 0;         // frames before each that a mode with a history looks at first
    bool png = false, resume = false;
    std::vector<std::string> limits_said;
    std::string unsaved;                  // edits that the scene's files do not have; for hash and header
    std::string plan;                     // why this mode, when it was chosen for the scene; for the header
    std::shared_ptr<const Choice> choice; // of the first frame's candidate, when already made
    std::shared_ptr<const Settings> wanted; // by --mode auto: the settings with the terms its first frame does not need
};

// Whether an error or a time decides how many samples there are.
bool has_goal(const RenderJob& job);

// Whether layers hold the noise of this job's pictures. Then each pixel takes noise_batches batches, and as many
// samples as they divide.
bool measures_noise(const RenderJob& job);

bool wants_layer(const RenderJob& job, std::string_view layer);

struct FrameReport {
    int frame = 0;
    std::string file;
    bool kept = false; // by resume; nothing was rendered, noise and samples are those of the file
    double load_seconds = 0, seconds = 0, write_seconds = 0;
    FrameStats stats;
};

struct RenderReport {
    std::vector<FrameReport> frames; // complete ones, in the order of the job
    std::vector<std::string> notes;
    int missed = 0;         // frames that are further off than the target error
    bool cancelled = false; // stopped early: the frames above are complete, no file is partial
    double seconds = 0;
    uint64_t non_finite = 0, peak_memory_bytes = 0;
};

// A frame of a job, loaded.
struct LoadedFrame {
    Snapshot snapshot;
    double seconds = 0; // it took
};

// Loads a job's first frame, to look at it before the others. What stands still is shared with `previous`, when that
// is a frame of the same scene. Throws Error.
LoadedFrame load_first_frame(const Scene& scene, const RenderJob& job, const Snapshot& previous = {});

// Renders the job's frames; while one renders, the next is loaded and the last is written. `first` may hold the first
// frame; it is not loaded again then. Output names are tested and
// leftovers of killed runs removed before anything else. `progress` runs from 0 to the number of frames. A PNG lies
// beside each EXR, same name. With `resume` a frame is kept when its file decodes to the last pixel, has the wanted
// channels and size, and its `tyndall:hash` equals that of the job. Throws Error; one of a frame names it, and frames
// finished before it are written.
RenderReport render_sequence(const Scene& scene, const RenderJob& job, Progress& progress, std::atomic<bool>& cancel,
                             LoadedFrame first = {});

// As above with a mode that need not be in the table.
RenderReport render_sequence(const Scene& scene, const RenderJob& job, const Mode& mode, Progress& progress,
                             std::atomic<bool>& cancel, LoadedFrame first = {});

// JSON of a report, with a schema version.
std::string stats_json(const RenderReport& report, const RenderJob& job);
}
