// The viewer: connects state, rendering and window once per interface frame.
#pragma once
#include "viewer/editing/scene_loader.h"
#include "viewer/painting/render_thread.h"
#include "viewer/state/script_player.h"

namespace tyndall {
struct ViewerOptions {
    ViewState state; // scene_file, and what command-line options set
    LoadOptions load;
    std::vector<Action> script;
    std::string isa;
    ivec2 window{1280, 800};
    bool stats = false;
};

// Opens a window and runs until it is closed or a script quits. Throws Error: no_display, an error in a script, or a
// first scene that cannot be read.
void run_viewer(const ViewerOptions& options);
}
