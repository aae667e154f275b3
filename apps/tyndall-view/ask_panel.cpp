#include "ask_panel.h"

#include "base/text.h"
#include "lights_panel.h"
#include "theme.h"

#include <imgui_stdlib.h>

namespace tyndall {
namespace {
constexpr const char* title = "Unsaved changes";

// A scene that no scene file says yet needs a name first.
void save_and_go(const ViewState& state, const EditMemory& memory, const Act& act) {
    if (!state.session->has_file) act({Verb::save_as, {memory.file_name}, {}, {}});
    if (!state.message_is_error) act({Verb::answer, {"save"}, {}, {}});
}

void draw_buttons(const ViewState& state, const EditMemory& memory, const Act& act) {
    const float width = 6.5f * ImGui::GetFontSize();
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_Header));
    const bool save = ImGui::Button("Save", {width, 0});
    ImGui::PopStyleColor();
    ImGui::SameLine();
    const bool discard = ImGui::Button("Discard", {width, 0});
    ImGui::SameLine();
    const bool cancel = ImGui::Button("Cancel", {width, 0});
    if (save) save_and_go(state, memory, act);
    if (discard) act({Verb::answer, {"discard"}, {}, {}});
    if (cancel || ImGui::IsKeyPressed(ImGui::GetIO().KeyMap[ImGuiKey_Escape], false))
        act({Verb::answer, {"cancel"}, {}, {}});
}
}

void draw_question(const ViewState& state, EditMemory& memory, const Act& act) {
    if (state.asked && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(title, nullptr,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings))
        return;
    if (!state.asked) {
        ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
        return;
    }
    const std::string name = printable(state.scene->file.filename().string(), 60);
    ImGui::Text("%s has edits that are not saved.", name.c_str());
    if (!state.session->has_file) {
        propose_name(state, memory);
        ImGui::TextDisabled("There is no scene file yet; save it as");
        ImGui::SetNextItemWidth(-1);
        ImGui::InputText("##file", &memory.file_name);
    }
    if (state.message_is_error && !state.message.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, trouble);
        ImGui::TextWrapped("%s", state.message.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::Dummy({0, 0.3f * ImGui::GetFontSize()});
    draw_buttons(state, memory, act);
    ImGui::EndPopup();
}
}
