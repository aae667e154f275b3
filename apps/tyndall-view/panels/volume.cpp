#include "panels.h"

#include "../theme.h"
#include "base/text.h"
#include "measure/metrics/heatmap.h"
#include "plot.h"
#include "scene/scene.h"
#include "viewer/painting/volume_picture.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr const char* axis_names[] = {"x", "y", "z"};

// The color scale of the density, with the corresponding extinction.
void draw_scale(ImVec2 low, ImVec2 high, const VolumePicture& shown) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float type = ImGui::GetFontSize();
    draw_words({low.x, low.y}, quiet, "density");
    draw_words({low.x + 5 * type, low.y}, quiet, "1/m");
    const float top = low.y + 1.5f * type, bottom = high.y - 2 * type;
    constexpr int pieces = 32;
    for (int i = 0; i < pieces; ++i) {
        const auto color = [](int piece) {
            const Color8 c = heat_color(1 - piece / double{pieces});
            return IM_COL32(c.x, c.y, c.z, 255);
        };
        const float from = top + (bottom - top) * static_cast<float>(i) / pieces;
        const float to = top + (bottom - top) * static_cast<float>(i + 1) / pieces;
        list->AddRectFilledMultiColor({low.x, from}, {low.x + 0.8f * type, to}, color(i), color(i), color(i + 1),
                                      color(i + 1));
    }
    for (int i = 0; i <= 4; ++i) {
        const float y = bottom + (top - bottom) * static_cast<float>(i) / 4 - 0.5f * type;
        const double value = shown.high * i / 4;
        draw_words({low.x + 1.2f * type, y}, quiet, formatted("%.3g", value));
        draw_words({low.x + 5 * type, y}, quiet, formatted("%.3g", value * shown.extinction));
    }
}

// Returns the x of its right edge.
float draw_density(const VolumePicture& shown, void* texture, ImVec2 low, ImVec2 high) {
    const float type = ImGui::GetFontSize();
    const ImVec2 space{high.x - low.x, high.y - low.y - 1.4f * type};
    const vec2 size(shown.codes.size);
    const float scale = std::min(space.x / size.x, space.y / size.y);
    const ImVec2 end{low.x + scale * size.x, low.y + scale * size.y};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddImage(texture, low, end);
    list->AddRect(low, end, IM_COL32(70, 70, 74, 255));
    ImGui::PushClipRect(low, high, true);
    draw_words({low.x, end.y + 0.2f * type}, quiet,
               formatted("%s %.3g to %.3g m, %s %.3g to %.3g m upwards", axis_names[shown.right],
                         double(shown.box.low[shown.right]), double(shown.box.high[shown.right]), axis_names[shown.up],
                         double(shown.box.low[shown.up]), double(shown.box.high[shown.up])));
    ImGui::PopClipRect();
    return end.x;
}

void draw_controls(const ViewState& state, const VolumePicture& shown, const Act& act) {
    const VolumeRequest& asked = state.volume;
    const float type = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(9 * type);
    if (ImGui::BeginCombo("##medium", shown.medium.empty() ? "no fog" : shown.medium.c_str())) {
        for (const MediumSource& medium : state.scene->media)
            if (ImGui::Selectable(medium.name.c_str(), medium.name == shown.medium))
                act({Verb::medium, {medium.name}, {}, {}});
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(7 * type);
    const std::string axis = axis_names[asked.axis];
    const auto look = [&](VolumeLook wanted, const std::string& along) {
        if (wanted == VolumeLook::slice)
            act({Verb::slice, {along}, {asked.position}, {}});
        else
            act({Verb::project, {along, wanted == VolumeLook::mean ? "mean" : "maximum"}, {}, {}});
    };
    constexpr const char* looks[] = {"slice", "maximum", "mean"};
    if (ImGui::BeginCombo("##look", looks[static_cast<int>(asked.look)])) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(looks[i], i == static_cast<int>(asked.look))) look(static_cast<VolumeLook>(i), axis);
        ImGui::EndCombo();
    }
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(axis_names[i], asked.axis == i)) look(asked.look, axis_names[i]);
    }
    if (asked.look != VolumeLook::slice) return;
    float position = asked.position;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    const std::string place = formatted("%s = %.3g m", axis.c_str(), shown.place);
    if (ImGui::SliderFloat("##position", &position, 0, 1, place.c_str())) act({Verb::slice, {axis}, {position}, {}});
}

void draw_facts(const VolumePicture& shown) {
    if (!ImGui::BeginTable("facts", 2)) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    for (const auto& [name, value] : shown.facts) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", name.c_str());
        ImGui::TableNextColumn();
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(value.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::EndTable();
}
}

void draw_volume(const ViewState& state, const PanelResources& resources, const Act& act) {
    if (!resources.volume || !state.scene) {
        ImGui::TextDisabled("sampling the fog ...");
        return;
    }
    const VolumePicture& shown = *resources.volume;
    const ImVec2 low = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const float type = ImGui::GetFontSize(), picture = 0.46f * space.x, scale = 8 * type;
    if (shown.codes.empty()) {
        ImGui::TextDisabled("%s", shown.remark.c_str());
    } else {
        const float end = draw_density(shown, resources.volume_texture, low, {low.x + picture - type, low.y + space.y});
        draw_scale({end + type, low.y}, {end + type + scale, low.y + space.y}, shown);
    }
    ImGui::SetCursorScreenPos({low.x + picture + scale + type, low.y});
    ImGui::BeginChild("facts", {0, 0});
    draw_controls(state, shown, act);
    draw_facts(shown);
    ImGui::EndChild();
}
}
