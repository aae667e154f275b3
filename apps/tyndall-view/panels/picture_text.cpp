#include "picture_text.h"

#include "../theme.h"
#include "base/error.h"
#include "base/text.h"
#include "error.h"
#include "modes/mode.h"
#include "viewer/editing/missing_frames.h"
#include "viewer/painting/reference_picture.h"

#include <algorithm>

namespace tyndall {
namespace {
ImVec4 severity_color(const std::vector<LimitationGroup>& limitations) {
    if (limitations.empty() || limitations[0].worst.severity == Severity::info) return good;
    return limitations[0].worst.severity == Severity::degraded ? caution : trouble;
}

// "degraded: ambient light, and 1 more"
std::string worst_text(const std::vector<LimitationGroup>& limitations) {
    if (limitations.empty() || limitations[0].worst.severity == Severity::info) return "no known limitations";
    const Severity severity = limitations[0].worst.severity;
    const auto alike =
        std::ranges::count(limitations, severity, [](const auto& group) { return group.worst.severity; });
    std::string text = std::string(name_of(severity)) + ": " + printable(where_of(limitations[0]), 40);
    if (alike > 1) text += formatted(", and %d more", static_cast<int>(alike) - 1);
    return text;
}

std::string status_line(const ViewState& state, const ShownPicture& picture) {
    const Mode& mode = find_mode(picture.mode);
    std::string text = picture.mode;
    if (picture.mode != state.mode) text += " for " + state.mode;
    const ivec2 size(picture.codes.size.x / picture.across, picture.codes.size.y);
    text += formatted("  \u00b7  %d \u00d7 %d", size.x, size.y);
    if (size != picture.wanted) text += formatted(" of %d \u00d7 %d", picture.wanted.x, picture.wanted.y);
    text += formatted("  \u00b7  %d %s", picture.samples, picture.samples == 1 ? "sample" : "samples");
    text += formatted("  \u00b7  %.*f ms", picture.times.total() < 0.01 ? 1 : 0, 1e3 * picture.times.total());
    return text + "  \u00b7  " + std::string(name_of(mode.accuracy));
}
}

float draw_band(ImVec2 at, const std::vector<Words>& words, float width) {
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
    return extent.y + pad;
}

float draw_upwards(ImVec2 low, const std::vector<Words>& words, float width) {
    const float pad = 0.4f * ImGui::GetFontSize();
    const auto extent = [&](const std::string& text, float wrap) {
        return ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    };
    float sum = 0;
    for (const Words& one : words) sum += extent(one.text, 0).x + 2.5f * pad;
    if (sum <= width) {
        low.y -= extent("", 0).y + pad;
        draw_band(low, words, width);
        return low.y;
    }
    for (size_t i = words.size(); i-- > 0;) {
        low.y -= extent(words[i].text, width).y + pad;
        draw_band(low, {words[i]}, width);
        if (i > 0) low.y -= 0.5f * pad;
    }
    return low.y;
}

std::vector<Words> status_words(const ViewState& state, const PanelResources& resources) {
    std::vector<Words> words{{status_line(state, *resources.picture), ImGui::GetStyle().Colors[ImGuiCol_Text]}};
    if (resources.picture->mode == state.mode)
        words.push_back({worst_text(resources.limitations), severity_color(resources.limitations)});
    return words;
}

void draw_errors(const ImageRect& rect, float bottom, const ViewState& state, const ShownPicture& picture) {
    if (!picture.reference) {
        const bool wanted = state.shown.layer == ShownLayer::error || state.beside == reference_name;
        if (wanted)
            draw_band(
                {rect.low.x + 0.5f * ImGui::GetFontSize(), bottom - 1.9f * ImGui::GetFontSize()},
                {{picture.quick ? "the reference waits until motion stops" : "rendering the reference ...", quiet}},
                rect.high.x - rect.low.x);
        return;
    }
    const float type = ImGui::GetFontSize(), line = 1.9f * type, left = rect.low.x + 0.5f * type;
    const float width = rect.high.x - rect.low.x - 2 * type;
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    float y = bottom - line;
    draw_band({left, y}, {{reference_text(*picture.reference), text}}, width);
    if (picture.errors_beside)
        draw_band({left, y -= line}, {{picture.beside, accent}, {error_text(*picture.errors_beside), text}}, width);
    if (picture.errors) {
        draw_band({left, y -= line}, {{picture.mode, accent}, {error_text(*picture.errors), text}}, width);
        draw_error_legend({left, y - 2.9f * type - 0.4f * type}, std::min(26 * type, width));
    }
}

void draw_messages(const ViewState& state, const PanelResources& resources, ImVec2 at, float width) {
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const auto band = [&](const std::string& message, const ImVec4& color) {
        if (!message.empty()) at.y += draw_band(at, {{message, color}}, width) + 0.2f * ImGui::GetFontSize();
    };
    if (resources.saving >= 0) band(formatted("writing, %.0f %%", 100 * resources.saving), accent);
    if (state.job && !state.panels)
        band(formatted("%s, %.0f %%", state.job->name.c_str(), 100 * state.job->share), accent);
    band(state.file_error, trouble);
    band(state.message, state.message_is_error ? trouble : text);
    band(resources.news, resources.news_is_error ? trouble : text);
    if (state.scene) band(missing_text(*state.scene, state.frame, state.missing), trouble);
}
}
