// What is drawn, and the actions that come of it.
#pragma once
#include "edit_memory.h"
#include "preview/render_thread.h"
#include "preview/view_state.h"

#include <functional>

namespace tyndall {
// What the panels show besides the state.
struct Shelf {
    std::shared_ptr<const ShownPicture> picture; // newest with codes; null before the first
    std::vector<Limit> limits;                   // of the mode, as far as they are known
    std::shared_ptr<const RayAnswer> ray;        // newest; stays while things move
    double saving = -1;                          // share of a file that is being written
    std::shared_ptr<const VolumePicture> volume; // the same
    void *texture = nullptr, *volume_texture = nullptr;
    double seconds = 0; // since the last interface frame
};

// What panels remember by themselves.
struct PanelMemory {
    std::string held_row;  // a setting that was put back; its slider is dead until the mouse is up
    std::string file_name; // to write
    bool file_name_edited = false;
    EditMemory edits;
};

using Act = std::function<void(const Action&)>; // does an action; errors become the state's message

void draw_interface(ViewState& state, const Shelf& shelf, PanelMemory& memory, const Act& act);

// The page "Rendering" of the side.
void draw_rendering(ViewState& state, const Shelf& shelf, PanelMemory& memory, const Act& act);

// Frames and playing.
void draw_time(const ViewState& state, const Act& act);

// The technique's own settings and those it shares, as sliders.
void draw_settings(ViewState& state, PanelMemory& memory, const Act& act);

// Mode, size, samples, time and what the mode gets wrong, as one line.
std::string status_line(const ViewState& state, const ShownPicture& picture);
}
