// The keyboard shortcuts.
#include "modes/mode.h"
#include "viewer/state/view_state.h"

namespace tyndall {
namespace {
constexpr double fly_share = 0.04; // of the distance to the target, per key press

Action fly(const ViewState& state, vec3 direction) {
    const vec3 meters = static_cast<float>(fly_share) * viewpoint(state).distance * direction;
    return {Verb::fly, {}, {meters.x, meters.y, meters.z}, {}};
}

Action show_next(const ViewState& state) {
    const auto& names = shown_layer_names();
    return {Verb::show, {names[(static_cast<size_t>(state.shown.layer) + 1) % names.size()]}, {}, {}};
}

const char* toggled(bool on) { return on ? "off" : "on"; }
}

std::optional<Action> action_of_key(const ViewState& state, std::string_view key) {
    const auto number = [](Verb verb, double value) { return Action{verb, {}, {value}, {}}; };
    if (key.size() == 1 && key[0] >= '1' && key[0] <= '9') {
        const size_t place = static_cast<size_t>(key[0] - '1');
        if (place >= modes().size()) return {};
        return Action{Verb::mode, {std::string(modes()[place].name)}, {}, {}};
    }
    if (key == "space" && state.scene) return Action{state.playing ? Verb::stop : Verb::play, {}, {}, {}};
    if (key == "left") return number(Verb::step, -1);
    if (key == "right") return number(Verb::step, 1);
    if (key == "[") return number(Verb::brighten, -0.5);
    if (key == "]") return number(Verb::brighten, 0.5);
    if (key == "z" && state.scene) return Action{Verb::zoom, {state.zoom > 0 ? "fit" : "1"}, {}, {}};
    if (key == "home" && state.scene) return Action{Verb::camera, {state.camera}, {}, {}};
    if (key == "ctrl+z") return Action{Verb::undo, {}, {}, {}};
    if (key == "ctrl+shift+z" || key == "ctrl+y") return Action{Verb::redo, {}, {}, {}};
    if (key == "ctrl+s") return Action{Verb::save, {}, {}, {}};
    if (key == "t") return Action{Verb::tab, {state.lights_tab ? "render" : "lights"}, {}, {}};
    if (key == "g") return Action{Verb::handles, {toggled(state.handles)}, {}, {}};
    if (key == "tab") return Action{Verb::panels, {toggled(state.panels)}, {}, {}};
    if (key == "f5") return Action{Verb::reload, {}, {}, {}};
    if (key == "f1") return Action{Verb::help, {toggled(state.help)}, {}, {}};
    if (key == "l") return Action{Verb::loop, {toggled(state.loop)}, {}, {}};
    if (key == "v") return show_next(state);
    if (key == "p") return Action{Verb::snapshot, {default_file_name(state)}, {}, {}};
    if (!state.scene) return {};
    if (key == "w") return fly(state, {0, 0, 1});
    if (key == "s") return fly(state, {0, 0, -1});
    if (key == "a") return fly(state, {-1, 0, 0});
    if (key == "d") return fly(state, {1, 0, 0});
    if (key == "q") return fly(state, {0, -1, 0});
    if (key == "e") return fly(state, {0, 1, 0});
    return {};
}

const std::vector<KeyInfo>& key_list() {
    static const std::vector<KeyInfo> list{
        {"drag", "orbit around the point looked at"},
        {"shift + drag, middle", "pan"},
        {"right button", "look around; with W A S D Q E: fly"},
        {"wheel", "closer, farther"},
        {"ctrl + wheel, drag", "zoom the image, pan it"},
        {"Z", "pixel for pixel, or the whole image"},
        {"shift + click", "explain a pixel: what happens along its ray"},
        {"home", "back to the scene's camera"},
        {"1 ... 8", "technique"},
        {"V", "picture, fog, transmittance, depth, validity, stops, error"},
        {"[  ]", "darker, brighter by half a stop"},
        {"space", "play, stop"},
        {"left, right", "one frame"},
        {"L", "loop"},
        {"T", "lights and fog, or rendering"},
        {"G", "handles of the lights in the image"},
        {"ctrl + Z", "undo an edit of the scene"},
        {"ctrl + shift + Z", "redo it; also ctrl + Y"},
        {"ctrl + S", "save the scene"},
        {"P", "write the image (EXR)"},
        {"tab", "panels"},
        {"F5", "reload the files"},
        {"F1", "this list"},
    };
    return list;
}
}
