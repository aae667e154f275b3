#include "panels.h"

#include "../theme.h"
#include "base/text.h"
#include "measure/explain/curves.h"
#include "measure/explain/report.h"
#include "measure/report/svg.h"
#include "plot.h"

#include <algorithm>

namespace tyndall {
using namespace ray_drawing;

namespace {
constexpr size_t max_lights = 5; // drawn, brightest first

// Distinguishable with color vision deficiency (Okabe and Ito 2008).
constexpr ImU32 light_colors[max_lights] = {IM_COL32(230, 159, 0, 255), IM_COL32(86, 180, 233, 255),
                                            IM_COL32(0, 178, 134, 255), IM_COL32(213, 94, 0, 255),
                                            IM_COL32(204, 121, 167, 255)};
constexpr ImU32 fog_color = IM_COL32(150, 150, 154, 255), eye_color = IM_COL32(232, 232, 236, 255);
constexpr ImU32 dark_color = IM_COL32(62, 62, 66, 255);

ImU32 faded(ImU32 color, double share) {
    const auto alpha = static_cast<ImU32>(255 * std::clamp(share, 0.0, 1.0));
    return (color & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT);
}

// A line through one value per step, broken at steps for which counts(i) is false.
template<class Value, class Counts>
void draw_curve(const Plot& plot, const RayReport& report, ImU32 color, const Value& value, const Counts& counts) {
    std::vector<ImVec2> points;
    const auto end_line = [&] {
        ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, 1.6f);
        points.clear();
    };
    double last = -1;
    for (size_t i = 0; i < report.steps.size() && report.steps[i].low < plot.range.high; ++i) {
        const RayStep& step = report.steps[i];
        if (!counts(i) || step.low > last + 1e-6 * plot.range.high) end_line();
        last = step.high;
        if (!counts(i)) continue;
        if (points.empty()) points.push_back(plot.at(step.low, value(i)));
        points.push_back(plot.at(step.middle(), value(i)));
    }
    end_line();
}

bool always(size_t) { return true; }

void draw_fog(Plot plot, const RayReport& report) {
    double most = 0;
    for (const RayStep& step : report.steps)
        if (step.low < plot.range.high) most = std::max(most, step.extinction);
    plot.y_end = most > 0 ? 1.1 * most : 1;
    draw_grid(plot, false);
    for (const RayStep& step : report.steps)
        if (step.low < plot.range.high)
            ImGui::GetWindowDrawList()->AddRectFilled({plot.x(step.low), plot.y(step.extinction)},
                                                      {plot.x(step.high), plot.high.y}, faded(fog_color, 0.4));
    draw_curve(
        plot, report, fog_color, [&](size_t i) { return report.steps[i].extinction; }, always);
}

void draw_transmittance(const Plot& plot, const RayReport& report, std::span<const size_t> lights) {
    draw_grid(plot, true);
    for (size_t l = 0; l < lights.size(); ++l) {
        const LightOnRay& light = report.lights[lights[l]];
        const std::vector<LightState> states = light_states(report, light);
        draw_curve(
            plot, report, light_colors[l], [&](size_t s) { return light.at[s].transmittance; },
            [&](size_t s) { return states[s] != LightState::out_of_reach; });
    }
    draw_curve(
        plot, report, eye_color, [&](size_t s) { return report.steps[s].to_eye; }, always);
}

void draw_light(Plot plot, const RayReport& report, std::span<const size_t> lights) {
    double most = 0;
    plot.y_end = light_scale(report, most);
    draw_grid(plot, false);
    draw_curve(
        plot, report, fog_color, [&](size_t s) { return eye_luminance(report.steps[s], report.steps[s].glow); },
        always);
    for (size_t l = 0; l < lights.size(); ++l) {
        const LightOnRay& light = report.lights[lights[l]];
        const std::vector<LightState> states = light_states(report, light);
        draw_curve(
            plot, report, light_colors[l],
            [&](size_t s) { return eye_luminance(report.steps[s], light.at[s].scattered); },
            [&](size_t s) { return states[s] != LightState::out_of_reach; });
    }
}

// A light's row: its color where it shines, paler in penumbra, dark in shadow, a thin line beyond its reach.
void draw_lit(const Plot& plot, const LightOnRay& light, ImU32 color) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const LightStretch& stretch : light.stretches) {
        if (stretch.low >= plot.range.high || stretch.high <= plot.range.low) continue;
        const ImVec2 low{plot.x(stretch.low), plot.low.y}, high{plot.x(stretch.high), plot.high.y};
        const std::string names = joined(stretch.blockers, ", ");
        if (stretch.state == LightState::out_of_reach) {
            const float y = 0.5f * (low.y + high.y);
            list->AddLine({low.x, y}, {high.x, y}, dark_color);
        } else {
            const bool dark = stretch.state == LightState::shadowed;
            const double share = stretch.state == LightState::full ? 1 : 0.25 + 0.5 * stretch.share;
            list->AddRectFilled(low, high, dark ? dark_color : faded(color, share));
            if (dark && ImGui::CalcTextSize(names.c_str()).x + 8 < high.x - low.x)
                draw_words({low.x + 4, low.y}, quiet, names);
        }
        if (ImGui::IsMouseHoveringRect(low, high))
            ImGui::SetTooltip("%s: %s from %.2f to %.2f m%s%s", light.name.c_str(),
                              std::string(name_of(stretch.state)).c_str(), stretch.low, stretch.high,
                              names.empty() ? "" : ", behind ", names.c_str());
    }
}

// Marks surfaces that the ray meets, across all plots.
void draw_surfaces(const Plot& plot, const RayReport& report) {
    for (const SurfaceOnRay& surface : report.surfaces)
        if (surface.distance <= 1.0001 * plot.range.high)
            ImGui::GetWindowDrawList()->AddLine({plot.x(surface.distance), plot.low.y},
                                                {plot.x(surface.distance), plot.high.y}, faded(eye_color, 0.6));
}

// The values under the pointer.
void draw_pointer(const Plot& plot, const RayReport& report, std::span<const size_t> lights) {
    if (!ImGui::IsMouseHoveringRect(plot.low, plot.high) || report.steps.empty()) return;
    const float x = ImGui::GetIO().MousePos.x;
    const double distance = plot.range.low + plot.range.length() * (x - plot.low.x) / (plot.high.x - plot.low.x);
    ImGui::GetWindowDrawList()->AddLine({x, plot.low.y}, {x, plot.high.y}, ImGui::GetColorU32(accent));
    for (size_t s = 0; s < report.steps.size(); ++s) {
        const RayStep& step = report.steps[s];
        if (distance < step.low || distance > step.high) continue;
        std::string text = formatted("%.3g m\nextinction %.3g /m\ntransmittance to the camera %.1f %%", distance,
                                     step.extinction, 100 * step.to_eye);
        for (const size_t l : lights)
            text += formatted("\n%s: %.1f %% through fog, adds %.3g nits/m", report.lights[l].name.c_str(),
                              100 * double(report.lights[l].at[s].transmittance),
                              eye_luminance(step, report.lights[l].at[s].scattered));
        ImGui::SetTooltip("%s", text.c_str());
    }
}

// The brightest lights that would reach some of the ray if there were no shadows.
std::vector<size_t> reaching_lights(const RayReport& report) {
    std::vector<size_t> lights = brightest_lights(report, max_lights);
    std::erase_if(lights, [&](size_t l) {
        return std::ranges::all_of(report.lights[l].stretches, [](const LightStretch& stretch) {
            return stretch.state == LightState::out_of_reach;
        });
    });
    return lights;
}

void draw_curves(const RayReport& report, ImVec2 low, ImVec2 high) {
    const float type = ImGui::GetFontSize(), left = low.x + 5 * type, lit = type;
    const std::vector<size_t> lights = reaching_lights(report);
    const float fixed = 3 * 1.3f * type + static_cast<float>(lights.size()) * (lit + 3) + 1.5f * type;
    const float unit = std::max((high.y - low.y - fixed) / 3, 1.2f * type);
    const Interval<double> range = axis_of(report);
    float y = low.y;
    const auto next = [&](const char* title) {
        ImGui::PushClipRect({left, y}, {high.x, high.y}, true);
        draw_words({left, y}, quiet, title);
        ImGui::PopClipRect();
        y += 1.3f * type;
        const Plot plot{{left, y}, {high.x, y + unit - 0.3f * type}, range, 1};
        y += unit;
        return plot;
    };
    draw_fog(next("fog: extinction, 1/m"), report);
    draw_transmittance(next("transmittance: to the camera (white), from each light (color)"), report, lights);
    draw_light(next("light to the camera, nits/m (gray: ambient and emission)"), report, lights);
    for (size_t l = 0; l < lights.size(); ++l, y += lit + 3) {
        const std::string name = shortened(report.lights[lights[l]].name, 4.8 * 12);
        draw_words({low.x, y}, ImGui::ColorConvertU32ToFloat4(light_colors[l]), name);
        draw_lit({{left, y}, {high.x, y + lit}, range, 1}, report.lights[lights[l]], light_colors[l]);
    }
    const Plot all{{left, low.y + 1.3f * type}, {high.x, y}, range, 1};
    draw_distances(all, y);
    draw_surfaces(all, report);
    draw_pointer({all.low, {high.x, y - static_cast<float>(lights.size()) * (lit + 3)}, range, 1}, report, lights);
}

ImVec4 color_of(double off) { return std::abs(off) < 0.02 ? good : std::abs(off) < 0.1 ? caution : trouble; }

void draw_result(const ModeResult& result, const ModeResult* reference, const ViewState& state, const Act& act) {
    ImGui::TableNextColumn();
    if (!reference)
        ImGui::TextColored(accent, "%s", result.mode.c_str());
    else if (ImGui::Selectable(result.mode.c_str(), result.mode == state.mode, ImGuiSelectableFlags_SpanAllColumns))
        act({Verb::mode, {result.mode}, {}, {}});
    if (ImGui::IsItemHovered() && (!result.remark.empty() || !result.limitations.empty())) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
        if (!result.remark.empty()) ImGui::TextUnformatted(result.remark.c_str());
        for (const LimitationGroup& group : groups_of(result.limitations))
            ImGui::TextUnformatted(line_of(group).c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    const auto cell = [](const ImVec4& color, const std::string& text) {
        ImGui::TableNextColumn();
        const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(room, 0.0f));
        ImGui::TextColored(color, "%s", text.c_str());
    };
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    cell(text, formatted("%.4g", double(luminance(result.inscatter))));
    cell(reference ? color_of(difference(result, *reference)) : quiet,
         !result.finite ? "not finite"
         : reference    ? formatted("%+.1f %%", 100 * difference(result, *reference))
                        : "");
    cell(text, percent(result.transmittance));
    cell(result.validity < 0.99f ? caution : quiet, percent(result.validity));
}

void draw_results(const ViewState& state, const RayAnswer& answer, const Act& act) {
    if (!ImGui::BeginTable("results", 5, ImGuiTableFlags_SizingStretchProp)) return;
    for (const char* head : {"technique", "fog, nits", "error", "transmitted", "valid"}) ImGui::TableSetupColumn(head);
    ImGui::PushStyleColor(ImGuiCol_Text, quiet);
    ImGui::TableHeadersRow();
    ImGui::PopStyleColor();
    draw_result(answer.report.reference, nullptr, state, act);
    for (const ModeResult& one : answer.report.results) draw_result(one, &answer.report.reference, state, act);
    ImGui::EndTable();
    if (!answer.complete) ImGui::TextDisabled("evaluating every technique ...");
}

std::string headline(const RayAnswer& answer) {
    const RayReport& report = answer.report;
    std::string text =
        formatted("pixel %d, %d  \u00b7  frame %d  \u00b7  ", answer.pixel.x, answer.pixel.y, answer.frame);
    text += report.hits ? formatted("%.3g m to %s", report.end, report.surfaces.back().name.c_str())
                        : std::string("to the background");
    text += formatted("  \u00b7  optical depth %.3g", report.depth);
    const size_t reaching = reaching_lights(report).size();
    if (reaching < report.lights.size())
        text += formatted("  \u00b7  %zu of %zu lights reach it", reaching, report.lights.size());
    return text;
}
}

void draw_ray(const ViewState& state, const RayAnswer* answer, const Act& act) {
    if (!answer || (state.explain && answer->pixel != *state.explain)) {
        ImGui::TextDisabled("tracing the ray ...");
        return;
    }
    ImGui::TextUnformatted(headline(*answer).c_str());
    const ImVec2 low = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const float table = 23 * ImGui::GetFontSize();
    const float split = std::min(0.58f * space.x, std::max(space.x - table, 0.4f * space.x));
    draw_curves(answer->report, low, {low.x + split, low.y + space.y});
    ImGui::SetCursorScreenPos({low.x + split + 1.5f * ImGui::GetFontSize(), low.y});
    ImGui::BeginChild("results", {0, 0});
    draw_results(state, *answer, act);
    ImGui::EndChild();
}
}
