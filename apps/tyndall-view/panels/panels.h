// The panels: what they draw, and the actions they issue.
#pragma once
#include "../edit_state.h"
#include "viewer/painting/ray_question.h"
#include "viewer/painting/shown_picture.h"
#include "viewer/state/view_state.h"

#include <functional>
#include <imgui.h>

namespace tyndall {
// What the panels show besides the state.
struct PanelResources {
    std::shared_ptr<const ShownPicture> picture; // newest that has pixels; null before the first
    std::vector<LimitationGroup> limitations;    // of the mode, once they are known
    std::shared_ptr<const RayAnswer> ray;        // newest; kept while the view moves
    double saving = -1;                          // fraction written of the file being saved; negative: none
    std::string news;                            // of background work
    bool news_is_error = false;
    std::shared_ptr<const VolumePicture> volume; // newest; kept while the view moves
    void *texture = nullptr, *volume_texture = nullptr;
};

// A file name: the default until the user edits it.
struct FileField {
    std::string name;
    bool edited = false;
};

// Fields of the files panel.
struct FilesState {
    std::filesystem::path scene; // that the other fields belong to
    FileField other, picture, sequence, fog;
    std::string frames, fog_frames; // empty = all of the scene's
    std::string medium;             // to bake
    bool pngs = true;
};

// State that the panels keep from one interface frame to the next.
struct PanelState {
    std::string held_row; // setting that was reset by a double-click; ignores its slider until the mouse is up
    FilesState files;
    EditState edits;
};

using Act = std::function<void(const Action&)>; // does an action; errors become the state's message

void draw_interface(ViewState& state, const PanelResources& resources, PanelState& memory, const Act& act);

// The "Rendering" page of the side panel.
void draw_rendering(ViewState& state, const PanelResources& resources, PanelState& memory, const Act& act);

// The timeline and its playback controls.
void draw_time(const ViewState& state, const Act& act);

// Files to open and to write, and the progress of the job that writes some.
void draw_files(const ViewState& state, FilesState& memory, const Act& act);
void draw_job(const JobStatus& job, const Act& act);

// The technique's own settings and those it shares, as sliders.
void draw_settings(ViewState& state, PanelState& memory, const Act& act);

// Asks before unsaved edits are lost or a job is ended.
void draw_question(const ViewState& state, const PanelResources& resources, EditState& edits, const Act& act);

// The image with its status line.
void draw_picture(ViewState& state, const PanelResources& resources, EditState& edits, const Act& act);

// Explains the ray of a pixel, in the remaining space of the current window: curves on the left, the techniques'
// results on the right.
void draw_ray(const ViewState& state, const RayAnswer* answer, const Act& act);

// A medium's density and grid, in the remaining space of the current window: image and scale on the left, controls and
// facts on the right.
void draw_volume(const ViewState& state, const PanelResources& resources, const Act& act);

// The inspector, a strip below the image, and its height; 0 when it is closed.
float inspector_height(const ViewState& state, float whole);
void draw_inspector(ViewState& state, const PanelResources& resources, const Act& act);

// The side panel's page for lights and fog: a list, the selected one's properties, undo and saving.
void draw_lights(const ViewState& state, EditState& edits, const Act& act);

// Whether the file exists and would be overwritten.
bool is_taken(const std::filesystem::path& file);

// Proposes a name to save the scene as, once per scene file.
void propose_name(const ViewState& state, EditState& edits);

// Buttons that switch between the two pages of the side panel.
void draw_tabs(const ViewState& state, const Act& act);

ImVec4 shown_color(vec3 linear); // sRGB-encoded; brighter than 1 is scaled to 1
}
