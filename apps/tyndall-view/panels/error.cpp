#include "error.h"

#include "../theme.h"
#include "base/text.h"
#include "viewer/painting/reference_picture.h"
#include "viewer/painting/tone.h"

namespace tyndall {
namespace {
ImU32 color_at(double place) {
    const Color8 color = heat_color(place);
    return IM_COL32(color.x, color.y, color.z, 255);
}
}

float draw_error_legend(ImVec2 low, float width) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float type = ImGui::GetFontSize(), pad = 0.4f * type, bar = 0.7f * type;
    const float height = bar + type + 3 * pad;
    list->AddRectFilled(low, {low.x + width, low.y + height}, IM_COL32(12, 12, 13, 215), 3);
    const float left = low.x + 2 * pad, right = low.x + width - 2 * pad, top = low.y + pad;
    constexpr int pieces = 48;
    for (int i = 0; i < pieces; ++i) {
        const float from = left + (right - left) * static_cast<float>(i) / pieces;
        const float to = left + (right - left) * static_cast<float>(i + 1) / pieces;
        const ImU32 a = color_at(i / double{pieces}), b = color_at((i + 1) / double{pieces});
        list->AddRectFilledMultiColor({from, top}, {to, top + bar}, a, b, b, a);
    }

    // Ticks at powers of ten, labeled in percent.
    for (double value = error_scale.low; value < 1.01 * error_scale.high; value *= 10) {
        const float x = left + (right - left) * static_cast<float>(heat_place(value, error_scale));
        const std::string text = formatted("%g %%", 100 * value);
        const float wide = ImGui::CalcTextSize(text.c_str()).x;
        list->AddLine({x, top}, {x, top + bar + 3}, ImGui::GetColorU32(ImGuiCol_Text));
        list->AddText({std::clamp(x - 0.5f * wide, left - pad, right - wide + pad), top + bar + pad},
                      ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    }
    return height;
}

void draw_stops_legend(ImVec2 low, float width) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float type = ImGui::GetFontSize(), pad = 0.4f * type, bar = 0.7f * type;
    list->AddRectFilled(low, {low.x + width, low.y + bar + type + 3 * pad}, IM_COL32(12, 12, 13, 215), 3);
    const float left = low.x + 2 * pad, step = (width - 4 * pad) / (highest_stop - lowest_stop), top = low.y + pad;
    for (int stop = lowest_stop; stop <= highest_stop; ++stop) {
        const float x = left + step * static_cast<float>(stop - lowest_stop);
        const Color8 color = color_of_stop(stop);
        if (stop < highest_stop)
            list->AddRectFilled({x, top}, {x + step, top + bar}, IM_COL32(color.x, color.y, color.z, 255));
        if (stop % 2 != 0) continue;
        const std::string text = stop == 0 ? "gray" : formatted("%+d", stop);
        list->AddText({x - 0.5f * ImGui::CalcTextSize(text.c_str()).x, top + bar + pad},
                      ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    }
}
}
