// The whole state of the viewer, and how actions change it. The window only draws it and passes on actions.
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

// Progress of a job that writes files.
struct JobStatus {
    std::string name; // "render out.####.exr"
    int frames = 1;
    double share = 0, seconds_left = -1; // negative: not known yet
    bool stopping = false;
};

struct ViewState {
    std::filesystem::path scene_file; // the one requested last
    int loads = 0;                    // number of requests to load a scene
    bool loading = false;
    bool reloading = false; // the same scene is read again: unsaved edits stay

    std::shared_ptr<SceneSession> session;      // null until the first scene is there
    std::shared_ptr<const Scene> scene;         // the session's, as edited
    std::shared_ptr<Scene> render_copy;         // what is rendered: the render thread's copy, without the edits ...
    std::shared_ptr<const EditableParts> parts; // ... which are here

    std::string mode = main_mode_name(), stand_in = interactive_mode_name(), beside;
    Quality quality = Quality::preview;
    Settings settings = settings_for(Quality::preview);
    uint32_t seed = 0;
    MissingFrame missing = MissingFrame::error;
    ivec2 size{0}; // 0 = the scene's
    int max_samples = 64;
    double wanted_rate = 30;        // quick images per second
    DisplayOptions shown;           // with the exposure set by hand, if any
    bool automatic = false;         // the exposure is measured even if the scene states one
    std::optional<double> measured; // exposure, once it is known
    int metering_id = 0;            // number of requests to measure it

    double zoom = 0; // window pixels per image pixel; 0 = fit the window
    vec2 zoom_at{0}; // the image pixel at the center when zoomed

    std::optional<ivec2> explain; // a pixel whose ray is to be explained
    bool volume_shown = false;    // whether a medium is shown:
    VolumeRequest volume;

    std::string camera;       // of the scene; empty = its default
    bool free_camera = false; // the camera was moved by hand: `view` applies
    Viewpoint view;

    int frame = 1;
    bool playing = false, loop = true;
    int frames_to_play = 0;   // until playing stops; 0 = endless
    double next_frame_at = 0; // seconds of the clock, while playing
    std::vector<int> gaps;    // frames for which volume files are missing

    bool panels = true, help = false;
    bool lights_tab = false;      // what the side panel shows: lights and fog, or rendering
    bool handles = true;          // lights are drawn in the image while the side panel shows them
    std::optional<JobStatus> job; // the one that is running
    std::optional<Action> asked;  // would lose edits or end a job, and waits for an answer
    bool closing = false;         // the window is to close
    PartRef selected;             // its properties are shown; may be beyond the end
    std::string file_error;       // why the scene's files, as they are now, cannot be read
    std::string message;          // the last thing that went wrong, or was done
    bool message_is_error = false;

    uint64_t revision = 1, shown_revision = 1, motions = 0; // motions: changes after which more are likely
};

// Applies an action; false if it is one for the window (key, drag, wait, files, quit). Throws Error.
bool apply(ViewState& state, const Action& action);

// The scene shown. Throws Error (usage) before the first one is loaded.
const Scene& loaded_scene(const ViewState& state);

// Takes a loaded scene: camera and time stay if it is the same file. After a reload, unsaved edits stay as well, and
// the message lists those that were lost. Throws Error (usage) if the first scene lacks the camera.
void take_scene(ViewState& state, LoadedScene loaded);

// Whether the camera is valid at this frame: an animated one may have no direction to look in.
bool has_camera(const ViewState& state);

// The camera that images are rendered with, and its viewpoint, which may require the bounds of the whole scene.
Camera camera_now(const ViewState& state);
Viewpoint viewpoint(const ViewState& state);

// The scene file entry of a camera moved by hand.
std::string camera_json(const Viewpoint& view);

// While playing, goes on to the next frame once the image of this one is shown and its time is over.
void advance(ViewState& state, double now, uint64_t shown_revision);

// The frame that follows this one in playback; empty if playback ends here.
std::optional<int> next_frame(const ViewState& state);

// Whether the scene's exposure is used: it states one, and no other was set.
bool shows_scene_exposure(const ViewState& state);

// In stops; empty until it is measured. Needs a scene.
std::optional<double> exposure_now(const ViewState& state);

// Requests a new measurement of the automatic exposure.
inline void measure_again(ViewState& state) { state.measured.reset(), ++state.metering_id; }

// What to render. Needs a scene.
Request request_of(const ViewState& state, bool moving);

// The action of a key; empty for keys without one. Keys: 1..9, a..z, space, left, right, home, tab, f1, f5, [ and ];
// preceded by "ctrl+" and "shift+", in this order.
std::optional<Action> action_of_key(const ViewState& state, std::string_view key);

struct KeyInfo {
    std::string_view keys, doc;
};
const std::vector<KeyInfo>& key_list();

// scene.march.0001.exr
std::string default_file_name(const ViewState& state);
}
