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

void add_render_options(const Command& command, RenderOptions& args);
// Adds the options that a saved plan stores, except scene and mode.
void add_planned_options(const Command& command, RenderOptions& args);

// The mode and those options that differ from their defaults, as words of a command line.
std::vector<std::string> planned_words(const RenderOptions& args);

// The modes named by an option: one name, several separated by commas, or all. Throws Error (usage).
std::vector<const Mode*> modes_option(std::string_view option, const std::string& text);

// The request that the command line alone makes. Throws Error (usage) before any file is touched.
RenderRequest make_request(const RenderOptions& args, const Mode& mode);
LoadOptions load_options(const RenderOptions& args);

// The request that --plan and the options beside it make. Throws Error (usage) for an option that the plan fixes.
RenderRequest planned_request(const RenderOptions& args, SavedPlan& plan);
void check_crop(const RenderRequest& request, ivec2 picture);
}
