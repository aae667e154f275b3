
#include "panels.h"

#include <imgui.h>

#include <algorithm>

namespace tyndall {
float inspector_height(const ViewState& state, float whole) {
    const float most = 0.6f * whole, least = std::min(18 * ImGui::GetFontSize(), most);
    return state.explain || state.volume_shown ? std::max(0.45f * whole, least) : 0;
}

void draw_inspector(ViewState& state, const PanelResources& resources, const Act& act) {
    if (!ImGui::BeginTabBar("inspector")) return;
    bool ray = true, volume = true;
    if (state.explain && ImGui::BeginTabItem("Ray", &ray)) {
        draw_ray(state, resources.ray.get(), act);
        ImGui::EndTabItem();
    }
    if (state.volume_shown && ImGui::BeginTabItem("Volume", &volume)) {
        draw_volume(state, resources, act);
        ImGui::EndTabItem();
    }
    if (ImGui::TabItemButton("close", ImGuiTabItemFlags_Trailing)) ray = !state.explain, volume = !state.volume_shown;
    ImGui::EndTabBar();
    if (!ray) act({Verb::explain, {}, {}, {}});
    if (!volume) act({Verb::volume, {"off"}, {}, {}});
}
}
