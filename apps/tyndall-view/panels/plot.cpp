#include "plot.h"

#include "../theme.h"
#include "base/text.h"
#include "measure/report/svg.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr ImU32 grid_color = IM_COL32(52, 52, 55, 255);

std::string figure(double value, double tick) {
    const int decimals = tick >= 1 ? 0 : static_cast<int>(std::ceil(-std::log10(tick) - 1e-9));
    return decimals > 4 ? formatted("%.2g", value) : formatted("%.*f", decimals, value);
}
}

float Plot::x(double distance) const {
    const double share = std::clamp((distance - range.low) / range.length(), 0.0, 1.0);
    return low.x + static_cast<float>(share) * (high.x - low.x);
}

float Plot::y(double value) const {
    const double share = std::clamp(value / y_end, 0.0, 1.0);
    return high.y - static_cast<float>(share) * (high.y - low.y);
}

void draw_words(ImVec2 at, const ImVec4& color, const std::string& text) {
    ImGui::GetWindowDrawList()->AddText(at, ImGui::GetColorU32(color), text.c_str());
}

void draw_grid(const Plot& plot, bool percents) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float type = ImGui::GetFontSize();
    const double tick = percents ? (plot.high.y - plot.low.y > 2.4f * type ? 0.5 : 1)
                                 : tick_of(plot.y_end, std::max((plot.high.y - plot.low.y) / (1.6f * type), 1.0f));
    for (double value = 0; value <= 1.0001 * plot.y_end; value += tick) {
        const float y = plot.y(value);
        list->AddLine({plot.low.x, y}, {plot.high.x, y}, grid_color);
        const std::string text = percents ? formatted("%.0f %%", 100 * value) : figure(value, tick);
        draw_words({plot.low.x - ImGui::CalcTextSize(text.c_str()).x - 0.4f * type, y - 0.5f * type}, quiet, text);
    }
    const double along = tick_of(plot.range.length(), 10);
    for (double x = std::ceil(plot.range.low / along) * along; x <= 1.0001 * plot.range.high; x += along)
        list->AddLine({plot.x(x), plot.low.y}, {plot.x(x), plot.high.y}, grid_color);
}

void draw_distances(const Plot& plot, float top) {
    const double along = tick_of(plot.range.length(), 10);
    for (double x = std::ceil(plot.range.low / along) * along; x <= 1.0001 * plot.range.high; x += along) {
        const std::string text = figure(x, along) + (x + along > 1.0001 * plot.range.high ? " m" : "");
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        draw_words({std::min(plot.x(x) - 0.5f * width, plot.high.x - width), top}, quiet, text);
    }
}
}
