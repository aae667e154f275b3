// What tyndall plan --save and tyndall submit share.
#pragma once
#include "rendering/render_options.h"

namespace tyndall {
void add_groups_option(const Command& command, std::string& groups);

// Throws Error (usage) for options that no saved plan takes.
void check_for_plan(const RenderOptions& render, const std::string& groups);

// Saves a plan for the mode that is named; returns the exit code. Throws Error.
int save_plan_as_asked(const RenderOptions& render, const std::string& groups, const std::string& file,
                       const Globals& globals);
}
