// The "Rendering" page of the side panel: technique, image, camera, limitations, settings, times.
#include "../theme.h"
#include "base/text.h"
#include "modes/mode.h"
#include "panels.h"
#include "scene/scene.h"
#include "viewer/painting/reference_picture.h"

namespace tyndall {
namespace {
void heading(const char* text) {
    ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
    ImGui::TextColored(quiet, "%s", text);
}

// A label on the left, so that controls line up.
void labeled(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1);
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
    labeled("compare with");
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
        labeled("layout");
        if (ImGui::BeginCombo("##arranged", state.shown.side_by_side ? "side by side" : "wipe")) {
            if (ImGui::Selectable("wipe", !state.shown.side_by_side)) act({Verb::arrange, {"wipe"}, {}, {}});
            if (ImGui::Selectable("side by side", state.shown.side_by_side)) act({Verb::arrange, {"side"}, {}, {}});
            ImGui::EndCombo();
        }
    }
    labeled("quality");
    if (ImGui::BeginCombo("##quality", std::string(name_of(state.quality)).c_str())) {
        for (const Quality quality : {Quality::draft, Quality::preview, Quality::final, Quality::reference})
            if (ImGui::Selectable(std::string(name_of(quality)).c_str(), quality == state.quality))
                act({Verb::quality, {std::string(name_of(quality))}, {}, {}});
        ImGui::EndCombo();
    }
}

// Exposure in stops, to drag or type, and a button for automatic exposure.
void draw_exposure(const ViewState& state, const Act& act) {
    labeled("exposure");
    if (!state.scene) return ImGui::NewLine();
    float exposure = static_cast<float>(exposure_now(state).value_or(0.0));
    const bool measured = !state.shown.exposure && !shows_scene_exposure(state);
    const float button = 4 * ImGui::GetFontSize();
    ImGui::SetNextItemWidth(-button - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::DragFloat("##exposure", &exposure, 0.02f, -100, 100, "%+.1f EV"))
        act({Verb::exposure, {formatted("%.9g", exposure)}, {}, {}});
    tooltip("Exposure of the displayed image in stops: drag, or ctrl + click to type. [ and ] are half a stop.");
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(measured ? ImGuiCol_Header : ImGuiCol_Button));
    if (ImGui::Button("auto", {button, 0})) act({Verb::exposure, {"auto"}, {}, {}});
    ImGui::PopStyleColor();
    tooltip("Measure the exposure on the first, middle and last frame, as tyndall render does.");
}

void draw_shown(const ViewState& state, const Act& act) {
    heading("Image");
    labeled("show");
    const auto& names = shown_layer_names();
    if (ImGui::BeginCombo("##show", names[static_cast<size_t>(state.shown.layer)].c_str())) {
        for (const std::string& name : names)
            if (ImGui::Selectable(name.c_str(), name == names[static_cast<size_t>(state.shown.layer)]))
                act({Verb::show, {name}, {}, {}});
        ImGui::EndCombo();
    }
    draw_exposure(state, act);
    labeled("view transform");
    if (ImGui::BeginCombo("##view transform", name_of(state.shown.transform).c_str())) {
        for (const std::string& name : view_transform_names())
            if (ImGui::Selectable(name.c_str(), name == name_of(state.shown.transform)))
                act({Verb::view_transform, {name}, {}, {}});
        ImGui::EndCombo();
    }
    tooltip("How values brighter than the display are shown: filmic (AgX) rolls them off, srgb clips them. EXR files "
            "store linear light.");
}

void draw_looking_into(const ViewState& state, const Act& act) {
    heading("Inspect");
    bool volume = state.volume_shown;
    if (ImGui::Checkbox("volume", &volume)) act({Verb::volume, {volume ? "on" : "off"}, {}, {}});
    tooltip("density of the fog, slice by slice, and facts about its grid");
    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    bool ray = state.explain.has_value();
    if (ImGui::Checkbox("ray", &ray) && state.scene) {
        const ivec2 size = state.size.x > 0 ? state.size : state.scene->resolution;
        const std::vector<double> middle{0.5 * size.x, 0.5 * size.y};
        act({Verb::explain, {}, ray ? middle : std::vector<double>(), {}});
    }
    tooltip("what happens along the ray of a pixel: shift + click on the image chooses it");
}

void draw_cameras(const ViewState& state, const Act& act) {
    if (!state.scene) return;
    heading("Camera");
    const std::string& standing = state.camera.empty() && !state.scene->cameras.empty()
                                      ? state.scene->cameras[static_cast<size_t>(state.scene->camera)].name
                                      : state.camera;
    for (const CameraSource& camera : state.scene->cameras)
        if (ImGui::Selectable((camera.name + "##camera").c_str(), !state.free_camera && camera.name == standing))
            act({Verb::camera, {camera.name}, {}, {}});
    if (!state.free_camera) return;
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

void draw_remarks(const ViewState& state, const PanelResources& resources) {
    if (!ImGui::CollapsingHeader("limitations", ImGuiTreeNodeFlags_DefaultOpen)) return;
    bool none = true;
    for (const LimitationGroup& group : resources.limitations) {
        const Severity severity = group.worst.severity;
        const ImVec4 color = severity == Severity::wrong ? trouble : severity == Severity::degraded ? caution : quiet;
        remark(color, std::string(name_of(severity)) + "  " + where_of(group), sentence_of(group.worst));
        none = false;
    }
    if (state.scene)
        for (const std::string& warning : state.scene->warnings) remark(caution, "scene", warning), none = false;
    if (resources.picture) {
        for (const std::string& note : resources.picture->notes) remark(quiet, "note", note), none = false;
        if (resources.picture->non_finite)
            remark(trouble, "not finite", std::to_string(resources.picture->non_finite) + " samples were ignored"),
                none = false;
    }
    if (none) ImGui::TextDisabled("none known");
}

void draw_times(const PanelResources& resources) {
    if (!resources.picture || !ImGui::CollapsingHeader("time of the last image")) return;
    const StageTimes& times = resources.picture->times;
    const auto row = [](const char* name, double seconds) {
        ImGui::TextUnformatted(name);
        const std::string text = formatted("%.1f ms", 1e3 * seconds);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
        ImGui::TextUnformatted(text.c_str());
    };
    row("scene", times.load), row("preparation", times.prepare), row("rays", times.render);
    row("   of which fog", times.fog), row("display", times.tone);
    ImGui::Separator();
    row("image", times.total());
}
}

void draw_rendering(ViewState& state, const PanelResources& resources, PanelState& memory, const Act& act) {
    draw_modes(state, act);
    draw_shown(state, act);
    draw_looking_into(state, act);
    draw_cameras(state, act);
    ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
    draw_remarks(state, resources);
    draw_settings(state, memory, act);
    draw_times(resources);
    draw_files(state, memory.files, act);
}
}
