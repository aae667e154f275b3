// The side's page for lights and fog: what there is, what the selected one is like, undo and saving.
#pragma once
#include "panels.h"
#include <imgui.h>

namespace tyndall {
void draw_lights(const ViewState& state, EditMemory& memory, const Act& act);

// Whether a file is there that would be written over.
bool is_taken(const std::filesystem::path& file);

// A name to save the scene as, for each scene once.
void propose_name(const ViewState& state, EditMemory& memory);

// The two pages of the side.
void draw_tabs(const ViewState& state, const Act& act);

ImVec4 shown_color(vec3 linear); // as bright as a screen can show it
}
