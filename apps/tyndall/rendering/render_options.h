// The command line of tyndall render, as text and as a request.
#pragma once
#include "common.h"
#include "modes/settings.h"
#include "render/sequence/job.h"

namespace tyndall {
struct Mode;
struct SavedPlan;
struct RenderOptions {
    std::string scene, output, frames, mode = main_mode_name(), quality = "preview", camera, resolution, crop, samples;
    std::string exposure, view_transform, light_units = "spec", missing = "error", aov, seed, isa = "auto", stats;
    std::string orders, target_error, time_budget, history, shutter, time_samples, background = "on", sheet_reference;
    std::string plan, part, more, checkpoint, cache_local, order = "listed";
    std::vector<std::string> settings;
    bool png = false, resume = false, full_float = false;
};

void add_render_options(const Command& command, RenderOptions& texts);
// Those that a saved plan decides, but scene and mode.
void add_planned_options(const Command& command, RenderOptions& texts);

// Those again as words of a command line, with the mode, as far as they were given.
std::vector<std::string> planned_words(const RenderOptions& texts);

// The modes of an option: a name, several with commas between, or all. Throws Error (usage).
std::vector<const Mode*> asked_modes(std::string_view option, const std::string& text);

// Everything the command line alone decides; throws Error (usage) before any file is touched.
RenderRequest make_request(const RenderOptions& texts, const Mode& mode);
LoadOptions load_options(const RenderOptions& texts);

// What --plan and the options beside it ask for. Throws Error (usage) for one that the plan has decided.
RenderRequest planned_request(const RenderOptions& texts, SavedPlan& plan);
void check_crop(const RenderRequest& request, ivec2 picture);
}
