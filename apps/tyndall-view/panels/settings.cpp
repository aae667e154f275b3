// Sliders, made from the table of settings.
#include "../theme.h"
#include "base/text.h"
#include "modes/mode.h"
#include "panels.h"
#include "viewer/state/setting_groups.h"

#include <cstdlib>
#include <sstream>

namespace tyndall {
namespace {
bool slider(const SettingRow& row, const std::string& usual, std::string& value) {
    const double number = std::strtod(value.c_str(), nullptr);
    const SliderRange range = slider_range(row, std::strtod(usual.c_str(), nullptr), number);
    const ImGuiSliderFlags flags = range.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
    if (row.integer) {
        const int64_t low = static_cast<int64_t>(range.low), high = static_cast<int64_t>(range.high);
        int64_t whole = static_cast<int64_t>(number);
        const bool changed = ImGui::SliderScalar("##value", ImGuiDataType_S64, &whole, &low, &high, "%lld", flags);
        if (changed) value = std::to_string(whole);
        return changed;
    }
    double real = number;
    const bool changed =
        ImGui::SliderScalar("##value", ImGuiDataType_Double, &real, &range.low, &range.high, "%.3g", flags);
    if (changed) value = formatted("%.7g", real);
    return changed;
}

bool choice(const SettingRow& row, std::string& value) {
    const bool is_switch = row.choices.size() == 2 && row.choices[0] == "off" && row.choices[1] == "on";
    if (is_switch) {
        bool on = value == "on";
        const bool changed = ImGui::Checkbox("##value", &on);
        if (changed) value = on ? "on" : "off";
        return changed;
    }
    bool changed = false;
    if (!ImGui::BeginCombo("##value", value.c_str())) return false;
    for (const std::string& name : row.choices)
        if (ImGui::Selectable(name.c_str(), name == value)) value = name, changed = true;
    ImGui::EndCombo();
    return changed;
}

bool color(std::string& value) {
    float rgb[3] = {1, 1, 1};
    std::sscanf(value.c_str(), "%f,%f,%f", &rgb[0], &rgb[1], &rgb[2]);
    const bool changed = ImGui::ColorEdit3("##value", rgb, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    if (changed) value = formatted("%.6g,%.6g,%.6g", rgb[0], rgb[1], rgb[2]);
    return changed;
}

void explain(const SettingRow& row, const std::string& usual) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::TextUnformatted(row.doc.c_str());
    std::string more = row.name + ", default " + usual;
    if (row.choices.empty() && row.parts == 1) more += formatted(", %g to %g %s", row.low, row.high, row.unit.c_str());
    ImGui::TextDisabled("%s", more.c_str());
    ImGui::TextDisabled("double-click: reset to default; ctrl-click: type a value");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void draw_row(ViewState& state, const SettingRow& row, const Settings& usual_settings, PanelState& memory,
              const Act& act) {
    const std::string usual = row.get(usual_settings), before = row.get(state.settings);
    ImGui::PushID(row.name.c_str());
    ImGui::AlignTextToFramePadding();
    const bool departs = usual != before;
    if (departs) ImGui::PushStyleColor(ImGuiCol_Text, accent);
    ImGui::TextUnformatted(label_of(row).c_str());
    if (departs) ImGui::PopStyleColor();
    bool hovered = ImGui::IsItemHovered();

    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1);
    std::string value = before;
    const bool changed = !row.choices.empty() ? choice(row, value)
                         : row.parts == 3     ? color(value)
                                              : slider(row, usual, value);
    const bool held = memory.held_row == row.name;
    if (changed && !held) act({Verb::set, {row.name, value}, {}, {}}), ++state.motions;
    hovered |= ImGui::IsItemHovered() && !ImGui::IsItemActive();
    if (ImGui::IsMouseDoubleClicked(0) && (hovered || ImGui::IsItemActive())) {
        memory.held_row = row.name;
        if (departs || changed) act({Verb::reset, {row.name}, {}, {}});
    }
    if (hovered) explain(row, usual);
    ImGui::PopID();
}
}

void draw_settings(ViewState& state, PanelState& memory, const Act& act) {
    if (!ImGui::IsMouseDown(0)) memory.held_row.clear();
    const Settings usual = settings_for(state.quality);
    bool first = true;
    for (const SettingGroup& group : setting_groups(find_mode(state.mode))) {
        const bool open = ImGui::CollapsingHeader(group.title.c_str(), first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
        first = false;
        if (!open) continue;
        for (const SettingRow* row : group.rows)
            if (!row->advanced) draw_row(state, *row, usual, memory, act);
        if (std::ranges::none_of(group.rows, &SettingRow::advanced)) continue;
        if (!ImGui::TreeNode((group.title + " advanced").c_str(), "advanced")) continue;
        for (const SettingRow* row : group.rows)
            if (row->advanced) draw_row(state, *row, usual, memory, act);
        ImGui::TreePop();
    }
}
}
