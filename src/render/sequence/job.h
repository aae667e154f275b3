// Frames to be rendered to files: what is asked for, and what is decided for it. What comes out is a RenderReport.
#pragma once
#include "base/io/file_sequence.h"
#include "modes/settings.h"
#include "render/adaptive/planned_error.h"
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
struct CacheFolder;
struct Choice;
struct Mode;
struct Scene;
struct TileFactors;
struct FrameMoments;
struct View;

// Samples in groups, as a saved plan has them, and the part of them that is wanted.
struct Grouping {
    int groups = 0;                              // each scrambled by itself; 0 = samples come in no groups
    int sections = 1;                            // of a group
    int leaves = 1;                              // of a section, a power of two
    std::shared_ptr<const TileFactors> counts{}; // of samples, where the plan tells them for every tile
    std::string plan_hash;
    std::filesystem::path plan_file;
    int part = 0, parts = 0; // counted from 1; 0 = all of them in one run
    int more = 0, after = 0; // so many groups beyond the first so many, instead of the plan's own
    PlannedError error{};
};
inline bool is_part(const Grouping& grouping) { return grouping.parts > 0; }

// What is asked for: of what, how, and where to.
struct RenderRequest {
    std::filesystem::path scene_file;
    std::string output; // pattern
    std::vector<int> frames;
    std::string mode = main_mode_name();
    Quality quality = Quality::preview;
    Settings settings;   // quality and --set already applied
    std::string camera;  // empty = the scene's
    ivec2 resolution{0}; // 0 = the scene's
    ivec2 crop_low{0}, crop_high{0};
    uint32_t seed = 0;
    std::string isa;
    MissingFrame missing = MissingFrame::error;
    LightUnits light_units = LightUnits::spec; // how the scene was loaded; for the header
    std::optional<double> exposure{};          // stops, of PNGs; none = the scene's, or measured where it states none
    bool automatic_exposure = false;           // measured, whatever the scene states
    ViewTransform view_transform = ViewTransform::filmic; // of PNGs
    ExrOptions exr;
    double target_error = 0; // render until the error is below this share of the picture's mean; 0 = none is asked for
    double time_budget = 0;  // seconds for each frame, all that is done for it counted; 0 = as many as it takes
    double started = 0;      // by steady_seconds, when the budget of the first frame began
    int history = 0;         // frames before each that a mode with a history looks at first
    std::optional<Shutter> shutter{}; // instead of the camera's; without a curve the camera's goes on
    int time_samples = 0;             // moments while it is open; 0 = as many as the motion on the picture needs
    bool background = true;           // in the picture
    bool png = false, resume = false;
    Grouping grouping{};
    double checkpoint_seconds = 600;      // of a part, between two
    std::shared_ptr<CacheFolder> files{}; // of the plan, where it was prepared
    std::string unsaved;                  // edits that the scene's files do not have; for hash and header
};

// What is decided: by what the frames are rendered.
struct RenderPlan {
    const Mode* mode = nullptr;
    Settings settings;
    std::string certificate;                // why this mode, when it was chosen for the scene; for the header
    std::shared_ptr<const Choice> choice;   // of the first frame's candidate, when already made
    std::shared_ptr<const Settings> wanted; // by --mode auto: the settings with the terms its first frame does not need
    std::optional<OrdersError> orders{};    // of the first frame's multiple scattering, when already measured
    std::optional<double> exposure{};       // of PNGs, where it is measured
    std::shared_ptr<const Choice> main{};   // of the main mode for the first frame, where another one was chosen
};

// The mode and the settings asked for. Throws Error (usage) for a mode that is not in the table.
RenderPlan plan_as_asked(const RenderRequest& request);

// Whether an error or a time decides how many samples there are.
bool has_goal(const RenderRequest& request);

// Whether layers hold the noise of the pictures. Then each pixel takes noise_batches batches, and as many
// samples as they divide.
bool measures_noise(const RenderRequest& request);

// Takes out of the request the layers of light that neither the scene nor the plan has, and returns them.
std::vector<std::string> drop_absent_layers(const Scene& scene, const RenderPlan& plan, RenderRequest& request);

bool wants_layer(const RenderRequest& request, std::string_view layer);

// The shutter of the camera asked for.
Shutter shutter_of(const Scene& scene, const RenderRequest& request);

// The moments that a frame shows. Throws Error for a camera that is not in the scene.
FrameMoments moments_of(const Scene& scene, const RenderRequest& request, int frame);

// A frame as the camera sees it. Throws Error for a camera that is not in the scene.
View view_of(const Scene& scene, const RenderRequest& request, const Settings& settings, int frame);

inline std::filesystem::path png_name(const std::string& exr) {
    return std::filesystem::path(exr).replace_extension(".png");
}

// Tests picture size, layers, names, directories and the target error, and removes leftovers of killed runs. Nothing
// that was read may be written over. Throws Error (usage, unwritable).
void check_job(const Scene& scene, const RenderRequest& request, const Mode& mode);
}
