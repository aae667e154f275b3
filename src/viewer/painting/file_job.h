// Work that writes files while the viewer goes on: frames as tyndall render makes them, fog as tyndall bake does.
#pragma once
#include "base/error.h"
#include "base/io/progress.h"
#include "render/sequence/job.h"
#include "viewer/state/view_state.h"
#include "volume/recipe/recipe.h"

#include <variant>

namespace tyndall {
struct RenderFiles {
    std::shared_ptr<const Scene> scene; // the request's own, with the edits of the moment it was asked for
    RenderRequest request;
};

struct BakeFiles {
    FogRecipe recipe;
    std::string output; // pattern
    std::vector<int> frames;
};

using FileJob = std::variant<RenderFiles, BakeFiles>;

// The frames of a range, the scene's when it is empty, as the state shows them; those that are already there and right
// are kept. Throws Error (usage: before the first scene, of range and pattern).
RenderRequest sequence_request(const ViewState& state, const std::string& output, const std::string& range, bool png,
                               const std::string& isa);

// With a scene of its own, and with the camera moved by hand as one of that.
RenderFiles render_files(const ViewState& state, RenderRequest request);

// The fog of a medium that is grown from a recipe, with its edits; its optics, for the files' metadata, are those of
// the first frame. Throws Error (usage).
BakeFiles bake_files(const ViewState& state, const std::string& medium, const std::string& output,
                     const std::string& range);

// Names of the media that can be baked.
std::vector<std::string> bakeable_media(const Scene& scene);

// The command line that does the same. Throws Error (usage) when the scene's files do not have what is shown.
std::string command_of(const ViewState& state, RenderRequest request);

// How a job ended.
struct JobResult {
    std::string message;
    ExitCode code = ExitCode::ok;
};

// "render out.####.exr", and how many frames.
std::string name_of(const FileJob& job);
int frame_count(const FileJob& job);

// Does it; no file is ever partial, and an error is a result. `progress` runs to frame_count().
JobResult run_job(const FileJob& job, Progress& progress, std::atomic<bool>& cancel);

// scene.march.####.exr, fog.####.vdb
std::string usual_sequence_name(const ViewState& state);
std::string usual_bake_name(const std::string& medium);
}
