// The viewer's main loop.
#include "../tyndall/common.h"
#include "base/clock.h"
#include "base/error.h"
#include "render/image/png.h"
#include "viewer/painting/volume_picture.h"
#include "viewer/state/edit_actions.h"
#include "viewer_parts.h"

namespace tyndall {
namespace {
constexpr double active_wait = 1.0 / 60, resting_wait = 0.25; // seconds between interface frames
constexpr double active_time = 0.5;                           // after the last input
constexpr double watch_interval = 0.5;                        // between checks of the scene's files for changes

void take_loaded(Viewer& viewer) {
    ViewState& state = viewer.state;
    if (viewer.loads_begun != state.loads) {
        viewer.loads_begun = state.loads;
        viewer.loader.start(state.scene_file, viewer.options.load, Window::wake);
    }
    std::optional<LoadedScene> loaded = viewer.loader.take();
    if (!loaded) return;
    state.loading = false;
    if (loaded->session) {
        state.file_error.clear();
        state.message.clear();
        take_scene(state, std::move(*loaded));
        if (!state.message.empty()) announce(viewer, std::exchange(state.message, {}), true);
        return;
    }
    // A failed load keeps the last good image on screen; it is fatal only without one, or when a script asked for it.
    if (!state.scene || !viewer.script_line.empty()) fail(loaded->code, viewer.script_line, loaded->error);
    state.scene_file = state.scene->file;
    if (std::exchange(state.reloading, false))
        state.file_error = loaded->error;
    else
        announce(viewer, loaded->error, true);
}

// Reads the scene again when one of its files has changed.
void watch_files(Viewer& viewer) {
    ViewState& state = viewer.state;
    if (!state.scene || state.loading || viewer.now < viewer.watched_at + watch_interval) return;
    viewer.watched_at = viewer.now;
    if (changed_inputs(state.session->inputs).empty()) return;
    state.session->inputs = input_times(*state.scene); // so that a broken file is not read again before its next change
    viewer.script_line.clear();
    reload_scene(state);
}

void show_title(Viewer& viewer) {
    const ViewState& state = viewer.state;
    const char* mark = state.session && has_unsaved_changes(*state.session) ? "* " : "";
    const std::string title = mark + state.scene_file.filename().string() + " - Tyndall";
    if (title == viewer.title) return;
    viewer.title = title;
    viewer.window.set_title(title);
}

void take_pictures(Viewer& viewer) {
    if (std::shared_ptr<const ShownPicture> picture = viewer.thread.take_picture()) {
        viewer.picture_revision = picture->revision;
        if (!picture->error.empty()) {
            if (!viewer.script.finished()) fail(picture->code, viewer.script_line, picture->error);
            announce(viewer, picture->error, true);
        } else {
            if (viewer.times.first_picture < 0) viewer.times.first_picture = steady_seconds() - viewer.started;
            if (!picture->quick && picture->mode == viewer.state.mode)
                viewer.resources.limitations = picture->limitations;
            if (picture->measured && picture->metering_id == viewer.state.metering_id)
                viewer.state.measured = picture->measured;
            if (picture->ray) viewer.resources.ray = picture->ray;
            if (picture->volume && picture->volume != viewer.resources.volume)
                viewer.resources.volume = picture->volume, viewer.new_volume = !picture->volume->codes.empty();
            viewer.resources.picture = std::move(picture);
            viewer.new_picture = true;
        }
    }
    while (const std::optional<SaveResult> saved = viewer.thread.take_saved()) {
        --viewer.pending_saves;
        if (!saved->error.empty() && !viewer.script.finished()) fail(saved->code, viewer.save_line, saved->error);
        if (saved->error.empty())
            announce(viewer, formatted("wrote %s in %.2f s", saved->file.c_str(), saved->seconds), false);
        else
            announce(viewer, saved->error, true);
    }
    viewer.resources.saving = viewer.thread.saving();
}

void take_job(Viewer& viewer) {
    const std::optional<JobResult> result = viewer.jobs.take_result();
    viewer.state.job = viewer.jobs.status();
    if (viewer.now > viewer.news_until) viewer.resources.news.clear();
    if (!result) return;
    const bool failed = result->code != ExitCode::ok;
    if (failed && !viewer.script.finished()) fail(result->code, viewer.job_line, result->message);
    announce(viewer, result->message, failed);
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
    } catch (const Error& error) { // a camera without a view direction at this frame
        if (!viewer.script.finished()) fail(error.code, viewer.script_line, error.what());
        set_message(viewer, error.what(), true);
        viewer.picture_revision = state.revision; // there will be no image
    }
}

double wait_of(const Viewer& viewer) {
    const bool active = is_moving(viewer) || viewer.now < viewer.input_at + active_time || !viewer.script.finished() ||
                        viewer.pending_saves > 0 || viewer.state.loading;
    return active ? active_wait : resting_wait;
}

void take_screenshot(Viewer& viewer) {
    const std::string file = std::exchange(viewer.screenshot, {});
    if (file.empty()) return;
    try {
        write_png(file, viewer.window.pixels());
    } catch (const Error& error) {
        fail(error.code, viewer.script_line, error.what());
    }
}

// Handles a request to close the window and files dropped on it.
void poll_window(Viewer& viewer) {
    if (viewer.pending_saves == 0 && viewer.window.take_close()) act(viewer, {Verb::close, {}, {}, {}});
    if (const std::string file = viewer.window.take_dropped(); !file.empty()) act(viewer, {Verb::open, {file}, {}, {}});
}

// Runs one frame of the interface; times.interface is everything before GL.
void run_frame(Viewer& viewer) {
    viewer.window.wait(wait_of(viewer));
    const double start = steady_seconds();
    viewer.frame_seconds = std::min(start - viewer.now, 0.1);
    viewer.now = start;
    poll_window(viewer);
    take_loaded(viewer);
    watch_files(viewer);
    take_pictures(viewer);
    take_job(viewer);
    advance(viewer.state, viewer.now, viewer.picture_revision);
    follow_script(viewer);
    move_scripted_mouse(viewer);
    viewer.window.begin_frame(viewer.scripted);
    read_input(viewer);
    viewer.resources.texture = viewer.window.picture(), viewer.resources.volume_texture = viewer.window.picture(1);
    draw_interface(viewer.state, viewer.resources, viewer.memory, [&](const Action& action) { act(viewer, action); });
    post_request(viewer);
    show_title(viewer);
    viewer.window.end_frame();

    const double drawn = steady_seconds();
    if (viewer.new_picture) viewer.window.set_texture(viewer.resources.picture->codes);
    if (viewer.new_volume) viewer.window.set_texture(viewer.resources.volume->codes, 1);
    viewer.new_picture = viewer.new_volume = false;
    viewer.window.show_pixels(viewer.state.zoom >= 1);
    const bool is_new = viewer.window.draw(!viewer.screenshot.empty());
    const double done = steady_seconds();
    viewer.times.interface.push_back(drawn - start);
    if (!is_new) return;
    viewer.times.gl.push_back(done - drawn);
    take_screenshot(viewer);
    viewer.window.swap();
}
}

void run_viewer(const ViewerOptions& options) {
    Viewer viewer(options);
    viewer.script.actions = options.script;
    viewer.started = viewer.now = steady_seconds();
    while (!viewer.quit && !viewer.state.closing) run_frame(viewer);
    viewer.times.seconds = steady_seconds() - viewer.started;
    viewer.window.hide(); // work in progress takes a moment to stop
    if (options.stats) print_report(times_text(viewer.times, viewer.thread.counts()));
}
}
