// The side panel and the bar of time.
#include "panels.h"

#include "ask_panel.h"
#include "base/text.h"
#include "inspector.h"
#include "lights_panel.h"
#include "picture_panel.h"
#include "preview/reference_picture.h"
#include "theme.h"

#include <imgui_stdlib.h>

#include <algorithm>

namespace tyndall {
namespace {
constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

void heading(const char* text) {
    ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
    ImGui::TextColored(quiet, "%s", text);
}

// A label on the left, so that controls line up.
void labelled(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1);
}

void tooltip(const std::string& text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void draw_modes(const ViewState& state, const Act& act) {
    heading("Technique");
    int number = 1;
    for (const Mode& mode : modes()) {
        const std::string name(mode.name), label = formatted("%d  %s", number++, name.c_str());
        if (ImGui::Selectable(label.c_str(), name == state.mode)) act({Verb::mode, {name}, {}, {}});
        tooltip(std::string(mode.summary));
        const std::string promise(name_of(mode.accuracy));
        const float width = ImGui::CalcTextSize(promise.c_str()).x;
        ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
        ImGui::TextDisabled("%s", promise.c_str());
    }
    labelled("beside it");
    if (ImGui::BeginCombo("##beside", state.beside.empty() ? "nothing" : state.beside.c_str())) {
        if (ImGui::Selectable("nothing", state.beside.empty())) act({Verb::beside, {}, {}, {}});
        const std::string reference(reference_name);
        if (ImGui::Selectable(reference.c_str(), state.beside == reference)) act({Verb::beside, {reference}, {}, {}});
        for (const Mode& mode : modes())
            if (ImGui::Selectable(std::string(mode.name).c_str(), mode.name == state.beside))
                act({Verb::beside, {std::string(mode.name)}, {}, {}});
        ImGui::EndCombo();
    }
    if (!state.beside.empty()) {
        labelled("arranged");
        if (ImGui::BeginCombo("##arranged", state.shown.side_by_side ? "side by side" : "with a wipe")) {
            if (ImGui::Selectable("with a wipe", !state.shown.side_by_side)) act({Verb::arrange, {"wipe"}, {}, {}});
            if (ImGui::Selectable("side by side", state.shown.side_by_side)) act({Verb::arrange, {"side"}, {}, {}});
            ImGui::EndCombo();
        }
    }
    labelled("quality");
    if (ImGui::BeginCombo("##quality", std::string(name_of(state.quality)).c_str())) {
        for (const Quality quality : {Quality::draft, Quality::preview, Quality::final, Quality::reference})
            if (ImGui::Selectable(std::string(name_of(quality)).c_str(), quality == state.quality))
                act({Verb::quality, {std::string(name_of(quality))}, {}, {}});
        ImGui::EndCombo();
    }
}

void draw_shown(const ViewState& state, const Act& act) {
    heading("Picture");
    labelled("show");
    const auto& names = shown_layer_names();
    if (ImGui::BeginCombo("##show", names[static_cast<size_t>(state.shown.layer)].c_str())) {
        for (const std::string& name : names)
            if (ImGui::Selectable(name.c_str(), name == names[static_cast<size_t>(state.shown.layer)]))
                act({Verb::show, {name}, {}, {}});
        ImGui::EndCombo();
    }
    labelled("exposure");
    float exposure = state.shown.exposure;
    const bool changed = ImGui::SliderFloat("##exposure", &exposure, -6, 6, "%+.2f stops");
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
        act({Verb::exposure, {}, {0}, {}});
    else if (changed && !ImGui::IsMouseDoubleClicked(0))
        act({Verb::exposure, {}, {exposure}, {}});
}

void draw_looking_into(const ViewState& state, const Act& act) {
    heading("Look into");
    bool volume = state.volume_shown;
    if (ImGui::Checkbox("volume", &volume)) act({Verb::volume, {volume ? "on" : "off"}, {}, {}});
    tooltip("density of the fog, slice by slice, and what is known of its grid");
    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    bool ray = state.explain.has_value();
    if (ImGui::Checkbox("ray", &ray) && state.scene) {
        const ivec2 size = state.size.x > 0 ? state.size : state.scene->resolution;
        const std::vector<double> middle{0.5 * size.x, 0.5 * size.y};
        act({Verb::explain, {}, ray ? middle : std::vector<double>(), {}});
    }
    tooltip("what happens on the ray of a pixel: shift + click on the picture says which");
}

void draw_cameras(const ViewState& state, const Act& act) {
    if (!state.scene) return;
    heading("Camera");
    const std::string& standing = state.camera.empty() && !state.scene->cameras.empty()
                                      ? state.scene->cameras[static_cast<size_t>(state.scene->camera)].name
                                      : state.camera;
    for (const CameraSource& camera : state.scene->cameras)
        if (ImGui::Selectable((camera.name + "##camera").c_str(), !state.free && camera.name == standing))
            act({Verb::camera, {camera.name}, {}, {}});
    if (!state.free) return;
    ImGui::Selectable("moved by hand", true);
    if (ImGui::Button("Copy for the scene file")) ImGui::SetClipboardText(camera_json(viewpoint(state)).c_str());
    tooltip(camera_json(viewpoint(state)));
}

void remark(const ImVec4& color, const std::string& where, const std::string& what) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(where.c_str());
    ImGui::PopStyleColor();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(what.c_str());
    ImGui::PopTextWrapPos();
}

void draw_remarks(const ViewState& state, const Shelf& shelf) {
    if (!ImGui::CollapsingHeader("what it gets wrong", ImGuiTreeNodeFlags_DefaultOpen)) return;
    bool none = true;
    for (const Limit& limit : shelf.limits) {
        const ImVec4 color = limit.severity == Severity::wrong      ? trouble
                             : limit.severity == Severity::degraded ? caution
                                                                    : quiet;
        remark(color, std::string(name_of(limit.severity)) + "  " + limit.where, limit.why);
        none = false;
    }
    if (state.scene)
        for (const std::string& warning : state.scene->warnings) remark(caution, "scene", warning), none = false;
    if (shelf.picture) {
        for (const std::string& note : shelf.picture->notes) remark(quiet, "note", note), none = false;
        if (shelf.picture->non_finite)
            remark(trouble, "not finite", std::to_string(shelf.picture->non_finite) + " samples were left out"),
                none = false;
    }
    if (none) ImGui::TextDisabled("nothing known");
}

void draw_times(const Shelf& shelf) {
    if (!shelf.picture || !ImGui::CollapsingHeader("time of the last picture")) return;
    const StageTimes& times = shelf.picture->times;
    const auto row = [](const char* name, double seconds) {
        ImGui::TextUnformatted(name);
        const std::string text = formatted("%.1f ms", 1e3 * seconds);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
        ImGui::TextUnformatted(text.c_str());
    };
    row("scene", times.load), row("preparation", times.prepare), row("rays", times.render);
    row("   of it all, fog", times.fog), row("display", times.tone);
    ImGui::Separator();
    row("picture", times.total());
}

void draw_saving(ViewState& state, PanelMemory& memory, const Act& act) {
    heading("Write");
    if (!memory.file_name_edited) memory.file_name = usual_file_name(state);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputText("##file", &memory.file_name)) memory.file_name_edited = true;
    if (ImGui::Button("Write picture")) {
        act({Verb::snapshot, {memory.file_name}, {}, {}});
        memory.file_name_edited = false;
    }
    tooltip("The whole picture with " + std::to_string(state.settings.pixel.samples) +
            " samples a pixel, as tyndall render writes it: .exr for light, .png for looking at");
}

void draw_side(ViewState& state, const Shelf& shelf, PanelMemory& memory, const Act& act) {
    draw_tabs(state, act);
    if (state.lights_tab) return draw_lights(state, memory.edits, act);
    draw_modes(state, act);
    draw_shown(state, act);
    draw_looking_into(state, act);
    draw_cameras(state, act);
    ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
    draw_remarks(state, shelf);
    draw_settings(state, memory, act);
    draw_times(shelf);
    draw_saving(state, memory, act);
}

// On the bar of time: frames for which volume files are missing.
void mark_gaps(const ViewState& state) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const int first = state.scene->first_frame, count = state.scene->last_frame - first + 1;
    const float width = (high.x - low.x) / static_cast<float>(std::max(count, 1));
    for (const int frame : state.gaps) {
        const float x = low.x + width * static_cast<float>(frame - first);
        ImGui::GetWindowDrawList()->AddRectFilled({x, high.y - 4}, {x + std::max(width - 1, 1.0f), high.y},
                                                  ImGui::GetColorU32(trouble));
    }
    if (!state.gaps.empty())
        tooltip(formatted("%zu frames lack a volume file (red); the action \"missing hold\" shows the one before",
                          state.gaps.size()));
}

void draw_time(const ViewState& state, const Act& act) {
    if (!state.scene) return;
    const Scene& scene = *state.scene;
    const auto button = [&](const char* text, const char* help, const Action& action) {
        if (ImGui::Button(text)) act(action);
        tooltip(help);
        ImGui::SameLine();
    };
    button("|<", "first frame", {Verb::frame, {}, {static_cast<double>(scene.first_frame)}, {}});
    button("<", "one frame back (left)", {Verb::step, {}, {-1}, {}});
    if (state.playing)
        button("Stop", "space", {Verb::stop, {}, {}, {}});
    else
        button("Play", "space", {Verb::play, {}, {}, {}});
    button(">", "one frame on (right)", {Verb::step, {}, {1}, {}});
    bool loop = state.loop;
    if (ImGui::Checkbox("loop", &loop)) act({Verb::loop, {loop ? "on" : "off"}, {}, {}});
    ImGui::SameLine();

    const std::string moment = formatted("%.2f s", moment_of(scene, state.frame).seconds);
    int frame = state.frame;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("0000.00 s").x - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::SliderInt("##frame", &frame, scene.first_frame, std::max(scene.last_frame, scene.first_frame),
                         "frame %d"))
        act({Verb::frame, {}, {static_cast<double>(frame)}, {}});
    mark_gaps(state);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", moment.c_str());
}

void draw_help(const Act& act) {
    bool open = true;
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (ImGui::Begin("Keys and mouse", &open,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize |
                         ImGuiWindowFlags_NoSavedSettings)) {
        for (const KeyInfo& info : key_list()) {
            ImGui::TextColored(accent, "%.*s", static_cast<int>(info.keys.size()), info.keys.data());
            ImGui::SameLine(13 * ImGui::GetFontSize());
            ImGui::TextUnformatted(info.doc.data(), info.doc.data() + info.doc.size());
        }
    }
    ImGui::End();
    if (!open) act({Verb::help, {"off"}, {}, {}});
}
}

void draw_interface(ViewState& state, const Shelf& shelf, PanelMemory& memory, const Act& act) {
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) ++memory.edits.drags;
    const ImVec2 whole = ImGui::GetIO().DisplaySize;
    const float type = ImGui::GetFontSize();
    const float side = state.panels ? std::min(23 * type, 0.5f * whole.x) : 0;
    const float bar = state.panels ? ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y : 0;
    const float strip = state.panels ? inspector_height(state, whole.y) : 0;

    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({whole.x - side, whole.y - bar - strip});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.06f, 0.06f, 0.065f, 1));
    ImGui::Begin("picture", nullptr, fixed | ImGuiWindowFlags_NoScrollWithMouse);
    draw_picture(state, shelf, memory.edits, act);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();

    if (strip > 0) {
        ImGui::SetNextWindowPos({0, whole.y - bar - strip});
        ImGui::SetNextWindowSize({whole.x - side, strip});
        ImGui::Begin("looked into", nullptr, fixed);
        draw_inspector(state, shelf, act);
        ImGui::End();
    }
    if (state.panels) {
        ImGui::SetNextWindowPos({0, whole.y - bar});
        ImGui::SetNextWindowSize({whole.x - side, bar});
        ImGui::Begin("time", nullptr, fixed);
        draw_time(state, act);
        ImGui::End();
        ImGui::SetNextWindowPos({whole.x - side, 0});
        ImGui::SetNextWindowSize({side, whole.y});
        ImGui::Begin("side", nullptr, (fixed & ~ImGuiWindowFlags_NoScrollbar));
        draw_side(state, shelf, memory, act);
        ImGui::End();
    }
    if (state.help) draw_help(act);
    draw_question(state, memory.edits, act);
}
}
