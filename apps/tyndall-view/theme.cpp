#include "theme.h"

#include <filesystem>

namespace tyndall {
namespace {
constexpr const char* typeface = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float type_size = 15;

void load_type(float scale) {
    ImGuiIO& io = ImGui::GetIO();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(typeface, ignored) &&
        io.Fonts->AddFontFromFileTTF(typeface, type_size * scale))
        return;
    io.Fonts->AddFontDefault();
    io.FontGlobalScale = 1.2f * scale;
}

ImVec4 gray(float value, float alpha = 1) { return {value, value, value * 1.04f, alpha}; }

ImVec4 tinted(float strength) { return {accent.x, accent.y, accent.z, strength}; }
}

void apply_theme(float scale) {
    load_type(scale);
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowPadding = {14, 12}, style.FramePadding = {8, 4}, style.ItemSpacing = {8, 7};
    style.ItemInnerSpacing = {8, 4}, style.ScrollbarSize = 12, style.GrabMinSize = 10;
    style.WindowRounding = 0, style.FrameRounding = style.GrabRounding = style.PopupRounding = 3;
    style.WindowBorderSize = 0, style.FrameBorderSize = 0, style.PopupBorderSize = 1;
    style.ScaleAllSizes(scale);

    ImVec4* colors = style.Colors;
    colors[ImGuiCol_Text] = gray(0.87f);
    colors[ImGuiCol_TextDisabled] = quiet;
    colors[ImGuiCol_WindowBg] = gray(0.125f);
    colors[ImGuiCol_ChildBg] = gray(0.125f, 0);
    colors[ImGuiCol_PopupBg] = gray(0.16f, 0.98f);
    colors[ImGuiCol_Border] = gray(0.28f);
    colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = gray(0.19f);
    colors[ImGuiCol_FrameBg] = gray(0.19f);
    colors[ImGuiCol_FrameBgHovered] = gray(0.24f);
    colors[ImGuiCol_FrameBgActive] = gray(0.28f);
    colors[ImGuiCol_SliderGrab] = gray(0.55f);
    colors[ImGuiCol_SliderGrabActive] = accent;
    colors[ImGuiCol_CheckMark] = accent;
    colors[ImGuiCol_Button] = gray(0.22f);
    colors[ImGuiCol_ButtonHovered] = gray(0.29f);
    colors[ImGuiCol_ButtonActive] = tinted(0.45f);
    colors[ImGuiCol_Header] = tinted(0.22f);
    colors[ImGuiCol_HeaderHovered] = gray(0.25f);
    colors[ImGuiCol_HeaderActive] = tinted(0.35f);
    colors[ImGuiCol_Tab] = colors[ImGuiCol_TabUnfocused] = gray(0.17f);
    colors[ImGuiCol_TabActive] = colors[ImGuiCol_TabUnfocusedActive] = tinted(0.30f);
    colors[ImGuiCol_TabHovered] = gray(0.29f);
    colors[ImGuiCol_TableHeaderBg] = gray(0.125f);
    colors[ImGuiCol_Separator] = gray(0.22f);
    colors[ImGuiCol_ScrollbarBg] = gray(0.125f, 0);
    colors[ImGuiCol_ScrollbarGrab] = gray(0.27f);
    colors[ImGuiCol_ScrollbarGrabHovered] = gray(0.35f);
    colors[ImGuiCol_ScrollbarGrabActive] = gray(0.42f);
    colors[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.55f};
    colors[ImGuiCol_TextSelectedBg] = tinted(0.35f);
    colors[ImGuiCol_NavHighlight] = tinted(0.6f);
}

void tooltip(const std::string& text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}
}
