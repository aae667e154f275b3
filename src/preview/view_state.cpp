#include "preview/view_state.h"

#include "base/error.h"
#include "base/frames.h"
#include "base/text.h"
#include "preview/setting_groups.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double largest_side = 16384;

double seconds_of(const ViewState& state) { return moment_of(*state.scene, state.frame).seconds; }

const Scene& loaded_scene(const ViewState& state) {
    if (!state.scene) fail(ExitCode::usage, "viewer", "no scene is loaded yet");
    return *state.scene;
}

void move(ViewState& state, const Viewpoint& view) {
    state.view = view;
    state.view.camera.name = "view";
    state.free = true;
    ++state.revision, ++state.motions;
}

void set_mode(ViewState& state, const std::string& name) {
    state.mode = find_mode(name).name;
    ++state.revision;
}

void set_quality(ViewState& state, const std::string& name) {
    state.quality = quality_named(name);
    state.settings = settings_for(state.quality);
    ++state.revision;
}

void set_orders(ViewState& state, const std::string& text) {
    const Mode& mode = find_mode(state.mode);
    const std::string row = mode.surfaces == Surfaces::own ? "path.orders" : "fluence.orders";
    if (!has_fluence(mode) && mode.surfaces != Surfaces::own)
        fail(ExitCode::usage, "orders", state.mode + " scatters light once only; march, froxel and path take more");
    apply_setting(state.settings, row + "=" + (text == "all" ? std::to_string(all_orders) : text));
    ++state.revision;
}

void reset_setting(ViewState& state, const std::string& name) {
    const Settings usual = settings_for(state.quality);
    if (name == "all") {
        state.settings = usual;
    } else {
        const SettingRow& row = find_row(name);
        row.set(state.settings, row.get(usual));
    }
    ++state.revision;
}

void set_shown(ViewState& state, const std::string& name) {
    const auto& names = shown_layer_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        fail(ExitCode::usage, "show", "no '" + printable(name, 40) + "'; there is " + joined(names, ", "));
    state.shown.layer = static_cast<ShownLayer>(found - names.begin());
    ++state.shown_revision;
}

void set_exposure(ViewState& state, double ev) {
    state.shown.exposure = static_cast<float>(std::clamp(ev, -100.0, 100.0));
    ++state.shown_revision;
}

void set_camera(ViewState& state, const std::string& name) {
    find_camera(loaded_scene(state), name);
    state.camera = name, state.free = false;
    ++state.revision;
}

void set_size(ViewState& state, double x, double y) {
    const bool scenes_own = x == 0 && y == 0;
    if (!scenes_own && !(x >= 1 && y >= 1 && x <= largest_side && y <= largest_side))
        fail(ExitCode::usage, "size", "expected 1 to 16384 pixels on each side, or 0 0 for the scene's");
    state.size = {static_cast<int>(x), static_cast<int>(y)};
    ++state.revision;
}

// Frames outside of the scene's range are fine: animations hold or repeat there.
void set_frame(ViewState& state, double frame) {
    const int wanted = static_cast<int>(std::round(frame));
    if (wanted == state.frame) return;
    state.frame = wanted;
    ++state.revision, ++state.motions;
}

void start_playing(ViewState& state, double frames) {
    loaded_scene(state);
    state.playing = true, state.next_frame_at = 0;
    state.frames_to_play = static_cast<int>(frames);
    if (!state.loop && state.frame >= state.scene->last_frame) set_frame(state, state.scene->first_frame);
}
}

bool apply(ViewState& state, const Action& action) {
    const auto& words = action.words;
    const auto& numbers = action.numbers;
    const auto angle = [&] { return glm::radians(vec2(numbers[0], numbers[1])); };
    const std::string word = words.empty() ? "" : words[0];
    switch (action.verb) {
    case Verb::open:
        state.scene_file = word, state.loading = true;
        ++state.loads;
        break;
    case Verb::set:
        apply_setting(state.settings, word + "=" + words[1]);
        ++state.revision;
        break;
    case Verb::reset:
        reset_setting(state, word);
        break;
    case Verb::mode:
        set_mode(state, word);
        break;
    case Verb::quality:
        set_quality(state, word);
        break;
    case Verb::orders:
        set_orders(state, word);
        break;
    case Verb::show:
        set_shown(state, word);
        break;
    case Verb::exposure:
        set_exposure(state, numbers[0]);
        break;
    case Verb::brighten:
        set_exposure(state, state.shown.exposure + numbers[0]);
        break;
    case Verb::camera:
        set_camera(state, word);
        break;
    case Verb::orbit:
        move(state, orbited(viewpoint(state), angle()));
        break;
    case Verb::turn:
        move(state, turned(viewpoint(state), angle()));
        break;
    case Verb::pan:
        move(state, panned(viewpoint(state), vec2(numbers[0], numbers[1])));
        break;
    case Verb::dolly:
        if (!(numbers[0] > 0)) fail(ExitCode::usage, "dolly", "expected a factor above 0");
        move(state, dollied(viewpoint(state), static_cast<float>(numbers[0])));
        break;
    case Verb::fly:
        move(state, flown(viewpoint(state), vec3(numbers[0], numbers[1], numbers[2])));
        break;
    case Verb::size:
        set_size(state, numbers[0], numbers[1]);
        break;
    case Verb::frame:
        set_frame(state, numbers[0]);
        break;
    case Verb::step:
        state.playing = false;
        set_frame(state, state.frame + numbers[0]);
        break;
    case Verb::play:
        start_playing(state, numbers.empty() ? 0 : std::max(numbers[0], 1.0));
        break;
    case Verb::stop:
        state.playing = false;
        break;
    case Verb::loop:
        state.loop = word == "on";
        break;
    case Verb::panels:
        state.panels = word == "on";
        break;
    case Verb::help:
        state.help = word == "on";
        break;
    case Verb::key:
    case Verb::drag:
    case Verb::wait:
    case Verb::snapshot:
    case Verb::screenshot:
    case Verb::quit:
        return false;
    }
    return true;
}

void take_scene(ViewState& state, std::shared_ptr<const Scene> scene) {
    const bool same_file = state.scene && state.scene->file == scene->file;
    state.scene = std::move(scene);
    ++state.revision;
    const bool knows_camera = std::ranges::any_of(
        state.scene->cameras, [&](const CameraSource& camera) { return camera.name == state.camera; });
    if (!state.camera.empty() && !knows_camera && same_file) state.camera.clear();
    if (same_file) return;
    state.free = false, state.playing = false;
    state.frame = state.scene->first_frame;
}

Viewpoint viewpoint(const ViewState& state) {
    if (state.free) return state.view;
    const Scene& scene = loaded_scene(state);
    return viewpoint_of(scene, find_camera(scene, state.camera), seconds_of(state));
}

std::string camera_json(const Viewpoint& view) {
    const Camera& camera = view.camera;
    const auto vector = [](vec3 v) { return formatted("[%.5g, %.5g, %.5g]", v.x, v.y, v.z); };
    return "{\"name\": \"view\", \"position\": " + vector(camera.position) + ", \"target\": " + vector(view.target()) +
           formatted(", \"vertical_fov\": %.4g}", glm::degrees(camera.vertical_fov));
}

void advance(ViewState& state, double now, uint64_t shown_revision) {
    if (!state.playing || !state.scene || shown_revision != state.revision || now < state.next_frame_at) return;
    const Scene& scene = *state.scene;
    const double period = 1 / scene.frame_rate;
    const bool on_time = state.next_frame_at > now - period;
    state.next_frame_at = (on_time ? state.next_frame_at : now) + period;
    if (state.frames_to_play > 0 && --state.frames_to_play == 0) {
        state.playing = false;
    } else if (state.frame < scene.last_frame) {
        set_frame(state, state.frame + 1);
    } else if (state.loop && scene.last_frame > scene.first_frame) {
        set_frame(state, scene.first_frame);
    } else if (!state.loop || state.frames_to_play == 0) {
        state.playing = false;
    }
}

Request request_of(const ViewState& state, bool moving) {
    Request request;
    request.scene = state.scene;
    request.revision = state.revision, request.shown_revision = state.shown_revision;
    request.moving = moving || state.playing;
    request.frame = state.frame;
    request.camera = viewpoint(state).camera;
    request.size = state.size.x > 0 ? state.size : state.scene->resolution;
    request.mode = state.mode, request.stand_in = state.stand_in;
    request.settings = state.settings, request.seed = state.seed, request.missing = state.missing;
    request.shown = state.shown;
    request.shown.exposure += state.scene->exposure.at(seconds_of(state));
    request.most_samples = state.most_samples;
    request.wanted_seconds = 1 / state.wanted_rate;
    return request;
}

std::string usual_file_name(const ViewState& state) {
    return state.scene_file.stem().string() + "." + state.mode + frame_name(".####", state.frame) + ".exr";
}
}
