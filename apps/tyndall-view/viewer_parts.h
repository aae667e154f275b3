// The parts of the viewer, and how input from the user and scripts acts on them.
#pragma once
#include "interface_times.h"
#include "panels/panels.h"
#include "viewer.h"
#include "viewer/painting/job_thread.h"
#include "window.h"

namespace tyndall {
// A mouse drag by a script, advanced once per interface frame.
struct Drag {
    vec2 from{0}, to{0};
    int frame = -1; // negative: no drag
};

struct Viewer {
    const ViewerOptions& options;
    Window window;
    ViewState state;
    SceneLoader loader;
    std::string title;
    double watched_at = 0, started = 0, moved_at = -1e9, input_at = -1e9, now = 0, frame_seconds = 0;
    double news_until = 0;
    int loads_begun = 0;
    uint64_t motions_seen = 0, posted = 0, posted_shown = 0;
    bool posted_moving = false;
    PanelResources resources;
    uint64_t picture_revision = 0; // of the render thread's newest answer, with or without an image
    bool new_picture = false, new_volume = false;
    PanelState memory;
    ScriptPlayer script;
    ScriptedInput scripted;
    int key_frames = 0; // interface frames until a script's key is released
    Drag drag;
    std::string script_line; // line of the current action in its script
    std::string screenshot;  // file of a screenshot to take after this frame
    std::string save_line;   // script line of the snapshot being written
    std::string job_line;    // script line of the running job
    int pending_saves = 0;
    bool quit = false;
    InterfaceTimes times;
    JobThread jobs;
    RenderThread thread; // declared last: destroyed first

    explicit Viewer(const ViewerOptions& given)
        : options(given), window("Tyndall", given.window), state(given.state), jobs(Window::wake),
          thread(Window::wake) {}
};

void set_message(Viewer& viewer, const std::string& message, bool is_error); // shown until the next action

// Shows news of background work for long enough to be read.
void announce(Viewer& viewer, const std::string& news, bool is_error);

// Whether the view is playing or has just moved, so that quick images are wanted.
bool is_moving(const Viewer& viewer);

// Performs a user's action; errors are shown in the window.
void act(Viewer& viewer, const Action& action);

// Performs the script's next actions until one has to wait. Throws Error naming file and line.
void follow_script(Viewer& viewer);

// Advances a script's drag by one frame: move to its start, press, move along, release.
void move_scripted_mouse(Viewer& viewer);

// Handles this frame's keys and mouse; call after Window::begin_frame().
void read_input(Viewer& viewer);
}
