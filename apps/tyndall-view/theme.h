// Colors, sizes and font of the interface.
#pragma once
#include <imgui.h>

#include <string>

namespace tyndall {
inline const ImVec4 accent{0.93f, 0.68f, 0.36f, 1}, quiet{0.60f, 0.61f, 0.63f, 1}, good{0.55f, 0.76f, 0.54f, 1},
    caution{0.90f, 0.74f, 0.38f, 1}, trouble{0.91f, 0.47f, 0.40f, 1};

// Styles the current ImGui context; `scale` is 1 on screens of ordinary pixel density.
void apply_theme(float scale);

// Shows a tooltip for the last item while the mouse is over it.
void tooltip(const std::string& text);
}
