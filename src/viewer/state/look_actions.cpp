// Actions on how images are shown, what is explained about them, and the panels.
#include "base/error.h"
#include "base/text.h"
#include "scene/scene.h"
#include "viewer/state/verb_actions.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
void set_arrangement(ViewState& state, const Action& action) {
    state.shown.side_by_side = action.words[0] == "side";
    ++state.shown_revision;
}

void set_wipe(ViewState& state, const Action& action) {
    state.shown.wipe = static_cast<float>(std::clamp(action.numbers[0], 0.0, 1.0));
    ++state.shown_revision;
}

void set_shown(ViewState& state, const Action& action) {
    state.shown.layer = static_cast<ShownLayer>(choice_among("show", action.words[0], shown_layer_names()));
    ++state.shown_revision;
}

void expose(ViewState& state, double stops) {
    state.shown.exposure = std::clamp(stops, -100.0, 100.0);
    ++state.shown_revision;
}

void set_exposure(ViewState& state, const Action& action) {
    const std::string& word = action.words[0];
    if (word != "auto" && word != "scene") {
        const std::optional<double> stops = parsed<double>(word);
        if (!stops || !(std::abs(*stops) <= 100))
            fail(ExitCode::usage, "exposure",
                 "expected stops from -100 to 100, auto or scene; got '" + printable(word, 40) + "'");
        return expose(state, *stops);
    }
    state.shown.exposure.reset();
    state.automatic = word == "auto";
    if (state.automatic) measure_again(state);
    ++state.shown_revision;
}

void brighten(ViewState& state, const Action& action) {
    const std::optional<double> now = state.scene ? exposure_now(state) : state.shown.exposure;
    expose(state, now.value_or(0.0) + action.numbers[0]);
}

void set_view_transform(ViewState& state, const Action& action) {
    state.shown.transform =
        static_cast<ViewTransform>(choice_among("view-transform", action.words[0], view_transform_names()));
    ++state.shown_revision;
}

void zoom_picture(ViewState& state, const Action& action) {
    const std::string& word = action.words[0];
    const std::optional<double> zoom = word == "fit" ? 0 : parsed<double>(word);
    if (!zoom || !(*zoom == 0 || (*zoom >= 1.0 / 64 && *zoom <= 64)))
        fail(ExitCode::usage, "zoom", "expected fit, or a number from 1/64 to 64; got '" + printable(word, 40) + "'");
    const ivec2 size = state.size.x > 0 ? state.size : loaded_scene(state).resolution;
    state.zoom = *zoom;
    state.zoom_at = action.numbers.empty() ? 0.5f * vec2(size) : vec2(action.numbers[0], action.numbers[1]);
    state.zoom_at = glm::clamp(state.zoom_at, vec2(0), vec2(size));
}

void explain_pixel(ViewState& state, const Action& action) {
    std::optional<ivec2> asked;
    if (!action.numbers.empty()) {
        const ivec2 size = state.size.x > 0 ? state.size : loaded_scene(state).resolution;
        const double x = std::floor(action.numbers[0]), y = std::floor(action.numbers[1]);
        if (!(x >= 0 && y >= 0 && x < size.x && y < size.y))
            fail(ExitCode::usage, "explain",
                 formatted("%g %g lies outside the image of %d x %d pixels", x, y, size.x, size.y));
        asked = ivec2(static_cast<int>(x), static_cast<int>(y));
    }
    state.explain = asked;
    ++state.shown_revision;
}

void show_volume(ViewState& state, const Action& action) {
    state.volume_shown = is_on(action);
    ++state.shown_revision;
}

// Choosing a medium also shows it.
void set_medium(ViewState& state, const Action& action) {
    std::vector<std::string> names;
    for (const MediumSource& medium : loaded_scene(state).media) names.push_back(medium.name);
    if (!std::ranges::count(names, action.words[0]))
        fail(ExitCode::usage, "medium", unknown_name("medium", action.words[0], names));
    state.volume.medium = action.words[0], state.volume_shown = true;
    ++state.shown_revision;
}

void look_along(ViewState& state, const Action& action, VolumeLook look) {
    state.volume.look = look, state.volume.axis = action.words[0][0] - 'x';
    state.volume_shown = true;
    ++state.shown_revision;
}

void slice_volume(ViewState& state, const Action& action) {
    look_along(state, action, VolumeLook::slice);
    state.volume.position = std::clamp(static_cast<float>(action.numbers[0]), 0.0f, 1.0f);
}

void project_volume(ViewState& state, const Action& action) {
    look_along(state, action, action.words[1] == "mean" ? VolumeLook::mean : VolumeLook::maximum);
}

void show_tab(ViewState& state, const Action& action) {
    state.lights_tab = choice_among("tab", action.words[0], {"render", "lights"}) == 1;
}

constexpr VerbAction table[] = {
    {Verb::arrange, set_arrangement},
    {Verb::wipe, set_wipe},
    {Verb::show, set_shown},
    {Verb::exposure, set_exposure},
    {Verb::brighten, brighten},
    {Verb::view_transform, set_view_transform},
    {Verb::zoom, zoom_picture},
    {Verb::explain, explain_pixel},
    {Verb::volume, show_volume},
    {Verb::medium, set_medium},
    {Verb::slice, slice_volume},
    {Verb::project, project_volume},
    {Verb::tab, show_tab},
    {Verb::handles, [](ViewState& state, const Action& action) { state.handles = is_on(action); }},
    {Verb::panels, [](ViewState& state, const Action& action) { state.panels = is_on(action); }},
    {Verb::help, [](ViewState& state, const Action& action) { state.help = is_on(action); }},
};
}

std::span<const VerbAction> look_actions() { return table; }
}
