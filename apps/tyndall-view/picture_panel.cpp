// The picture, what the mouse does on it, and the line of status.
#include "picture_panel.h"

#include "base/error.h"
#include "base/text.h"
#include "handles_panel.h"
#include "theme.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr float degrees_a_height = 180; // of turning, for a drag as long as the picture is high

// The largest rectangle of the picture's shape in the space there is.
PicturePlace fitted(ImVec2 corner, ImVec2 space, ivec2 size) {
    const float scale = std::min(space.x / static_cast<float>(size.x), space.y / static_cast<float>(size.y));
    const ImVec2 extent{scale * static_cast<float>(size.x), scale * static_cast<float>(size.y)};
    const ImVec2 low{std::floor(corner.x + 0.5f * (space.x - extent.x)),
                     std::floor(corner.y + 0.5f * (space.y - extent.y))};
    return {low, {low.x + extent.x, low.y + extent.y}};
}

// Mouse on the picture: turning, shifting, looking around, nearer and further.
void move_camera(const PicturePlace& place, const Act& act) {
    const ImGuiIO& io = ImGui::GetIO();
    const double x = io.MouseDelta.x / place.height(), y = -io.MouseDelta.y / place.height();
    if (ImGui::IsItemActive() && (x != 0 || y != 0)) {
        const bool shift = ImGui::IsMouseDown(ImGuiMouseButton_Middle) || io.KeyShift;
        if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
            act({Verb::turn, {}, {0.5 * degrees_a_height * x, 0.5 * degrees_a_height * y}, {}});
        else if (shift)
            act({Verb::pan, {}, {x, y}, {}});
        else
            act({Verb::orbit, {}, {degrees_a_height * x, degrees_a_height * y}, {}});
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) act({Verb::dolly, {}, {std::pow(0.9, io.MouseWheel)}, {}});
}

struct Words {
    std::string text;
    ImVec4 color;
};

// Words side by side on a dark band, so that they can be read on any picture.
void draw_band(ImVec2 at, const std::vector<Words>& words, float width) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float pad = 0.4f * ImGui::GetFontSize(), gap = words.size() > 1 ? 2.5f * pad : 0;
    ImVec2 extent{0, 0};
    for (const Words& one : words) {
        const ImVec2 size = ImGui::CalcTextSize(one.text.c_str(), nullptr, false, width);
        extent.x += size.x + (&one == &words[0] ? 0 : gap), extent.y = std::max(extent.y, size.y);
    }
    list->AddRectFilled(at, {at.x + extent.x + 2 * pad, at.y + extent.y + pad}, IM_COL32(12, 12, 13, 200), 3);
    float x = at.x + pad;
    for (const Words& one : words) {
        list->AddText(nullptr, 0, {x, at.y + 0.5f * pad}, ImGui::GetColorU32(one.color), one.text.c_str(), nullptr,
                      width);
        x += ImGui::CalcTextSize(one.text.c_str(), nullptr, false, width).x + gap;
    }
}

// The line between two techniques, which the mouse can take along, and their names.
void draw_wipe(const PicturePlace& place, const ViewState& state, const ShownPicture& picture, const Act& act) {
    const float type = ImGui::GetFontSize(), width = place.high.x - place.low.x;
    const float x = place.low.x + state.shown.wipe * width;
    ImGui::SetCursorScreenPos({x - 0.5f * type, place.low.y});
    ImGui::InvisibleButton("wipe", {type, place.height()});
    const bool held = ImGui::IsItemActive();
    if (held && ImGui::GetIO().MouseDelta.x != 0)
        act({Verb::wipe, {}, {(ImGui::GetIO().MousePos.x - place.low.x) / width}, {}});
    if (held || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const ImU32 color = ImGui::GetColorU32(held ? accent : ImVec4(0.85f, 0.85f, 0.87f, 0.8f));
    ImGui::GetWindowDrawList()->AddLine({x, place.low.y}, {x, place.high.y}, color, 1.5f);
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const float left = ImGui::CalcTextSize(picture.mode.c_str()).x + 1.5f * type;
    draw_band({x - left, place.low.y + 0.5f * type}, {{picture.mode, text}}, width);
    draw_band({x + 0.7f * type, place.low.y + 0.5f * type}, {{picture.beside, text}}, width);
}

ImVec4 severity_color(const std::vector<Limit>& limits) {
    if (limits.empty() || limits[0].severity == Severity::info) return good;
    return limits[0].severity == Severity::degraded ? caution : trouble;
}

// "degraded: ambient light, and 1 more"
std::string wrongs(const std::vector<Limit>& limits) {
    if (limits.empty() || limits[0].severity == Severity::info) return "nothing known to be wrong";
    const auto alike = std::ranges::count(limits, limits[0].severity, &Limit::severity);
    std::string text = std::string(name_of(limits[0].severity)) + ": " + printable(limits[0].where, 40);
    if (alike > 1) text += formatted(", and %d more", static_cast<int>(alike) - 1);
    return text;
}
}

std::string status_line(const ViewState& state, const ShownPicture& picture) {
    const Mode& mode = find_mode(picture.mode);
    std::string text = picture.mode;
    if (picture.mode != state.mode) text += " for " + state.mode;
    text += formatted("  \u00b7  %d \u00d7 %d", picture.codes.size.x, picture.codes.size.y);
    if (picture.codes.size != picture.wanted) text += formatted(" of %d \u00d7 %d", picture.wanted.x, picture.wanted.y);
    text += formatted("  \u00b7  %d %s", picture.samples, picture.samples == 1 ? "sample" : "samples");
    text += formatted("  \u00b7  %.*f ms", picture.times.total() < 0.01 ? 1 : 0, 1e3 * picture.times.total());
    return text + "  \u00b7  " + std::string(name_of(mode.accuracy));
}

void draw_picture(ViewState& state, const Shelf& shelf, EditMemory& edits, const Act& act) {
    const ImVec2 corner = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const ImVec4 text_color = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const float type = ImGui::GetFontSize();
    if (!shelf.picture || space.x < 8 || space.y < 8) {
        if (state.message.empty() && state.file_error.empty())
            ImGui::TextDisabled("loading %s ...", state.scene_file.filename().c_str());
    } else {
        const PicturePlace place = fitted(corner, space, shelf.picture->wanted);
        ImGui::GetWindowDrawList()->AddImage(shelf.texture, place.low, place.high);
        if (!shelf.picture->beside.empty()) draw_wipe(place, state, *shelf.picture, act);
        ImGui::SetCursorScreenPos(corner);
        ImGui::InvisibleButton("picture", space,
                               ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                                   ImGuiButtonFlags_MouseButtonMiddle);
        if (!draw_handles(state, shelf.picture->wanted, place, edits, act)) move_camera(place, act);

        // Always on the picture: what it is, how good it is, what is wrong with it.
        const float line = 1.5f * type, width = place.high.x - place.low.x - 2 * type;
        std::vector<Words> words{{status_line(state, *shelf.picture), text_color}};
        if (shelf.picture->mode == state.mode) words.push_back({wrongs(shelf.limits), severity_color(shelf.limits)});
        draw_band({place.low.x + 0.5f * type, place.high.y - line - 0.5f * type}, words, width);
    }
    const ImVec2 above{corner.x + 0.5f * type, corner.y + 0.5f * type};
    if (shelf.saving >= 0)
        draw_band(above, {{formatted("writing, %.0f %%", 100 * shelf.saving), accent}}, space.x - 2 * type);
    else if (!state.file_error.empty())
        draw_band(above, {{state.file_error, trouble}}, space.x - 2 * type);
    else if (!state.message.empty())
        draw_band(above, {{state.message, state.message_is_error ? trouble : text_color}}, space.x - 2 * type);
}
}
