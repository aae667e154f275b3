// Background jobs that write files: frames like those of tyndall render, volumes like those of tyndall bake.
#pragma once
#include "base/error.h"
#include "base/io/progress.h"
#include "render/sequence/job.h"
#include "viewer/state/view_state.h"
#include "volume/recipe/recipe.h"

#include <variant>

namespace tyndall {
struct RenderJob {
    std::shared_ptr<const Scene> scene; // a copy for this request, with the edits at the time of asking
    RenderRequest request;
};

struct BakeJob {
    FogRecipe recipe;
    std::string output; // pattern
    std::vector<int> frames;
};

using FileJob = std::variant<RenderJob, BakeJob>;

// The request that renders the frames of a range (empty: the scene's) as the state shows them; files that exist and are
// up to date are kept. Throws Error (usage: no scene is loaded, or the range or pattern is wrong).
RenderRequest sequence_request(const ViewState& state, const std::string& output, const std::string& range, bool png,
                               const std::string& isa);

// The job of a request, with a copy of the scene to which a camera moved by hand is added.
RenderJob render_job(const ViewState& state, RenderRequest request);

// The job that bakes a medium made from a recipe, with its edits; the optics in the files' metadata are those of the
// first frame. Throws Error (usage).
BakeJob bake_job(const ViewState& state, const std::string& medium, const std::string& output,
                 const std::string& range);

// Names of the media that can be baked.
std::vector<std::string> bakeable_media(const Scene& scene);

// The command line that does the same. Throws Error (usage) if the scene's files do not contain what is shown.
std::string command_of(const ViewState& state, RenderRequest request);

// How a job ended.
struct JobResult {
    std::string message;
    ExitCode code = ExitCode::ok;
};

// "render out.####.exr", and the number of frames.
std::string name_of(const FileJob& job);
int frame_count(const FileJob& job);

// Runs a job; no file is ever partial, and an error is returned as a result. `progress` runs to frame_count().
JobResult run_job(const FileJob& job, Progress& progress, std::atomic<bool>& cancel);

// Default names of outputs: scene.march.####.exr, fog.####.vdb.
std::string default_sequence_name(const ViewState& state);
std::string default_bake_name(const std::string& medium);
}
