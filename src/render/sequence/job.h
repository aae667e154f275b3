// Rendering frames to files: what is requested and what is decided. The result is a RenderReport.
#pragma once
#include "base/io/file_sequence.h"
#include "modes/settings.h"
#include "render/adaptive/errors/planned_error.h"
#include "render/frame/layers.h"
#include "render/image/exr.h"
#include "render/image/view_transform.h"
#include "scene/load_options.h"
#include "scene/shutter.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
class OutputPaths;
struct CacheFolder;
struct Choice;
struct Mode;
struct Scene;
struct TileFactors;
struct FrameMoments;
struct View;

// The groups of samples in a saved plan, and the requested part of them.
struct Grouping {
    int groups = 0;                              // each with its own scrambling; 0 = samples are not grouped
    int sections = 1;                            // per group
    int leaves = 1;                              // per section, a power of two
    std::shared_ptr<const TileFactors> counts{}; // samples by tile, if the plan fixes them
    std::string plan_hash;
    std::filesystem::path plan_file;
    int part = 0, parts = 0; // counted from 1; 0 = all in a single run
    int more = 0, after = 0; // `more` groups beyond the first `after`, instead of the plan's own
    PlannedError error{};
};
inline bool is_part(const Grouping& grouping) { return grouping.parts > 0; }

// What to render, how, and where to.
struct RenderRequest {
    std::filesystem::path scene_file;
    std::string output; // pattern
    std::vector<int> frames;
    std::string mode = main_mode_name();
    bool mode_open = false; // another mode may be chosen for the scene
    Quality quality = Quality::preview;
    Settings settings;   // quality and --set already applied
    std::string camera;  // empty = the scene's
    ivec2 resolution{0}; // 0 = the scene's
    ivec2 crop_low{0}, crop_high{0};
    uint32_t seed = 0;
    std::string isa;
    MissingFrame missing = MissingFrame::error;
    LightUnits light_units = LightUnits::spec; // how the scene was loaded; for the header
    std::optional<double> exposure{};          // of PNGs, stops; none = the scene's, or measured if it has none
    bool automatic_exposure = false;           // measured even if the scene sets one
    ViewTransform view_transform = ViewTransform::filmic; // of PNGs
    ExrOptions exr;
    double target_error = 0;          // render until the error is below this share of the image's mean; 0 = no target
    double time_budget = 0;           // seconds for each frame, including everything done for it; 0 = no limit
    double started = 0;               // when the budget of the first frame began, by steady_seconds
    int history = 0;                  // earlier frames that a mode with a history processes before each frame
    std::optional<Shutter> shutter{}; // instead of the camera's, whose curve stays if this has none
    int time_samples = 0;             // moments while it is open; 0 = as many as the motion in the image needs
    bool background = true;           // in the image
    bool png = false, resume = false;
    Grouping grouping{};
    double checkpoint_seconds = 600;      // between two checkpoints of a part
    std::shared_ptr<CacheFolder> files{}; // of the plan, if it was prepared
    std::string unsaved;                  // edits not saved in the scene's files; for hash and header
};

// What the frames are rendered with.
struct RenderPlan {
    const Mode* mode = nullptr;
    Settings settings;
    std::string certificate;                // why this mode, if it was chosen for the scene; for the header
    std::shared_ptr<const Choice> choice;   // of the first frame's candidate, if already made
    std::shared_ptr<const Settings> wanted; // --mode auto: the settings with the terms its first frame does not need
    std::optional<OrdersError> orders{};    // of the first frame's multiple scattering, if already measured
    std::optional<double> exposure{};       // of PNGs, if it is measured
    std::shared_ptr<const Choice> main{};   // of the main mode for the first frame, if another mode was chosen
    double main_seconds = infinity;         // predicted for that image
    const Mode* missed = nullptr;           // mode that the main one stands in for, as it missed the target
};

// The requested mode and settings. Throws Error (usage) for a mode that is not in the table.
RenderPlan requested_plan(const RenderRequest& request);

// Whether a target error or a time budget decides the number of samples.
bool has_goal(const RenderRequest& request);

// Whether layers for the images' noise are requested. Pixels then take noise_batches batches, and a multiple of that
// number of samples.
bool measures_noise(const RenderRequest& request);

// Removes from the request the light layers that neither the scene nor the plan has, and returns them.
std::vector<std::string> drop_absent_layers(const Scene& scene, const RenderPlan& plan, RenderRequest& request);

bool wants_layer(const RenderRequest& request, std::string_view layer);

// The shutter of the requested camera.
Shutter shutter_of(const Scene& scene, const RenderRequest& request);

// The frame that a history sees `back` frames before one: none is before the scene's first.
int frame_before(const Scene& scene, int frame, int back);

// The shutter moments of a frame. Throws Error for a camera that is not in the scene.
FrameMoments moments_of(const Scene& scene, const RenderRequest& request, int frame);

// The largest number of moments that a frame may be given for the sake of its target error; 0 = it keeps those it has.
int moment_limit(const Scene& scene, const RenderRequest& request, int frame);

// A frame as the camera sees it. Throws Error for a camera that is not in the scene.
View view_of(const Scene& scene, const RenderRequest& request, const Settings& settings, int frame);

inline std::filesystem::path png_name(const std::string& exr) {
    return std::filesystem::path(exr).replace_extension(".png");
}

// Checks that the frames, and their PNGs, can be written and are not files of the scene, and removes leftovers of
// killed runs. Throws Error (usage, unwritable).
void check_outputs(const Scene& scene, const RenderRequest& request, OutputPaths& places);

// Checks all that can be wrong with a request: image size, layers, the target error, outputs. Throws Error (usage,
// unwritable).
void check_job(const Scene& scene, const RenderRequest& request, const Mode& mode, OutputPaths& places);
}
