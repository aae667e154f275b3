#include "viewer/editing/scene_session.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "scene/file/scene_words.h"
#include "viewer/editing/scene_text.h"
#include "volume/vdb/vdb.h"

namespace tyndall {
namespace {
bool is_model(const std::filesystem::path& file) {
    return lower_extension(file) == ".gltf" || lower_extension(file) == ".glb";
}

std::vector<Edit> active_edits(const SceneSession& session) {
    std::vector<Edit> edits;
    for (size_t i = 0; i < session.done; ++i)
        edits.insert(edits.end(), session.steps[i].edits.begin(), session.steps[i].edits.end());
    return edits;
}

// Sets the scene to the state after the first `steps` steps.
void go_to(SceneSession& session, size_t steps) {
    put_parts(session.before, session.scene);
    session.done = steps;
    for (const Edit& each : active_edits(session)) reapply(session.scene, each);
}

// Reads the file's text and a scene from exactly that text.
SceneSession read_scene_session(const std::filesystem::path& file, const LoadOptions& options) {
    for (int attempt = 0; attempt < 10; ++attempt) {
        SceneSession session;
        session.text = session.on_disk = read_file(file);
        session.scene = load_scene(file, options);
        session.has_file = true;
        if (read_file(file) == session.text) return session;
    }
    fail(ExitCode::unreadable, file.string(), "keeps changing while it is read");
}

SceneSession read_session(const std::filesystem::path& file, const LoadOptions& options) {
    if (is_model(file)) {
        SceneSession session;
        session.scene = load_scene(file, options);
        session.text = new_scene_text(session.scene);
        return session;
    }
    if (is_volume_name(file)) {
        SceneSession session;
        session.text = volume_scene_text(file);
        session.scene = load_scene_text(session.text, file, options);
        return session;
    }
    return read_scene_session(file, options);
}

std::string line_of(const Scene& scene, const Edit& edit) {
    return formatted("%s/%s = %.9g %.9g %.9g at %.9g s\n", part_path(scene, edit.part, edit.index).c_str(),
                     edit.property.c_str(), edit.value.x, edit.value.y, edit.value.z, edit.seconds);
}

// The target of an edit, to be found in a reloaded scene: the n-th part with a name.
struct Target {
    std::string name;
    size_t number = 0;
};

Target target_of(const Scene& scene, const Edit& edit) {
    Target target{name_of(scene, edit.part, edit.index), 0};
    for (size_t i = 0; i < edit.index; ++i) target.number += name_of(scene, edit.part, i) == target.name;
    return target;
}

std::optional<size_t> index_of(const Scene& scene, Part part, const Target& target) {
    size_t number = 0;
    for (size_t i = 0; i < count_of(scene, part); ++i)
        if (name_of(scene, part, i) == target.name && number++ == target.number) return i;
    return {};
}

// Repeats a step of another session; adds a line to `lost` for each edit that is not possible.
void reapply_step(const Scene& old, const EditStep& step, SceneSession& session, std::vector<std::string>& lost) {
    EditStep made;
    for (Edit each : step.edits) {
        const std::string place = part_path(old, each.part, each.index) + "/" + each.property;
        const std::optional<size_t> index = index_of(session.scene, each.part, target_of(old, each));
        if (!index) {
            lost.push_back(place + ": no longer exists");
            continue;
        }
        try {
            each.index = *index;
            const std::vector<Edit> singles = apply(session.scene, each);
            made.edits.insert(made.edits.end(), singles.begin(), singles.end());
        } catch (const Error& error) {
            lost.push_back(error.what());
        }
    }
    if (made.edits.empty()) return;
    session.steps.push_back(std::move(made));
    session.done = session.steps.size();
}

// Adds an edit to a step, or its value to the edit that it continues.
void add_to(std::vector<Edit>& edits, const Edit& edit) {
    const auto same = [&](const Edit& e) {
        return e.part == edit.part && e.index == edit.index && e.property == edit.property;
    };
    const auto last = std::find_if(edits.rbegin(), edits.rend(), same);
    if (last != edits.rend() && last->seconds == edit.seconds)
        last->value = edit.value;
    else
        edits.push_back(edit);
}

void note_saved(SceneSession& session, std::string text) {
    for (InputFile& input : session.scene.inputs)
        if (input.path == session.scene.file) input.hash = content_hash(text);
    session.on_disk = std::move(text);
    session.saved = session.kept = session.done;
    if (session.done > 0) session.steps[session.done - 1].drag = 0;
    session.inputs = input_times(session.scene);
}
}

SceneSession open_session(const std::filesystem::path& file, const LoadOptions& options) {
    SceneSession session = read_session(file, options);
    session.options = options;
    session.before = editable_parts(session.scene);
    session.inputs = input_times(session.scene);
    return session;
}

void edit(SceneSession& session, const Edit& edit, uint64_t drag) {
    const std::vector<Edit> singles = apply(session.scene, edit);

    // Discards the undone steps, and with them perhaps the saved state.
    const bool branches = session.done < session.steps.size();
    session.steps.resize(session.done);
    session.kept = std::min(session.kept, session.done);
    const bool goes_on = !branches && drag != 0 && session.done > 0 && session.steps.back().drag == drag;
    if (!goes_on) session.steps.push_back({{}, drag});
    session.done = session.steps.size();
    for (const Edit& single : singles) add_to(session.steps.back().edits, single);
}

bool undo(SceneSession& session) {
    if (session.done == 0) return false;
    session.steps[session.done - 1].drag = 0;
    go_to(session, session.done - 1);
    return true;
}

bool redo(SceneSession& session) {
    if (session.done == session.steps.size()) return false;
    go_to(session, session.done + 1);
    return true;
}

bool discard_drag(SceneSession& session, uint64_t drag) {
    if (drag == 0 || session.done == 0 || session.steps[session.done - 1].drag != drag) return false;
    undo(session);
    session.steps.resize(session.done);
    return true;
}

bool has_unsaved_changes(const SceneSession& session) {
    return session.done != session.saved || session.kept != session.saved;
}

std::string unsaved_text(const SceneSession& session) {
    std::string text;
    const size_t first = std::min(session.kept, session.done);
    if (first < session.saved) text = formatted("without the last %zu steps that were saved\n", session.saved - first);
    for (size_t i = first; i < session.done; ++i)
        for (const Edit& each : session.steps[i].edits) text += line_of(session.scene, each);
    // The hash covers what the lines do not: which of two parts with the same name, and undone steps.
    if (text.empty()) return text;
    return text + "scene " + content_hash(edited_text(session.text, session.scene, active_edits(session))) + "\n";
}

void save(SceneSession& session) {
    const std::filesystem::path& file = session.scene.file;
    if (!session.has_file) fail(ExitCode::usage, file.string(), "is not a scene file; give the name of a new one");
    if (read_file(file) != session.on_disk)
        refuse(file.string(), "was changed on disk since it was read; reload it first");
    std::string text = edited_text(session.text, session.scene, active_edits(session));
    write_file_atomically(file, std::string_view(text));
    note_saved(session, std::move(text));
}

void save_as(SceneSession& session, const std::filesystem::path& file) {
    if (is_model(file) || is_volume_name(file))
        fail(ExitCode::usage, file.string(), "is not a name for a scene file; scene files end in .json");
    const std::filesystem::path old = session.scene.file;
    const auto folder = [](const std::filesystem::path& path) {
        return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    };
    if (!std::filesystem::is_directory(folder(file)))
        fail(ExitCode::unwritable, file.string(), "its folder does not exist");
    std::string base = rebase_paths(session.text, folder(old), folder(file));
    std::string text = edited_text(base, session.scene, active_edits(session));
    std::vector<InputFile> inputs = session.scene.inputs;
    std::erase_if(
        inputs, [&](const InputFile& input) { return input.path == file || (session.has_file && input.path == old); });
    inputs.insert(inputs.begin(), {file, {}});

    write_file_atomically(file, std::string_view(text));
    session.scene.file = file, session.scene.inputs = std::move(inputs);
    session.text = std::move(base), session.has_file = true;
    note_saved(session, std::move(text));
}

std::vector<std::string> reload(SceneSession& session) {
    session.inputs = input_times(session.scene);
    return rebase_onto(session, open_session(session.scene.file, session.options));
}

std::vector<std::string> rebase_onto(SceneSession& session, SceneSession fresh) {
    std::vector<std::string> lost;
    const size_t first = std::min(session.kept, session.done);
    if (first < session.saved) lost.push_back("steps undone since the last save are applied again, as in the file");
    for (size_t i = first; i < session.done; ++i) reapply_step(session.scene, session.steps[i], fresh, lost);
    session = std::move(fresh);
    return lost;
}
}
