#include "viewer.h"

#include "../tyndall/common.h"
#include "base/error.h"
#include "base/file.h"
#include "interface_times.h"
#include "panels.h"
#include "render/png.h"
#include "window.h"

#include <imgui.h>

#include <chrono>

namespace tyndall {
namespace {
constexpr double settle = 0.15; // seconds after a motion until pictures count as still
constexpr double active_wait = 1.0 / 60, resting_wait = 0.25, active_time = 0.5;
constexpr double watch_interval = 0.5; // between looks at the scene's files
constexpr int drag_frames = 12;

double seconds_now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

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
    FileTimes watched;
    double watched_at = 0, started = 0, moved_at = -1e9, input_at = -1e9, now = 0, frame_seconds = 0;
    int loads_begun = 0;
    uint64_t motions_seen = 0, posted = 0, posted_shown = 0;
    bool posted_moving = false;
    Shelf shelf;
    uint64_t picture_revision = 0; // of the newest answer, with or without a picture
    bool new_picture = false;
    PanelMemory memory;
    ScriptPlayer script;
    ScriptedInput scripted;
    Drag drag;
    std::string script_place; // of the action being done
    std::string screenshot;   // to take after this frame
    std::string file_place;   // of the snapshot being written for a script
    int files_to_come = 0;
    bool quit = false;
    InterfaceTimes times;
    RenderThread thread; // ends before all else

    explicit Viewer(const ViewerOptions& given)
        : options(given), window("Tyndall", given.window), state(given.state), thread(Window::wake) {}
};

void tell(Viewer& viewer, const std::string& message, bool is_error) {
    viewer.state.message = message, viewer.state.message_is_error = is_error;
}

void save(Viewer& viewer, const std::string& file) {
    if (!viewer.state.scene) fail(ExitCode::usage, file, "no scene is loaded yet");
    SaveJob job;
    job.file = file;
    job.request = request_of(viewer.state, false);
    job.camera = viewer.state.free ? "view" : viewer.state.camera;
    job.quality = viewer.state.quality, job.isa = viewer.options.isa;
    job.light_units = viewer.options.load.light_units;
    viewer.thread.save(std::move(job));
    ++viewer.files_to_come;
}

// Does an action of any kind. Throws Error.
void perform(Viewer& viewer, const Action& action) {
    if (apply(viewer.state, action)) return;
    const auto& numbers = action.numbers;
    switch (action.verb) {
    case Verb::key:
        if (!key_codes().contains(action.words[0]))
            fail(ExitCode::usage, "key", "no key '" + printable(action.words[0], 40) + "'");
        viewer.scripted.key = action.words[0];
        break;
    case Verb::drag:
        viewer.drag = {vec2(numbers[0], numbers[1]), vec2(numbers[2], numbers[3]), 0};
        break;
    case Verb::snapshot:
        save(viewer, action.words[0]);
        break;
    case Verb::screenshot:
        viewer.screenshot = action.words[0];
        break;
    case Verb::quit:
        viewer.quit = true;
        break;
    default:
        break;
    }
}

// Of hands: what goes wrong is said in the window.
void act(Viewer& viewer, const Action& action) {
    try {
        if (action.verb != Verb::brighten) viewer.state.message.clear();
        perform(viewer, action);
    } catch (const Error& error) {
        tell(viewer, error.what(), true);
    }
}

void take_loaded(Viewer& viewer) {
    ViewState& state = viewer.state;
    if (viewer.loads_begun != state.loads) {
        viewer.loads_begun = state.loads;
        viewer.loader.start(state.scene_file, viewer.options.load, Window::wake);
    }
    std::optional<LoadedScene> loaded = viewer.loader.take();
    if (!loaded) return;
    state.loading = false;
    if (loaded->scene) {
        viewer.watched = times_of(loaded->scene->inputs);
        viewer.window.set_title(state.scene_file.filename().string() + " - Tyndall");
        if (state.message_is_error) state.message.clear();
        take_scene(state, loaded->scene);
        return;
    }
    // The last good picture stays, unless there is none or a script asked for this scene.
    if (!state.scene || !viewer.script_place.empty()) fail(loaded->code, viewer.script_place, loaded->error);
    tell(viewer, loaded->error, true);
}

// Reads the scene again when one of its files has changed.
void watch_files(Viewer& viewer) {
    ViewState& state = viewer.state;
    if (!state.scene || state.loading || viewer.now < viewer.watched_at + watch_interval) return;
    viewer.watched_at = viewer.now;
    FileTimes times = times_of(state.scene->inputs);
    if (times == viewer.watched) return;
    viewer.watched = std::move(times);
    state.scene_file = state.scene->file, state.loading = true;
    viewer.script_place.clear();
    ++state.loads;
}

void take_pictures(Viewer& viewer) {
    if (std::shared_ptr<const Picture> picture = viewer.thread.take_picture()) {
        viewer.picture_revision = picture->revision;
        if (!picture->error.empty()) {
            if (!viewer.script.finished()) fail(picture->code, viewer.script_place, picture->error);
            tell(viewer, picture->error, true);
        } else {
            if (viewer.times.first_picture < 0) viewer.times.first_picture = seconds_now() - viewer.started;
            if (!picture->quick && picture->mode == viewer.state.mode) viewer.shelf.limits = picture->limits;
            viewer.shelf.picture = std::move(picture);
            viewer.new_picture = true;
        }
    }
    while (const std::optional<Saved> saved = viewer.thread.take_saved()) {
        --viewer.files_to_come;
        if (!saved->error.empty() && !viewer.script.finished()) fail(saved->code, viewer.file_place, saved->error);
        if (saved->error.empty())
            tell(viewer, formatted("wrote %s in %.2f s", saved->file.c_str(), saved->seconds), false);
        else
            tell(viewer, saved->error, true);
    }
    viewer.shelf.saving = viewer.thread.saving();
}

bool is_moving(const Viewer& viewer) { return viewer.now < viewer.moved_at + settle || viewer.state.playing; }

// What a script may go by.
ScriptFacts facts_of(const Viewer& viewer) {
    ScriptFacts facts;
    facts.now = viewer.now;
    const bool asked = viewer.posted == viewer.state.revision && viewer.posted_shown == viewer.state.shown_revision;
    facts.idle = asked && !viewer.posted_moving && !viewer.new_picture && viewer.thread.idle() &&
                 viewer.picture_revision == viewer.state.revision;
    const auto& picture = viewer.shelf.picture;
    if (picture && picture->revision == viewer.state.revision && picture->mode == viewer.state.mode && !picture->quick)
        facts.samples = picture->samples;
    facts.busy = viewer.drag.frame >= 0 || !viewer.scripted.key.empty() || viewer.files_to_come > 0 ||
                 !viewer.screenshot.empty();
    return facts;
}

// Does the script's next actions, until one takes time.
void follow_script(Viewer& viewer) {
    while (!viewer.quit) {
        const std::optional<Action> action = next_action(viewer.script, viewer.state, facts_of(viewer));
        if (!action) return;
        viewer.script_place = viewer.file_place = action->place;
        try {
            perform(viewer, *action);
        } catch (const Error& error) {
            fail(error.code, action->place, error.what());
        }
    }
}

// The mouse of a script's drag: there, down, along, up.
void move_scripted_mouse(Viewer& viewer) {
    ScriptedInput& input = viewer.scripted;
    input.active = !viewer.options.script.empty() && (!viewer.script.finished() || viewer.drag.frame >= 0);
    Drag& drag = viewer.drag;
    if (drag.frame < 0) {
        input.down = false, input.mouse = vec2(-1e6f);
        return;
    }
    const float share = std::clamp((static_cast<float>(drag.frame) - 2) / drag_frames, 0.0f, 1.0f);
    input.mouse = glm::mix(drag.from, drag.to, share);
    input.down = drag.frame > 0 && drag.frame <= drag_frames + 2;
    if (++drag.frame > drag_frames + 4) drag.frame = -1;
}

// Keys that are pressed now; those that fly go on while they are held.
void read_keys(Viewer& viewer) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    for (const auto& [name, code] : key_codes()) {
        if (!ImGui::IsKeyDown(code) || io.KeyCtrl || io.KeyAlt) continue;
        const bool flies = name.size() == 1 && std::string_view("wasdqe").find(name[0]) != std::string_view::npos;
        const bool repeats = name == "left" || name == "right" || name == "[" || name == "]";
        std::optional<Action> action = action_of_key(viewer.state, name);
        if (!action) continue;
        if (ImGui::IsKeyPressed(code, repeats)) {
            act(viewer, *action);
        } else if (flies) {
            for (double& metres : action->numbers) metres *= 25 * viewer.frame_seconds;
            act(viewer, *action);
        }
    }
    viewer.scripted.key.clear();
}

void post_request(Viewer& viewer) {
    ViewState& state = viewer.state;
    if (!state.scene) return;
    if (state.motions != viewer.motions_seen) viewer.motions_seen = state.motions, viewer.moved_at = viewer.now;
    const bool moving = is_moving(viewer);
    if (viewer.posted == state.revision && viewer.posted_shown == state.shown_revision &&
        viewer.posted_moving == moving)
        return;
    viewer.posted = state.revision, viewer.posted_shown = state.shown_revision, viewer.posted_moving = moving;
    try {
        viewer.thread.post(request_of(state, moving));
    } catch (const Error& error) {
        tell(viewer, error.what(), true);
    }
}

void note_input(Viewer& viewer) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool keys = std::any_of(std::begin(io.KeysDown), std::end(io.KeysDown), [](bool down) { return down; });
    const bool mouse = io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 || ImGui::IsAnyMouseDown();
    if (keys || mouse) viewer.input_at = viewer.now;
}

double wait_of(const Viewer& viewer) {
    const bool active = is_moving(viewer) || viewer.now < viewer.input_at + active_time || !viewer.script.finished() ||
                        viewer.files_to_come > 0 || viewer.state.loading;
    return active ? active_wait : resting_wait;
}

// One frame of the interface. Everything up to GL is its own time.
void run_frame(Viewer& viewer) {
    viewer.window.wait(wait_of(viewer));
    const double start = seconds_now();
    viewer.frame_seconds = std::min(start - viewer.now, 0.1);
    viewer.now = start;
    take_loaded(viewer);
    watch_files(viewer);
    take_pictures(viewer);
    advance(viewer.state, viewer.now, viewer.picture_revision);
    follow_script(viewer);
    move_scripted_mouse(viewer);
    viewer.window.begin_frame(viewer.scripted);
    note_input(viewer);
    read_keys(viewer);
    viewer.shelf.texture = viewer.window.picture();
    draw_interface(viewer.state, viewer.shelf, viewer.memory, [&](const Action& action) { act(viewer, action); });
    post_request(viewer);
    viewer.window.end_frame();

    const double drawn = seconds_now();
    if (viewer.new_picture) viewer.window.set_picture(viewer.shelf.picture->codes);
    viewer.new_picture = false;
    viewer.window.draw();
    const double done = seconds_now();
    viewer.times.interface.push_back(drawn - start), viewer.times.gl.push_back(done - drawn);
    if (!viewer.screenshot.empty()) write_png(viewer.screenshot, viewer.window.pixels());
    viewer.screenshot.clear();
    viewer.window.swap();
}
}

void run_viewer(const ViewerOptions& options) {
    Viewer viewer(options);
    viewer.script.actions = options.script;
    viewer.started = viewer.now = seconds_now();
    while (!viewer.quit && !viewer.window.closed()) run_frame(viewer);
    viewer.times.seconds = seconds_now() - viewer.started;
    if (options.stats) print_report(times_text(viewer.times, viewer.thread.counts()));
}
}
