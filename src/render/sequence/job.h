// Frames to be rendered to files: of what, how, and where to.
#pragma once
#include "modes/limitation.h"
#include "modes/settings.h"
#include "render/image/exr.h"
#include "scene/load_options.h"
#include "volume/vdb/sequence.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
struct Choice;

struct RenderJob {
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
    float exposure = 0;                        // added to the scene's, for PNGs
    ExrOptions exr;
    double target_error = 0; // render until the error is below this share of the picture's mean; 0 = none is asked for
    double time_budget = 0;  // seconds for each frame, loading and writing apart; 0 = as many as it takes
    int history = 0;         // frames before each that a mode with a history looks at first
    bool png = false, resume = false;
    Limitations limitations;                // of the mode, in the first frame
    std::string unsaved;                    // edits that the scene's files do not have; for hash and header
    std::string plan;                       // why this mode, when it was chosen for the scene; for the header
    std::shared_ptr<const Choice> choice;   // of the first frame's candidate, when already made
    std::shared_ptr<const Settings> wanted; // by --mode auto: the settings with the terms its first frame does not need
};

// Whether an error or a time decides how many samples there are.
bool has_goal(const RenderJob& job);

// Whether layers hold the noise of this job's pictures. Then each pixel takes noise_batches batches, and as many
// samples as they divide.
bool measures_noise(const RenderJob& job);

bool wants_layer(const RenderJob& job, std::string_view layer);
}
