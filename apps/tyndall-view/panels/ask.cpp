#include "panels.h"

#include "../theme.h"
#include "base/text.h"
#include "viewer/editing/scene_session.h"

#include <imgui_stdlib.h>

namespace tyndall {
namespace {
constexpr const char* title = "Before closing";

// A scene without a scene file needs a file name first.
void save_and_go(const ViewState& state, const EditState& edits, const Act& act) {
    if (!state.session->has_file) {
        act({Verb::save_as, {edits.file_name}, {}, {}});
        if (state.message_is_error) return;
    }
    act({Verb::answer, {"save"}, {}, {}});
}

void draw_buttons(const ViewState& state, bool unsaved, bool ends_job, const EditState& edits, const Act& act) {
    const float width = 6.5f * ImGui::GetFontSize();
    if (unsaved) {
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_Header));
        const bool replaces = !state.session->has_file && edits.file_exists;
        if (ImGui::Button(replaces ? "Replace" : "Save", {width, 0})) save_and_go(state, edits, act);
        ImGui::PopStyleColor();
        ImGui::SameLine();
    }
    if (ImGui::Button(unsaved ? "Discard" : ends_job ? "Stop job" : "Close", {width, 0}))
        act({Verb::answer, {"discard"}, {}, {}});
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {width, 0}) || ImGui::IsKeyPressed(ImGui::GetIO().KeyMap[ImGuiKey_Escape], false))
        act({Verb::answer, {"cancel"}, {}, {}});
}

// Says what would be lost.
void draw_losses(const ViewState& state, bool unsaved, bool ends_job, EditState& edits) {
    const std::string name = printable(state.scene->file.filename().string(), 60);
    if (unsaved) ImGui::Text("%s has edits that are not saved.", name.c_str());
    if (unsaved && !state.session->has_file) {
        propose_name(state, edits);
        ImGui::TextDisabled("No scene file yet; save as");
        ImGui::SetNextItemWidth(-1);
        if (ImGui::InputText("##file", &edits.file_name)) edits.file_exists = is_taken(edits.file_name);
    }
    if (ends_job) {
        ImGui::Text("%s is still running; closing the window stops it.", printable(state.job->name, 80).c_str());
        ImGui::TextDisabled("Finished frames are kept.");
    }
}
}

void draw_question(const ViewState& state, const PanelResources& resources, EditState& edits, const Act& act) {
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
    const bool unsaved = has_unsaved_changes(*state.session), ends_job = state.job && state.asked->verb == Verb::close;
    // The job has ended in the meantime, without an error to show.
    if (!unsaved && !ends_job && !resources.news_is_error) act({Verb::answer, {"discard"}, {}, {}});
    draw_losses(state, unsaved, ends_job, edits);
    if (!unsaved && !resources.news.empty()) ImGui::TextWrapped("%s", resources.news.c_str());
    if (state.message_is_error && !state.message.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, trouble);
        ImGui::TextWrapped("%s", state.message.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::Dummy({0, 0.3f * ImGui::GetFontSize()});
    draw_buttons(state, unsaved, ends_job, edits, act);
    ImGui::EndPopup();
}
}
