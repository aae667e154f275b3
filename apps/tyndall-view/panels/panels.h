// What is drawn, and the actions that come of it.
#pragma once
#include "../edit_memory.h"
#include "viewer/painting/ray_question.h"
#include "viewer/painting/shown_picture.h"
#include "viewer/state/view_state.h"

#include <functional>
#include <imgui.h>

namespace tyndall {
// What the panels show besides the state.
struct PanelResources {
    std::shared_ptr<const ShownPicture> picture; // newest with codes; null before the first
    std::vector<LimitationGroup> limitations;    // of the mode, as far as they are known
    std::shared_ptr<const RayAnswer> ray;        // newest; stays while things move
    double saving = -1;                          // share of a file that is being written
    std::string news;                            // of work that goes on beside the interface
    bool news_is_error = false;
    std::shared_ptr<const VolumePicture> volume; // the same
    void *texture = nullptr, *volume_texture = nullptr;
    double seconds = 0; // since the last interface frame
};

// The name of a file: the usual one until it is typed over.
struct FileField {
    std::string name;
    bool edited = false;
};

// What is to be opened or written.
struct FilesMemory {
    std::filesystem::path scene; // that the rest is about
    FileField other, picture, sequence, fog;
    std::string frames, fog_frames; // empty = all of the scene's
    std::string medium;             // to bake
    bool pngs = true;
};

// What panels remember by themselves.
struct PanelMemory {
    std::string held_row; // a setting that was put back; its slider is dead until the mouse is up
    FilesMemory files;
    EditMemory edits;
};

using Act = std::function<void(const Action&)>; // does an action; errors become the state's message

void draw_interface(ViewState& state, const PanelResources& resources, PanelMemory& memory, const Act& act);

// The page "Rendering" of the side.
void draw_rendering(ViewState& state, const PanelResources& resources, PanelMemory& memory, const Act& act);

// Frames and playing.
void draw_time(const ViewState& state, const Act& act);

// Files to open and to write, and the job that writes some.
void draw_files(const ViewState& state, FilesMemory& memory, const Act& act);
void draw_job(const JobStatus& job, const Act& act);

// The technique's own settings and those it shares, as sliders.
void draw_settings(ViewState& state, PanelMemory& memory, const Act& act);

// Mode, size, samples, time and what the mode gets wrong, as one line.
std::string status_line(const ViewState& state, const ShownPicture& picture);

// The question that comes before unsaved edits would be lost or a job ended.
void draw_question(const ViewState& state, const PanelResources& resources, EditMemory& memory, const Act& act);

// The picture with its line of status.
void draw_picture(ViewState& state, const PanelResources& resources, EditMemory& edits, const Act& act);

// What happens on the ray of a pixel, in the space that is left of the current window: curves on the left, the
// techniques' answers on the right.
void draw_ray(const ViewState& state, const RayAnswer* answer, const Act& act);

// A medium's density and its grid, in the space that is left of the current window: picture and scale on the left,
// controls and facts on the right.
void draw_volume(const ViewState& state, const PanelResources& resources, const Act& act);

// The strip below the picture: what is looked into. Its height; 0 when that is nothing.
float inspector_height(const ViewState& state, float whole);
void draw_inspector(ViewState& state, const PanelResources& resources, const Act& act);

// The side's page for lights and fog: what there is, what the selected one is like, undo and saving.
void draw_lights(const ViewState& state, EditMemory& memory, const Act& act);

// Whether a file is there that would be written over.
bool is_taken(const std::filesystem::path& file);

// A name to save the scene as, for each scene once.
void propose_name(const ViewState& state, EditMemory& memory);

// The two pages of the side.
void draw_tabs(const ViewState& state, const Act& act);

ImVec4 shown_color(vec3 linear); // as bright as a screen can show it
}
