#include "inspector.h"

#include "ray_panel.h"

#include <imgui.h>

namespace tyndall {
float inspector_height(const ViewState& state, float whole) { return state.explain ? 0.42f * whole : 0; }

void draw_inspector(ViewState& state, const Shelf& shelf, const Act& act) {
    if (!ImGui::BeginTabBar("inspector")) return;
    bool open = true;
    if (state.explain && ImGui::BeginTabItem("Ray", &open)) {
        draw_ray(state, shelf.ray.get(), act);
        ImGui::EndTabItem();
    }
    if (!open) act({Verb::explain, {}, {}, {}});
    ImGui::EndTabBar();
}
}
