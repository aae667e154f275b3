#include "viewer/state/edit_actions.h"

#include "base/error.h"
#include "base/json/json_pointer.h"
#include "base/text.h"
#include "trace/moment.h"
#include "viewer/editing/scene_session.h"
#include "viewer/state/verb_actions.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
SceneSession& loaded_session(ViewState& state) {
    loaded_scene(state);
    if (state.loading && !state.reloading) fail(ExitCode::usage, "viewer", "another scene is loading");
    return *state.session;
}

bool is_unsaved(const ViewState& state) { return state.session && has_unsaved_changes(*state.session); }

void load(ViewState& state, const std::string& file) {
    state.scene_file = file, state.loading = true, state.reloading = false;
    ++state.loads;
}

void say_done(ViewState& state, std::string message) {
    state.message = std::move(message), state.message_is_error = false;
}

// How a path names a part in its list: by its name if that is unique, else by its index.
std::string name_in_path(const Scene& scene, Part part, size_t index) {
    const std::string& name = name_of(scene, part, index);
    const std::string number = std::to_string(index);
    size_t alike = 0, numbers = 0;
    for (size_t i = 0; i < count_of(scene, part); ++i)
        alike += name_of(scene, part, i) == name, numbers += name_of(scene, part, i) == number;
    if (alike == 1) return json_pointer("", name).substr(1);
    return (numbers > 0 ? "#" : "") + number;
}

std::string path_of(const Scene& scene, PartRef thing) {
    constexpr const char* lists[] = {"lights/", "media/", "cameras/"};
    if (thing.part == Part::scene) return "scene";
    return lists[static_cast<int>(thing.part)] + name_in_path(scene, thing.part, thing.index);
}

std::string value_text(const Property& property, vec3 value) {
    if (property.kind == ValueKind::toggle) return value.x != 0 ? "on" : "off";
    if (property.kind == ValueKind::number) return formatted("%.9g", value.x);
    return formatted("%.9g %.9g %.9g", value.x, value.y, value.z);
}
}

double seconds_of(const ViewState& state) { return moment_of(*state.scene, state.frame).seconds; }

// The scene's exposure changes only how an image is displayed, not the rendering.
void edit_scene(ViewState& state, std::string_view path, std::string_view value, double drag) {
    SceneSession& session = loaded_session(state);
    const Edit change = parse_edit(session.scene, path, value, seconds_of(state));
    edit(session, change, drag > 0 ? static_cast<uint64_t>(drag) : 0);
    if (change.part == Part::scene && change.property == "exposure")
        state.shown.exposure.reset(), state.automatic = false, ++state.shown_revision;
    else
        show_edits(state), ++state.motions;
}

void undo_edit(ViewState& state) {
    if (!undo(loaded_session(state))) return say_done(state, "nothing to undo");
    show_edits(state);
}

void redo_edit(ViewState& state) {
    if (!redo(loaded_session(state))) return say_done(state, "nothing to redo");
    show_edits(state);
}

void cancel_drag(ViewState& state, double drag) {
    if (discard_drag(loaded_session(state), static_cast<uint64_t>(std::max(drag, 0.0)))) show_edits(state);
}

void save_scene(ViewState& state, const std::filesystem::path& file) {
    SceneSession& session = loaded_session(state);
    if (file.empty()) {
        save(session);
    } else {
        save_as(session, file);
        state.render_copy = std::make_shared<Scene>(session.scene); // has the new file name
        show_edits(state);
    }
    state.scene_file = session.scene.file, state.file_error.clear();
    say_done(state, "saved " + session.scene.file.string());
}

void open_scene(ViewState& state, const Action& action) {
    if (action.location.empty() && is_unsaved(state)) {
        state.asked = action;
        return;
    }
    load(state, action.words[0]);
}

void reload_scene(ViewState& state) {
    const Scene& scene = loaded_scene(state);
    if (state.loading) return;
    state.scene_file = scene.file, state.loading = state.reloading = true;
    ++state.loads;
}

void close_window(ViewState& state, const Action& action) {
    if (is_unsaved(state) || state.job)
        state.asked = action;
    else
        state.closing = true;
}

void answer(ViewState& state, const std::string& word) {
    if (!state.asked) fail(ExitCode::usage, "answer", "there is no open question");
    choice_among("answer", word, {"save", "discard", "cancel"});
    if (word == "save" && is_unsaved(state)) save_scene(state, {});
    const Action action = *std::exchange(state.asked, std::nullopt);
    if (word == "cancel") return;
    if (action.verb == Verb::close)
        state.closing = true;
    else
        load(state, action.words[0]);
}

void show_edits(ViewState& state) {
    state.parts = std::make_shared<const EditableParts>(editable_parts(state.session->scene));
    ++state.revision;
}

Action selection_of(const Scene& scene, PartRef thing) { return {Verb::select, {path_of(scene, thing)}, {}, {}}; }

Action action_of(const Scene& scene, const Edit& edit, uint64_t drag) {
    const Property& property = find_property(scene, edit.part, edit.index, edit.property);
    std::string path = edit.property;
    if (edit.part != Part::scene) path = path_of(scene, {edit.part, edit.index}) + "/" + path;
    Action action{Verb::edit, {std::move(path), value_text(property, edit.value)}, {}, {}};
    if (drag > 0) action.numbers.push_back(static_cast<double>(drag));
    return action;
}

namespace {
constexpr VerbAction table[] = {
    {Verb::open, open_scene},
    {Verb::reload, [](ViewState& state, const Action&) { reload_scene(state); }},
    {Verb::close, close_window},
    {Verb::answer, [](ViewState& state, const Action& action) { answer(state, action.words[0]); }},
    {Verb::select,
     [](ViewState& state, const Action& action) { state.selected = parse_part(loaded_scene(state), action.words[0]); }},
    {Verb::edit,
     [](ViewState& state, const Action& action) {
         edit_scene(state, action.words[0], action.words[1], action.numbers.empty() ? 0 : action.numbers[0]);
     }},
    {Verb::undo, [](ViewState& state, const Action&) { undo_edit(state); }},
    {Verb::redo, [](ViewState& state, const Action&) { redo_edit(state); }},
    {Verb::cancel, [](ViewState& state, const Action& action) { cancel_drag(state, action.numbers[0]); }},
    {Verb::save, [](ViewState& state, const Action&) { save_scene(state, {}); }},
    {Verb::save_as, [](ViewState& state, const Action& action) { save_scene(state, action.words[0]); }},
};
}

std::span<const VerbAction> scene_actions() { return table; }
}
