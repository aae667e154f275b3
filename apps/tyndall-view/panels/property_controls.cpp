#include "property_controls.h"

#include "../theme.h"
#include "base/srgb.h"
#include "base/text.h"
#include "panels.h"
#include "viewer/state/edit_actions.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr float label_share = 0.4f;
constexpr float highest_sun = 89.9f; // degrees: beyond it the azimuth would be lost
constexpr double slow = 0.002;       // of a vector's slider range, per pixel of dragging

bool is_degrees(const Property& property) { return std::string_view(property.unit) == "degrees"; }

std::string number_format(const Property& property, float value) {
    if (!std::isfinite(value)) return "unlimited";
    if (is_degrees(property)) return "%.3g\u00b0";
    return std::string("%.3g") + (*property.unit ? " " : "") + property.unit;
}

// The range of a slider, which stays fixed while it is held.
SliderRange held_range(const Property& property, float value, const std::string& path, const EditState& edits) {
    return edits.held == path ? edits.range : slider_range(property, value);
}

bool edit_number(const Property& property, const SliderRange& range, vec3& value) {
    return ImGui::SliderFloat("##value", &value.x, static_cast<float>(range.low), static_cast<float>(range.high),
                              number_format(property, value.x).c_str(),
                              range.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
}

bool edit_vector(const Property& property, vec3& value) {
    const float speed = static_cast<float>(slow) * (property.slider_high - property.slider_low);
    return ImGui::DragFloat3("##value", &value.x, speed, 0, 0, is_degrees(property) ? "%.1f" : "%.2f");
}

// A color patch that opens a picker, and the linear values. For colors brighter than 1 the picker shows and sets their
// ratio to the largest component.
bool edit_color(vec3& value) {
    const float bright = std::max(max_component(value), 1.0f);
    const float side = ImGui::GetFrameHeight();
    if (ImGui::ColorButton("##patch", shown_color(value), ImGuiColorEditFlags_NoTooltip, {side, side}))
        ImGui::OpenPopup("palette");
    bool changed = false;
    if (ImGui::BeginPopup("palette")) {
        float codes[3] = {srgb_encoded(value.x / bright), srgb_encoded(value.y / bright),
                          srgb_encoded(value.z / bright)};
        ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
        if (ImGui::ColorPicker3("##picker", codes, ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoInputs)) {
            value = bright * vec3(srgb_decoded(codes[0]), srgb_decoded(codes[1]), srgb_decoded(codes[2]));
            changed = true;
        }
        ImGui::EndPopup();
    }
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::SetNextItemWidth(-1);
    return ImGui::DragFloat3("##value", &value.x, 0.005f, 0, 0, "%.3g") || changed;
}

bool edit_value(const Property& property, const SliderRange& range, vec3& value) {
    ImGui::SetNextItemWidth(-1);
    switch (property.kind) {
    case ValueKind::number:
        return edit_number(property, range, value);
    case ValueKind::vector:
        return edit_vector(property, value);
    case ValueKind::color:
        return edit_color(value);
    case ValueKind::toggle:
        break;
    }
    bool on = value.x != 0;
    const bool changed = ImGui::Checkbox("##value", &on);
    value.x = on;
    return changed;
}

void explain(const Property& property, const std::string& path, bool keyed) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::TextUnformatted(words_of(property).help);
    if (keyed) ImGui::TextColored(accent, "Animated: a change sets a key at this frame.");
    std::string more = path;
    if (*property.unit) more += std::string(", ") + property.unit;
    ImGui::TextDisabled("%s", more.c_str());
    if (property.kind != ValueKind::toggle) ImGui::TextDisabled("ctrl-click: type a value");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// A diamond, the usual mark of an animated value, left of its control.
void draw_diamond(float right, float middle) {
    const float r = 0.3f * ImGui::GetFontSize(), x = right - 2 * r;
    ImGui::GetWindowDrawList()->AddQuadFilled({x, middle - r}, {x + r, middle}, {x, middle + r}, {x - r, middle},
                                              ImGui::GetColorU32(accent));
}

// Stores the reason without the path of the property, since it is shown at the property's control.
void note_refusal(const ViewState& state, Part part, const std::string& path, EditState& edits) {
    edits.refused.clear();
    if (state.message.empty() || !state.message_is_error) return;
    const std::string prefix = path + ": ";
    const bool here = state.message.starts_with(prefix);
    edits.refused = path, edits.why = with_labels(part, here ? state.message.substr(prefix.size()) : state.message);
}

// Changes within one mouse drag form one undo step; each typed value is its own.
uint64_t drag_now(const EditState& edits) { return ImGui::IsMouseDown(ImGuiMouseButton_Left) ? edits.drags : 0; }

// A label on the left; returns whether the mouse is on it.
bool draw_label(const char* text, bool keyed) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    const bool hovered = ImGui::IsItemHovered();
    const float column = label_share * ImGui::GetWindowWidth();
    const float middle = 0.5f * (ImGui::GetItemRectMin().y + ImGui::GetItemRectMax().y);
    if (keyed) draw_diamond(ImGui::GetWindowPos().x + column, middle);
    ImGui::SameLine(column);
    ImGui::SetNextItemWidth(-1);
    return hovered;
}
}

ImVec4 shown_color(vec3 linear) {
    const vec3 color = linear / std::max(max_component(linear), 1.0f);
    return {srgb_encoded(color.x), srgb_encoded(color.y), srgb_encoded(color.z), 1};
}

void draw_property(const ViewState& state, const Property& property, size_t index, EditState& edits, const Act& act) {
    const Scene& scene = *state.scene;
    const double seconds = seconds_of(state);
    vec3 value = value_at(scene, property, index, seconds);
    const bool keyed = is_keyed(scene, property, index);
    const std::string path = part_path(scene, property.part, index) + "/" + property.name;

    ImGui::PushID(property.name);
    bool hovered = draw_label(words_of(property).label, keyed);
    const SliderRange range = held_range(property, value.x, path, edits);
    ImGui::BeginGroup();
    const bool changed = edit_value(property, range, value);
    ImGui::EndGroup();
    if (ImGui::IsItemActivated()) edits.held = path, edits.range = range;
    if (changed) {
        act(action_of(scene, {property.part, index, property.name, value, seconds}, drag_now(edits)));
        note_refusal(state, property.part, path, edits);
    }
    hovered |= ImGui::IsItemHovered() && !ImGui::IsItemActive() && !ImGui::IsPopupOpen("palette");
    if (hovered) explain(property, path, keyed);
    if (edits.refused == path) {
        ImGui::PushStyleColor(ImGuiCol_Text, trouble);
        ImGui::TextWrapped("%s", edits.why.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopID();
}

void draw_sun_angles(const ViewState& state, size_t light, const EditState& edits, const Act& act) {
    const double seconds = seconds_of(state);
    const vec3 direction = light_placement(*state.scene, light, seconds).direction;
    SunAngles angles = sun_angles(direction);
    const auto slider = [&](const char* label, const char* help, float& value, float low, float high) {
        ImGui::PushID(label);
        bool hovered = draw_label(label, false);
        const bool changed = ImGui::SliderFloat("##value", &value, low, high, "%.1f\u00b0");
        hovered |= ImGui::IsItemHovered() && !ImGui::IsItemActive();
        if (hovered) ImGui::SetTooltip("%s", help);
        ImGui::PopID();
        if (changed)
            act(action_of(*state.scene, {Part::light, light, "direction", direction_from(angles), seconds},
                          drag_now(edits)));
    };
    slider("elevation", "Height of the sun above the horizon", angles.height, -10, highest_sun);
    slider("azimuth", "Direction of the sun: 0 is +z, 90 is +x", angles.azimuth, 0, 360);
}
}
