#include "panels.h"

#include "../theme.h"
#include "base/text.h"
#include "property_controls.h"
#include "viewer/editing/scene_session.h"
#include "viewer/state/edit_actions.h"

#include <imgui_stdlib.h>

#include <algorithm>

namespace tyndall {
namespace {
constexpr int max_proposals = 1000;
constexpr size_t max_lines = 9; // of the list before it scrolls

void small_heading(const char* text) {
    ImGui::Dummy({0, 0.2f * ImGui::GetFontSize()});
    ImGui::TextColored(quiet, "%s", text);
}

void tip(const char* text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", text);
}

// A button that is disabled unless `alive`; returns true when pressed.
bool button(const char* text, const char* help, bool alive) {
    ImGui::BeginDisabled(!alive);
    const bool pressed = ImGui::Button(text);
    ImGui::EndDisabled();
    tip(help);
    ImGui::SameLine();
    return pressed;
}

void draw_steps(const ViewState& state, const Act& act) {
    const SceneSession& session = *state.session;
    const bool unsaved = has_unsaved_changes(session);
    if (button("Undo", "ctrl + Z", session.done > 0)) act({Verb::undo, {}, {}, {}});
    if (button("Redo", "ctrl + shift + Z", session.done < session.steps.size())) act({Verb::redo, {}, {}, {}});
    const char* how = session.has_file ? "ctrl + S: write the edits into the scene file"
                                       : "No scene file yet: save it under a name below";
    if (button("Save", how, unsaved && session.has_file)) act({Verb::save, {}, {}, {}});
    if (unsaved)
        ImGui::TextColored(accent, "not saved");
    else
        ImGui::TextDisabled("saved");
}

// "lantern" for "lantern_12".
std::string without_number(const std::string& name) {
    const size_t last = name.find_last_not_of("0123456789");
    return last != name.npos && last > 0 && last + 1 < name.size() && name[last] == '_' ? name.substr(0, last) : name;
}

// The first free name of lantern_2.json, lantern_3.json ...; for a bare model lantern.json comes before them.
std::string proposed_name(const SceneSession& session) {
    std::filesystem::path file = session.scene.file;
    const std::string stem = session.has_file ? without_number(file.stem().string()) : file.stem().string();
    for (int number = session.has_file ? 2 : 1; number < max_proposals; ++number) {
        file.replace_filename(stem + (number > 1 ? "_" + std::to_string(number) : "") + ".json");
        if (!is_taken(file)) break;
    }
    return file.string();
}

void draw_save_as(const ViewState& state, EditState& edits, const Act& act) {
    propose_name(state, edits);
    const float width = ImGui::CalcTextSize("Save as").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-width - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::InputText("##file", &edits.file_name)) edits.file_exists = is_taken(edits.file_name);
    tip(edits.file_name.c_str());
    ImGui::SameLine();
    if (edits.file_exists) ImGui::PushStyleColor(ImGuiCol_Text, caution);
    const bool pressed = ImGui::Button(edits.file_exists ? "Replace" : "Save as", {width, 0});
    if (edits.file_exists) ImGui::PopStyleColor();
    tip(edits.file_exists ? "This file exists: overwrite it and continue with it"
                          : "Write a scene file with this name and continue with it");
    if (pressed) act({Verb::save_as, {edits.file_name}, {}, {}});
}

// A color scaled so that its largest component is 1.
ImVec4 hue_of(vec3 color) { return shown_color(color / std::max(max_component(color), 1e-6f)); }

// A line of the list: a color dot, the name and the kind.
void draw_line(const ViewState& state, PartRef thing, const std::string& name, const char* kind, ImVec4 color,
               const Act& act) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float type = ImGui::GetFontSize(), radius = 0.32f * type;
    ImGui::PushID(static_cast<int>(thing.part) * 100000 + static_cast<int>(thing.index));
    if (ImGui::Selectable("##line", state.selected == thing)) act(selection_of(*state.scene, thing));
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddCircleFilled({at.x + 0.6f * type, at.y + 0.5f * type}, radius, ImGui::GetColorU32(color));
    list->AddCircle({at.x + 0.6f * type, at.y + 0.5f * type}, radius, IM_COL32(255, 255, 255, 60));
    const float right = ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(kind).x;
    list->PushClipRect(at, {right - 0.5f * type, at.y + 2 * type}, true);
    list->AddText({at.x + 1.4f * type, at.y}, ImGui::GetColorU32(ImGuiCol_Text), printable(name, 60).c_str());
    list->PopClipRect();
    list->AddText({right, at.y}, ImGui::GetColorU32(quiet), kind);
    ImGui::PopID();
}

// Cameras that the scene file places, not the glTF.
std::vector<size_t> own_cameras(const Scene& scene) {
    std::vector<size_t> own;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        if (!properties_of(scene, Part::camera, i).empty()) own.push_back(i);
    return own;
}

void draw_list(const ViewState& state, const Act& act) {
    const Scene& scene = *state.scene;
    const double seconds = seconds_of(state);
    small_heading("Lights");
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const LightSource& light = scene.lights[i];
        draw_line(state, {Part::light, i}, light.name, std::string(traits_of(light.kind).noun).c_str(),
                  hue_of(light.color.at(seconds)), act);
    }
    if (scene.lights.empty()) ImGui::TextDisabled("none");
    small_heading("Fog");
    for (size_t i = 0; i < scene.media.size(); ++i) {
        const MediumSource& medium = scene.media[i];
        draw_line(state, {Part::medium, i}, medium.name, kind_name(medium), shown_color(medium.albedo.at(seconds)),
                  act);
    }
    if (scene.media.empty()) ImGui::TextDisabled("none");
    small_heading("Scene");
    draw_line(state, {Part::scene, 0}, "ambient, background, exposure", "", hue_of(scene.ambient.at(seconds)), act);
    for (const size_t i : own_cameras(scene))
        draw_line(state, {Part::camera, i}, scene.cameras[i].name, "camera",
                  ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled), act);
}

void draw_selected(const ViewState& state, EditState& edits, const Act& act) {
    const Scene& scene = *state.scene;
    const PartRef thing = state.selected;
    if (thing.index >= count_of(scene, thing.part)) return;
    ImGui::Dummy({0, 0.1f * ImGui::GetFontSize()});
    ImGui::Separator();
    const std::string name = thing.part == Part::scene ? "Scene" : name_of(scene, thing.part, thing.index);
    ImGui::TextColored(accent, "%s", printable(name, 60).c_str());
    const std::vector<const Property*> properties = properties_of(scene, thing.part, thing.index);
    if (properties.empty()) ImGui::TextDisabled("belongs to the glTF; it cannot be edited here");
    ImGui::PushID(part_path(scene, thing.part, thing.index).c_str());
    for (const Property* property : properties) {
        const bool sun = thing.part == Part::light && is_distant(scene.lights[thing.index]);
        if (sun && std::string_view(property->name) == "direction") draw_sun_angles(state, thing.index, edits, act);
        draw_property(state, *property, thing.index, edits, act);
    }
    ImGui::PopID();
}
}

bool is_taken(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
}

void propose_name(const ViewState& state, EditState& edits) {
    const std::string own = state.scene->file.string();
    if (edits.file_name_of == own) return;
    edits.file_name_of = own, edits.file_name = proposed_name(*state.session);
    edits.file_exists = is_taken(edits.file_name);
}

void draw_tabs(const ViewState& state, const Act& act) {
    const float width = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    const auto tab = [&](const char* label, const char* name, bool shown) {
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(shown ? ImGuiCol_Header : ImGuiCol_Button));
        if (ImGui::Button(label, {width, 0})) act({Verb::tab, {name}, {}, {}});
        ImGui::PopStyleColor();
        tip("T: the other page");
    };
    tab("Rendering", "render", !state.lights_tab);
    ImGui::SameLine();
    tab("Lights and fog", "lights", state.lights_tab);
}

void draw_lights(const ViewState& state, EditState& edits, const Act& act) {
    if (!state.session) return;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) edits.held.clear();
    draw_steps(state, act);
    draw_save_as(state, edits, act);
    // A long list has its own scroll bar.
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const Scene& scene = *state.scene;
    const size_t lines = scene.lights.size() + scene.media.size() + own_cameras(scene).size();
    if (lines > max_lines) ImGui::BeginChild("list", {0, static_cast<float>(max_lines + 6) * line});
    draw_list(state, act);
    if (lines > max_lines) ImGui::EndChild();
    draw_selected(state, edits, act);
}
}
