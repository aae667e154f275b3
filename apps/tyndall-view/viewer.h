// The viewer: what its state, its rendering and its window do to each other, frame by frame of the interface.
#pragma once
#include "viewer/editing/scene_loader.h"
#include "viewer/painting/render_thread.h"
#include "viewer/state/script_player.h"

namespace tyndall {
struct ViewerOptions {
    ViewState state; // scene_file and all that options decide
    LoadOptions load;
    std::vector<Action> script;
    std::string isa;
    ivec2 window{1280, 800};
    bool stats = false;
};

// Opens a window and runs until it is closed or a script quits. Throws Error: no_display, what a script does wrong, a
// first scene that cannot be read.
void run_viewer(const ViewerOptions& options);
}
