#include "viewer/state/view_state.h"

#include "base/error.h"
#include "base/io/frames.h"
#include "base/text.h"
#include "scene/camera.h"
#include "trace/moment.h"
#include "viewer/editing/missing_frames.h"
#include "viewer/editing/scene_loader.h"
#include "viewer/editing/scene_session.h"
#include "viewer/state/edit_actions.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
bool is_there(const ViewState& state) {
    return state.scene && state.selected.index < count_of(*state.scene, state.selected.part);
}

std::string selected_name(const ViewState& state) {
    return is_there(state) ? name_of(*state.scene, state.selected.part, state.selected.index) : "";
}

// Selects by name again: the index may have changed.
void select_by_name(ViewState& state, const std::string& name) {
    for (size_t i = 0; i < count_of(*state.scene, state.selected.part); ++i) {
        if (name_of(*state.scene, state.selected.part, i) != name) continue;
        state.selected.index = i;
        return;
    }
    state.selected = {};
}

void go_to(ViewState& state, int frame) { apply(state, {Verb::frame, {}, {static_cast<double>(frame)}, {}}); }
}

const Scene& loaded_scene(const ViewState& state) {
    if (!state.scene) fail(ExitCode::usage, "viewer", "no scene is loaded yet");
    return *state.scene;
}

void take_scene(ViewState& state, LoadedScene loaded) {
    const Scene& scene = loaded.session->scene;
    const auto has_name = [&](const CameraSource& camera) { return camera.name == state.camera; };
    if (!state.scene)
        find_camera(scene, state.camera);
    else if (!std::ranges::any_of(scene.cameras, has_name))
        state.camera.clear();
    const bool same_file = state.scene && state.scene->file == scene.file;
    const bool again = std::exchange(state.reloading, false);
    if (again && !same_file) return; // meanwhile it was saved as another file
    const std::string selected = selected_name(state);
    if (again) {
        std::vector<std::string> lost = rebase_onto(*state.session, std::move(*loaded.session));
        if (!lost.empty()) state.message = "reloaded; lost: " + joined(lost, "; "), state.message_is_error = true;
    } else {
        state.session = std::move(loaded.session);
    }
    state.scene = {state.session, &state.session->scene};
    state.render_copy = std::move(loaded.render_copy);
    state.scene_file = state.scene->file;
    state.gaps = missing_frames(*state.scene);
    show_edits(state);
    select_by_name(state, selected);
    if (same_file) return;
    state.free_camera = false, state.playing = false;
    measure_again(state);
    state.explain.reset();
    state.volume.medium.clear();
    state.frame = state.scene->first_frame;
}

bool has_camera(const ViewState& state) {
    try {
        return camera_now(state).vertical_fov > 0;
    } catch (const Error&) {
        return false;
    }
}

Camera camera_now(const ViewState& state) {
    if (state.free_camera) return state.view.camera;
    const Scene& scene = loaded_scene(state);
    return camera_at(scene, find_camera(scene, state.camera), seconds_of(state));
}

Viewpoint viewpoint(const ViewState& state) {
    if (state.free_camera) return state.view;
    const Scene& scene = loaded_scene(state);
    return viewpoint_of(scene, find_camera(scene, state.camera), seconds_of(state));
}

namespace {
std::string lens_json(const Lens& lens) {
    if (!lens) return {};
    const std::string blades =
        formatted(", \"aperture_blades\": %d, \"blade_rotation\": %.4g", lens.blades, glm::degrees(lens.rotation));
    return formatted(", \"aperture_radius\": %.4g, \"focus_distance\": %.5g", lens.radius, lens.focus) +
           (lens.blades ? blades : "");
}
}

std::string camera_json(const Viewpoint& view) {
    const Camera& camera = view.camera;
    const auto vector = [](vec3 v) { return formatted("[%.5g, %.5g, %.5g]", v.x, v.y, v.z); };
    return "{\"name\": \"view\", \"position\": " + vector(camera.position) + ", \"target\": " + vector(view.target()) +
           formatted(", \"vertical_fov\": %.4g", glm::degrees(camera.vertical_fov)) + lens_json(camera.lens) + "}";
}

void advance(ViewState& state, double now, uint64_t shown_revision) {
    if (!state.playing || !state.scene || shown_revision != state.revision || now < state.next_frame_at) return;
    const double period = 1 / state.scene->frame_rate;
    const bool on_time = state.next_frame_at > now - period;
    state.next_frame_at = (on_time ? state.next_frame_at : now) + period;
    const std::optional<int> next = next_frame(state);
    if (state.frames_to_play > 0 && --state.frames_to_play == 0)
        state.playing = false;
    else if (next)
        go_to(state, *next);
    else if (!state.loop || state.frames_to_play == 0)
        state.playing = false;
}

std::optional<int> next_frame(const ViewState& state) {
    const Scene& scene = loaded_scene(state);
    if (state.frame < scene.last_frame) return state.frame + 1;
    if (state.loop && scene.last_frame > scene.first_frame) return scene.first_frame;
    return {};
}

bool shows_scene_exposure(const ViewState& state) {
    return !state.shown.exposure && !state.automatic && state.scene->own_exposure;
}

std::optional<double> exposure_now(const ViewState& state) {
    if (shows_scene_exposure(state)) return state.scene->exposure.at(seconds_of(state));
    return state.shown.exposure ? state.shown.exposure : state.measured;
}

Request request_of(const ViewState& state, bool moving) {
    Request request;
    request.scene = state.render_copy, request.edited = state.parts;
    request.revision = state.revision, request.shown_revision = state.shown_revision;
    request.moving = moving || state.playing;
    request.frame = state.frame;
    if (state.playing) request.next_frame = next_frame(state);
    request.camera = camera_now(state);
    request.size = state.size.x > 0 ? state.size : state.scene->resolution;
    request.mode = state.mode, request.stand_in = state.stand_in, request.beside = state.beside;
    request.settings = state.settings, request.seed = state.seed, request.missing = state.missing;
    request.shown = state.shown;
    const auto inside = [&](ivec2 pixel) { return pixel.x < request.size.x && pixel.y < request.size.y; };
    if (state.explain && inside(*state.explain)) request.explain = state.explain;
    if (state.volume_shown) request.volume = state.volume;
    request.shown.exposure = exposure_now(state), request.metering_id = state.metering_id;
    request.max_samples = state.max_samples;
    request.wanted_seconds = 1 / state.wanted_rate;
    return request;
}

std::string default_file_name(const ViewState& state) {
    const std::filesystem::path& file = state.scene ? state.scene->file : state.scene_file;
    return file.stem().string() + "." + state.mode + frame_name(".####", state.frame) + ".exr";
}
}
