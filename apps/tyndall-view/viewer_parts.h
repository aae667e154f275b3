// The parts of the viewer, and what hands and scripts do to them.
#pragma once
#include "interface_times.h"
#include "panels/panels.h"
#include "viewer.h"
#include "viewer/painting/job_thread.h"
#include "window.h"

namespace tyndall {
// A drag of a script, point by point.
struct Drag {
    vec2 from{0}, to{0};
    int frame = -1; // negative: there is none
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
    uint64_t picture_revision = 0; // of the newest answer, with or without a picture
    bool new_picture = false, new_volume = false;
    PanelMemory memory;
    ScriptPlayer script;
    ScriptedInput scripted;
    int key_frames = 0; // until a script's key is up again
    Drag drag;
    std::string script_place; // of the action being done
    std::string screenshot;   // to take after this frame
    std::string file_place;   // of the snapshot being written for a script
    std::string job_place;    // of its job
    int files_to_come = 0;
    bool quit = false;
    InterfaceTimes times;
    JobThread jobs;
    RenderThread thread; // ends before all else

    explicit Viewer(const ViewerOptions& given)
        : options(given), window("Tyndall", given.window), state(given.state), jobs(Window::wake),
          thread(Window::wake) {}
};

void tell(Viewer& viewer, const std::string& message, bool is_error); // until the next action

// What came about by itself: it stays long enough to be read.
void announce(Viewer& viewer, const std::string& news, bool is_error);

// Whether more changes are likely at once.
bool is_moving(const Viewer& viewer);

// Does an action of hands: what goes wrong is said in the window.
void act(Viewer& viewer, const Action& action);

// Does the script's next actions, until one takes time. Throws Error naming file and line.
void follow_script(Viewer& viewer);

// The mouse of a script's drag: there, down, along, up.
void move_scripted_mouse(Viewer& viewer);

// Keys and mouse of this frame, once it has begun.
void read_input(Viewer& viewer);
}
