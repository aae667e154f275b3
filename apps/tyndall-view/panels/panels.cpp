// Layout of the panels, and the list of keys.
#include "panels.h"

#include "../theme.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

constexpr float narrow_window = 62; // in font heights

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

void draw_interface(ViewState& state, const PanelResources& resources, PanelState& memory, const Act& act) {
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) ++memory.edits.drags;
    // Tab toggles the panels; it moves between fields only while text is being typed.
    ImGui::PushAllowKeyboardFocus(ImGui::GetIO().WantTextInput);
    const ImVec2 whole = ImGui::GetIO().DisplaySize;
    const float type = ImGui::GetFontSize();
    const float side = state.panels ? std::min(23 * type, 0.5f * whole.x) : 0;
    const float row = ImGui::GetFrameHeight(), rows = state.job ? 2 * row + ImGui::GetStyle().ItemSpacing.y : row;
    const float bar = state.panels ? rows + 2 * ImGui::GetStyle().WindowPadding.y : 0;
    const float strip = state.panels ? inspector_height(state, whole.y) : 0;
    // In a narrow window the strips below the image span the window, and the side panel is only as high as the image.
    const bool narrow = whole.x < narrow_window * type;
    const float low_width = narrow ? whole.x : whole.x - side, side_height = narrow ? whole.y - bar - strip : whole.y;

    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({whole.x - side, whole.y - bar - strip});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.06f, 0.06f, 0.065f, 1));
    ImGui::Begin("picture", nullptr, fixed | ImGuiWindowFlags_NoScrollWithMouse);
    draw_picture(state, resources, memory.edits, act);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();

    if (strip > 0) {
        ImGui::SetNextWindowPos({0, whole.y - bar - strip});
        ImGui::SetNextWindowSize({low_width, strip});
        ImGui::Begin("looked into", nullptr, fixed);
        draw_inspector(state, resources, act);
        ImGui::End();
    }
    if (state.panels) {
        ImGui::SetNextWindowPos({0, whole.y - bar});
        ImGui::SetNextWindowSize({low_width, bar});
        ImGui::Begin("time", nullptr, fixed);
        if (state.job) draw_job(*state.job, act);
        draw_time(state, act);
        ImGui::End();
        ImGui::SetNextWindowPos({whole.x - side, 0});
        ImGui::SetNextWindowSize({side, side_height});
        ImGui::Begin("side", nullptr, (fixed & ~ImGuiWindowFlags_NoScrollbar));
        draw_tabs(state, act);
        if (state.lights_tab)
            draw_lights(state, memory.edits, act);
        else
            draw_rendering(state, resources, memory, act);
        ImGui::End();
    }
    if (state.help) draw_help(act);
    draw_question(state, resources, memory.edits, act);
    ImGui::PopAllowKeyboardFocus();
}
}
