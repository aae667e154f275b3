// All that the viewer shows and edits, and how actions change it. The window only draws this and passes actions on.
#pragma once
#include "modes/settings.h"
#include "viewer/editing/scene_edit.h"
#include "viewer/painting/request.h"
#include "viewer/state/action.h"
#include "viewer/state/camera_control.h"

#include <optional>

namespace tyndall {
struct EditableParts;
struct LoadedScene;
struct Scene;
struct SceneSession;

// How far a job is that writes files.
struct JobStatus {
    std::string name; // "render out.####.exr"
    int frames = 1;
    double share = 0, seconds_left = -1; // negative: not known yet
    bool stopping = false;
};

struct ViewState {
    std::filesystem::path scene_file; // asked for last
    int loads = 0;                    // times a scene was asked for
    bool loading = false;
    bool reloading = false; // the scene shown, as its files are now: unsaved edits stay

    std::shared_ptr<SceneSession> session;      // null until the first scene is there
    std::shared_ptr<const Scene> scene;         // the session's, as edited
    std::shared_ptr<Scene> stage;               // what is rendered: the render thread's own, without the edits ...
    std::shared_ptr<const EditableParts> parts; // ... and they

    std::string mode = main_mode_name(), stand_in = interactive_mode_name(), beside;
    Quality quality = Quality::preview;
    Settings settings = settings_for(Quality::preview);
    uint32_t seed = 0;
    MissingFrame missing = MissingFrame::error;
    ivec2 size{0}; // 0 = the scene's
    int max_samples = 64;
    double wanted_rate = 30;        // quick pictures per second
    Shown shown;                    // with the exposure set by hand, if one is
    bool automatic = false;         // the exposure is measured, whatever the scene states
    std::optional<double> measured; // exposure, once it is known
    int measures = 0;               // times that was asked for

    double zoom = 0; // pixels of the window for one of the picture; 0 = as large as it fits
    vec2 zoom_at{0}; // the picture's pixel in the middle then

    std::optional<ivec2> explain; // a pixel whose ray is asked about
    bool volume_shown = false;    // and a medium:
    VolumeQuestion volume;

    std::string camera; // of the scene; empty = its own choice
    bool free = false;  // the camera was moved by hand: `view` holds
    Viewpoint view;

    int frame = 1;
    bool playing = false, loop = true;
    int frames_to_play = 0;   // then it stops; 0 = on and on
    double next_frame_at = 0; // seconds of the clock, while playing
    std::vector<int> gaps;    // frames for which volume files are missing

    bool panels = true, help = false;
    bool lights_tab = false;      // what the side shows: lights and fog, or rendering
    bool handles = true;          // lights are drawn in the picture while the side shows them
    std::optional<JobStatus> job; // that runs
    std::optional<Action> asked;  // would lose edits or end a job: waits for an answer
    bool leaving = false;         // the window is to close
    Thing selected;               // its properties are shown; may be beyond the end
    std::string file_error;       // why the scene's files, as they are now, cannot be read
    std::string message;          // the last thing that went wrong, or was done
    bool message_is_error = false;

    uint64_t revision = 1, shown_revision = 1, motions = 0; // motions: changes that more are likely to follow
};

// Does an action; false when it is one for the window (key, drag, wait, files, quit). Throws Error.
bool apply(ViewState& state, const Action& action);

// Throws Error (usage) before the first one.
const Scene& loaded_scene(const ViewState& state);

// A scene has been loaded: camera and time stay when it is the same file, and unsaved edits as well when it was read
// again by itself; the message tells which of them were lost. Throws Error (usage) when the first one lacks the camera.
void take_scene(ViewState& state, LoadedScene loaded);

// Whether there is one at this frame: a camera may look nowhere there.
bool has_camera(const ViewState& state);

// The camera pictures are made with, and the point before it, for which all of the scene may have to be looked at.
Camera camera_now(const ViewState& state);
Viewpoint viewpoint(const ViewState& state);

// Where the camera is when it was moved by hand: what a scene file says of such a camera.
std::string camera_json(const Viewpoint& view);

// While playing: on to the next frame when the picture of this one is there and its time is over.
void advance(ViewState& state, double now, uint64_t shown_revision);

// The frame that playing shows after this one; nothing when it ends here.
std::optional<int> next_frame(const ViewState& state);

// Whether the exposure is the scene's: one is stated, and nobody has set another.
bool shows_scene_exposure(const ViewState& state);

// In stops; nothing while it is not measured yet. Needs a scene.
std::optional<double> exposure_now(const ViewState& state);

// An exposure that is measured is another one from now on.
inline void measure_again(ViewState& state) { state.measured.reset(), ++state.measures; }

// What to render. Needs a scene.
Request request_of(const ViewState& state, bool moving);

// What a key does; nothing for keys without a meaning. Keys: 1..9, a..z, space, left, right, home, tab, f1, f5, [ and
// ]; with "ctrl+" and "shift+" before, in this order.
std::optional<Action> action_of_key(const ViewState& state, std::string_view key);

struct KeyInfo {
    std::string_view keys, doc;
};
const std::vector<KeyInfo>& key_list();

// scene.march.0001.exr
std::string usual_file_name(const ViewState& state);
}
