// Input from the user and from scripts.
#include "base/error.h"
#include "base/text.h"
#include "viewer_parts.h"

#include <imgui.h>

namespace tyndall {
namespace {
constexpr double settle = 0.15; // seconds after the last motion until the view counts as still
constexpr int drag_frames = 12;
constexpr double reading = 8; // seconds an announcement stays on screen
constexpr double flying = 25; // key presses per second that a held key counts as
}

void set_message(Viewer& viewer, const std::string& message, bool is_error) {
    viewer.state.message = message, viewer.state.message_is_error = is_error;
}

void announce(Viewer& viewer, const std::string& news, bool is_error) {
    viewer.resources.news = news, viewer.resources.news_is_error = is_error;
    viewer.news_until = viewer.now + reading;
}

bool is_moving(const Viewer& viewer) { return viewer.now < viewer.moved_at + settle || viewer.state.playing; }

namespace {
void save(Viewer& viewer, const std::string& file) {
    if (!viewer.state.scene) fail(ExitCode::usage, file, "no scene is loaded yet");
    SaveJob job;
    job.file = file;
    job.request = request_of(viewer.state, false);
    job.camera = viewer.state.free_camera ? "view" : viewer.state.camera;
    job.quality = viewer.state.quality, job.isa = viewer.options.isa;
    job.light_units = viewer.options.load.light_units, job.unsaved = unsaved_text(*viewer.state.session);
    job.inputs = viewer.state.session->scene.inputs;
    viewer.thread.save(std::move(job));
    ++viewer.pending_saves;
}

void start_job(Viewer& viewer, FileJob job) {
    viewer.jobs.start(std::move(job));
    viewer.state.job = viewer.jobs.status();
    viewer.job_line = viewer.script_line;
}

std::string word_of(const Action& action, size_t number) {
    return number < action.words.size() ? action.words[number] : "";
}

RenderRequest sequence_of(const Viewer& viewer, const Action& action) {
    return sequence_request(viewer.state, word_of(action, 0), word_of(action, 1), word_of(action, 2) == "png",
                            viewer.options.isa);
}

void copy_command(Viewer& viewer, const RenderRequest& request) {
    const std::string command = command_of(viewer.state, request);
    ImGui::SetClipboardText(command.c_str());
    set_message(viewer, "copied: " + command, false);
}

// Performs an action of any kind. Throws Error.
void perform(Viewer& viewer, const Action& action) {
    if (apply(viewer.state, action)) return;
    const auto& numbers = action.numbers;
    switch (action.verb) {
    case Verb::key:
        if (!key_codes().contains(plain_key(action.words[0])))
            fail(ExitCode::usage, "key", "no key '" + printable(action.words[0], 40) + "'");
        viewer.scripted.key = action.words[0], viewer.key_frames = 2;
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
    case Verb::render:
        start_job(viewer, render_job(viewer.state, sequence_of(viewer, action)));
        break;
    case Verb::bake:
        start_job(viewer, bake_job(viewer.state, word_of(action, 0), word_of(action, 1), word_of(action, 2)));
        break;
    case Verb::stop_job:
        viewer.jobs.stop();
        break;
    case Verb::copy_command:
        copy_command(viewer, sequence_of(viewer, action));
        break;
    case Verb::quit:
        viewer.quit = true;
        break;
    default:
        break;
    }
}

}

void act(Viewer& viewer, const Action& action) {
    // A scene that the user opens is not the script's: if it fails to load, the script goes on.
    if (action.verb == Verb::open || action.verb == Verb::answer) viewer.script_line.clear();
    try {
        set_message(viewer, {}, false);
        perform(viewer, action);
    } catch (const std::exception& error) {
        set_message(viewer, error.what(), true);
    }
}

namespace {
// What the script's waiting actions test.
ScriptFacts facts_of(const Viewer& viewer) {
    ScriptFacts facts;
    facts.now = viewer.now;
    const bool asked = viewer.posted == viewer.state.revision && viewer.posted_shown == viewer.state.shown_revision;
    facts.idle = asked && !viewer.posted_moving && !viewer.new_picture && viewer.thread.idle() &&
                 viewer.picture_revision == viewer.state.revision;
    const auto& picture = viewer.resources.picture;
    if (picture && picture->revision == viewer.state.revision && picture->mode == viewer.state.mode && !picture->quick)
        facts.samples = picture->samples;
    facts.job = viewer.state.job.has_value();
    facts.busy =
        viewer.drag.frame >= 0 || viewer.key_frames > 0 || viewer.pending_saves > 0 || !viewer.screenshot.empty();
    return facts;
}

}

void follow_script(Viewer& viewer) {
    while (!viewer.quit) {
        const std::optional<Action> action = next_action(viewer.script, viewer.state, facts_of(viewer));
        if (!action) return;
        viewer.script_line = viewer.save_line = action->location;
        try {
            perform(viewer, *action);
        } catch (const Error& error) {
            fail(error.code, action->location, error.what());
        }
    }
}

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

namespace {
// The action bound to a key; nothing when the camera has no view direction.
std::optional<Action> key_action(Viewer& viewer, const std::string& key) {
    try {
        return action_of_key(viewer.state, key);
    } catch (const Error& error) {
        set_message(viewer, error.what(), true);
        return {};
    }
}

// Acts on keys pressed in this frame; keys that fly repeat while they are held.
void read_keys(Viewer& viewer) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || viewer.state.asked) return;
    for (const auto& [name, code] : key_codes()) {
        if (!ImGui::IsKeyDown(code) || io.KeyAlt) continue;
        const bool flies = name.size() == 1 && std::string_view("wasdqe").find(name[0]) != std::string_view::npos;
        const bool repeats = name == "left" || name == "right" || name == "[" || name == "]";
        const std::string pressed = io.KeyCtrl ? (io.KeyShift ? "ctrl+shift+" : "ctrl+") + name : name;
        std::optional<Action> action = key_action(viewer, pressed);
        if (!action) continue;
        if (ImGui::IsKeyPressed(code, repeats)) {
            act(viewer, *action);
        } else if (flies && !io.KeyCtrl) {
            for (double& meters : action->numbers) meters *= flying * viewer.frame_seconds;
            act(viewer, *action);
        }
    }
}

}

void read_input(Viewer& viewer) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool keys = std::any_of(std::begin(io.KeysDown), std::end(io.KeysDown), [](bool down) { return down; });
    const bool mouse = io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 || ImGui::IsAnyMouseDown();
    if (keys || mouse) viewer.input_at = viewer.now;
    read_keys(viewer);
    viewer.scripted.key.clear();
    viewer.key_frames = std::max(viewer.key_frames - 1, 0);
}
}
