// What each action does to the state.
#include "base/error.h"
#include "base/text.h"
#include "preview/edit_actions.h"
#include "preview/reference_picture.h"
#include "preview/setting_groups.h"
#include "preview/view_state.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double largest_side = 16384;

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

void set_beside(ViewState& state, const std::string& name) {
    state.beside = name.empty() || name == reference_name ? name : std::string(find_mode(name).name);
    ++state.revision;
}

void set_arrangement(ViewState& state, const std::string& name) {
    state.shown.side_by_side = name == "side";
    ++state.shown_revision;
}

void set_wipe(ViewState& state, double share) {
    state.shown.wipe = static_cast<float>(std::clamp(share, 0.0, 1.0));
    ++state.shown_revision;
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

ivec2 picture_size(const ViewState& state) { return state.size.x > 0 ? state.size : loaded_scene(state).resolution; }

void set_explained(ViewState& state, const std::vector<double>& pixel) {
    std::optional<ivec2> asked;
    if (!pixel.empty()) {
        const ivec2 size = picture_size(state);
        const double x = std::floor(pixel[0]), y = std::floor(pixel[1]);
        if (!(x >= 0 && y >= 0 && x < size.x && y < size.y))
            fail(ExitCode::usage, "explain",
                 formatted("%g %g lies outside the picture of %d x %d pixels", x, y, size.x, size.y));
        asked = ivec2(static_cast<int>(x), static_cast<int>(y));
    }
    state.explain = asked;
    ++state.shown_revision;
}

void set_medium(ViewState& state, const std::string& name) {
    std::vector<std::string> names;
    for (const MediumSource& medium : loaded_scene(state).media) names.push_back(medium.name);
    if (!std::ranges::count(names, name))
        fail(ExitCode::usage, "medium", "no '" + printable(name, 40) + "' here; there is " + joined(names, ", "));
    state.volume.medium = name, state.volume_shown = true;
    ++state.shown_revision;
}

// What is asked about is shown.
void look_at_volume(ViewState& state, VolumeLook look, const std::string& axis, float position) {
    state.volume.look = look, state.volume.axis = axis[0] - 'x';
    state.volume.position = std::clamp(position, 0.0f, 1.0f);
    state.volume_shown = true;
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
    state.explain.reset(); // pixels are others now
    ++state.revision;
}

void show_tab(ViewState& state, const std::string& name) {
    if (name != "render" && name != "lights")
        fail(ExitCode::usage, "tab", "no '" + printable(name, 40) + "'; there is render, lights");
    state.lights_tab = name == "lights";
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
        open_scene(state, action);
        break;
    case Verb::close:
        close_window(state, action);
        break;
    case Verb::answer:
        answer(state, word);
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
    case Verb::beside:
        set_beside(state, word);
        break;
    case Verb::wipe:
        set_wipe(state, numbers[0]);
        break;
    case Verb::arrange:
        set_arrangement(state, word);
        break;
    case Verb::explain:
        set_explained(state, numbers);
        break;
    case Verb::volume:
        state.volume_shown = word == "on";
        ++state.shown_revision;
        break;
    case Verb::medium:
        set_medium(state, word);
        break;
    case Verb::slice:
        look_at_volume(state, VolumeLook::slice, word, static_cast<float>(numbers[0]));
        break;
    case Verb::project:
        look_at_volume(state, words[1] == "mean" ? VolumeLook::mean : VolumeLook::maximum, word, state.volume.position);
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
    case Verb::select:
        state.selected = parse_thing(loaded_scene(state), word);
        break;
    case Verb::tab:
        show_tab(state, word);
        break;
    case Verb::handles:
        state.handles = word == "on";
        break;
    case Verb::missing:
        state.missing = word == "hold" ? MissingFrame::hold : word == "skip" ? MissingFrame::skip : MissingFrame::error;
        ++state.revision;
        break;
    case Verb::panels:
        state.panels = word == "on";
        break;
    case Verb::help:
        state.help = word == "on";
        break;
    case Verb::edit:
        edit_scene(state, word, words[1], numbers.empty() ? 0 : numbers[0]);
        break;
    case Verb::undo:
        undo_edit(state);
        break;
    case Verb::redo:
        redo_edit(state);
        break;
    case Verb::cancel:
        cancel_drag(state, numbers[0]);
        break;
    case Verb::save:
        save_scene(state, {});
        break;
    case Verb::save_as:
        save_scene(state, word);
        break;
    case Verb::key:
    case Verb::drag:
    case Verb::wait:
    case Verb::snapshot:
    case Verb::screenshot:
    case Verb::render:
    case Verb::bake:
    case Verb::stop_job:
    case Verb::copy_command:
    case Verb::quit:
        return false;
    }
    return true;
}

}
