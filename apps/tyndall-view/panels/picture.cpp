// The image, and what the mouse does on it.
#include "panels.h"

#include "../theme.h"
#include "base/text.h"
#include "error.h"
#include "picture_text.h"
#include "viewer/painting/reference_picture.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr float degrees_a_height = 180; // of orbit, for a drag as long as the image is high
constexpr float still = 3;              // pixels the mouse may move in a click

// The largest rectangle of the image's aspect ratio that fits the space, centered.
ImageRect fitted(ImVec2 corner, ImVec2 space, ivec2 size) {
    const float scale = std::min(space.x / static_cast<float>(size.x), space.y / static_cast<float>(size.y));
    const ImVec2 extent{scale * static_cast<float>(size.x), scale * static_cast<float>(size.y)};
    const ImVec2 low{std::floor(corner.x + 0.5f * (space.x - extent.x)),
                     std::floor(corner.y + 0.5f * (space.y - extent.y))};
    return {low, {low.x + extent.x, low.y + extent.y}};
}

// Rectangle of the image at the current zoom, aligned to whole window pixels.
ImageRect placed(const ViewState& state, ImVec2 corner, ImVec2 space, ivec2 size) {
    if (state.zoom == 0) return fitted(corner, space, size);
    const float scale = static_cast<float>(state.zoom);
    const ImVec2 low{std::floor(corner.x + 0.5f * space.x - scale * state.zoom_at.x),
                     std::floor(corner.y + 0.5f * space.y - scale * state.zoom_at.y)};
    return {low, {low.x + scale * static_cast<float>(size.x), low.y + scale * static_cast<float>(size.y)}};
}

// The part of it that is visible.
ImageRect clipped(const ImageRect& rect, ImVec2 corner, ImVec2 space) {
    return {{std::max(rect.low.x, corner.x), std::max(rect.low.y, corner.y)},
            {std::min(rect.high.x, corner.x + space.x), std::min(rect.high.y, corner.y + space.y)}};
}

// The left one of images side by side.
ImageRect left_of(const ImageRect& rect, int across) {
    return {rect.low, {rect.low.x + (rect.high.x - rect.low.x) / static_cast<float>(across), rect.high.y}};
}

// Image coordinates under the mouse, in fractional pixels.
vec2 mouse_pixel(const ImageRect& rect, const ShownPicture& picture) {
    const ImVec2 at = ImGui::GetIO().MousePos;
    return vec2(at.x - rect.low.x, at.y - rect.low.y) * (static_cast<float>(picture.wanted.y) / rect.height());
}

// With ctrl, the wheel zooms the image by factors of two about the mouse, and a drag pans it.
void zoom_picture(const ViewState& state, const ImageRect& rect, const ShownPicture& picture, const Act& act) {
    const ImGuiIO& io = ImGui::GetIO();
    const float scale = rect.height() / static_cast<float>(picture.wanted.y);
    const vec2 middle = state.zoom > 0 ? state.zoom_at : 0.5f * vec2(picture.wanted);
    const auto zoom = [&](double to, vec2 at) { act({Verb::zoom, {formatted("%.9g", to)}, {at.x, at.y}, {}}); };
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        const double step =
            io.MouseWheel > 0 ? std::floor(std::log2(scale) + 1.01) : std::ceil(std::log2(scale) - 1.01);
        const double to = std::exp2(std::clamp(step, -6.0, 6.0));
        const vec2 point = mouse_pixel(rect, picture);
        zoom(to, point + (middle - point) * static_cast<float>(scale / to));
    } else if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        zoom(state.zoom > 0 ? state.zoom : scale, middle - vec2(io.MouseDelta.x, io.MouseDelta.y) / scale);
    }
}

// Moves the camera with the mouse: orbit, pan, look around, dolly.
void move_camera(const ImageRect& rect, const Act& act) {
    const ImGuiIO& io = ImGui::GetIO();
    const double x = io.MouseDelta.x / rect.height(), y = -io.MouseDelta.y / rect.height();
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

// Shift-click without a drag explains the pixel's ray.
void ask_about_pixel(const ImageRect& rect, const ShownPicture& picture, const Act& act) {
    const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
    const bool clicked = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left);
    if (!clicked || !ImGui::GetIO().KeyShift || std::abs(moved.x) + std::abs(moved.y) > still) return;
    const vec2 pixel = mouse_pixel(rect, picture);
    act({Verb::explain, {}, {std::fmod(pixel.x, static_cast<float>(picture.wanted.x)), pixel.y}, {}});
}

// Marks the pixel whose ray is explained, in each of the images side by side.
void mark_pixel(const ImageRect& rect, const ViewState& state, const ShownPicture& picture) {
    if (!state.explain) return;
    const float scale = rect.height() / static_cast<float>(picture.wanted.y), type = ImGui::GetFontSize();
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (int i = 0; i < picture.across; ++i) {
        const vec2 at = scale * (vec2(*state.explain) + 0.5f + vec2(i * picture.wanted.x, 0));
        const ImVec2 middle{rect.low.x + at.x, rect.low.y + at.y};
        for (const auto& [color, wide] :
             {std::pair{IM_COL32(0, 0, 0, 200), 3.5f}, {ImGui::GetColorU32(accent), 1.5f}}) {
            list->AddCircle(middle, 0.5f * type, color, 0, wide);
            for (const ImVec2 way : {ImVec2{1, 0}, ImVec2{-1, 0}, ImVec2{0, 1}, ImVec2{0, -1}})
                list->AddLine({middle.x + 0.5f * type * way.x, middle.y + 0.5f * type * way.y},
                              {middle.x + type * way.x, middle.y + type * way.y}, color, wide);
        }
    }
}

// The values of the pixel under the mouse, in the upper right.
void draw_pixel(const ImageRect& rect, const ImageRect& frame, const ViewState& state, const ShownPicture& picture) {
    const ivec2 at(glm::floor(mouse_pixel(rect, picture)));
    const ivec2 whole = picture.wanted;
    if (!ImGui::IsItemHovered() || !picture.values || at.x < 0 || at.y < 0 || at.x >= picture.across * whole.x ||
        at.y >= whole.y)
        return;
    const float share = static_cast<float>(at.x) / static_cast<float>(whole.x);
    const bool right = picture.across > 1 ? share >= 1 : !picture.beside.empty() && share >= state.shown.wipe;
    const PixelValues* values = right ? picture.values_beside.get() : picture.values.get();
    if (!values) return;
    const std::string text = pixel_text(*values, whole, {at.x % whole.x, at.y});
    const float type = ImGui::GetFontSize(), width = ImGui::CalcTextSize(text.c_str()).x + 1.3f * type;
    draw_band({std::max(frame.high.x - width, frame.low.x), frame.low.y + 0.5f * type},
              {{text, ImGui::GetStyle().Colors[ImGuiCol_Text]}}, 2 * width);
}

// The wipe line between two techniques, which the mouse can drag, and their names.
void draw_wipe(const ImageRect& rect, const ViewState& state, const ShownPicture& picture, const Act& act) {
    const float type = ImGui::GetFontSize(), width = rect.high.x - rect.low.x;
    const float x = rect.low.x + state.shown.wipe * width;
    ImGui::SetCursorScreenPos({x - 0.5f * type, rect.low.y});
    ImGui::InvisibleButton("wipe", {type, rect.height()});
    const bool held = ImGui::IsItemActive();
    if (held && ImGui::GetIO().MouseDelta.x != 0)
        act({Verb::wipe, {}, {(ImGui::GetIO().MousePos.x - rect.low.x) / width}, {}});
    if (held || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const ImU32 color = ImGui::GetColorU32(held ? accent : ImVec4(0.85f, 0.85f, 0.87f, 0.8f));
    ImGui::GetWindowDrawList()->AddLine({x, rect.low.y}, {x, rect.high.y}, color, 1.5f);
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const float left = ImGui::CalcTextSize(picture.mode.c_str()).x + 1.5f * type;
    draw_band({x - left, rect.low.y + 0.5f * type}, {{picture.mode, text}}, width);
    draw_band({x + 0.7f * type, rect.low.y + 0.5f * type}, {{picture.beside, text}}, width);
}

// The names of two images side by side.
void draw_names(const ImageRect& rect, const ViewState& state, const ShownPicture& picture) {
    const float type = ImGui::GetFontSize(), middle = 0.5f * (rect.low.x + rect.high.x);
    const ImVec4 text = ImGui::GetStyle().Colors[ImGuiCol_Text];
    const std::string wait = state.beside + (picture.quick ? ", when motion stops" : " ...");
    draw_band({rect.low.x + 0.5f * type, rect.low.y + 0.5f * type}, {{picture.mode, text}}, middle - rect.low.x);
    draw_band({middle + 0.5f * type, rect.low.y + 0.5f * type},
              {{picture.beside.empty() ? wait : picture.beside, picture.beside.empty() ? quiet : text}},
              rect.high.x - middle);
    ImGui::GetWindowDrawList()->AddLine({middle, rect.low.y}, {middle, rect.high.y}, IM_COL32(60, 60, 63, 255));
}
}

void draw_picture(ViewState& state, const PanelResources& resources, EditState& edits, const Act& act) {
    const ImVec2 corner = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const float type = ImGui::GetFontSize();
    if (!resources.picture || space.x < 8 || space.y < 8) {
        if (state.message.empty() && state.file_error.empty() && resources.news.empty())
            ImGui::TextDisabled("loading %s ...", state.scene_file.filename().c_str());
    } else {
        const ivec2 wanted = resources.picture->wanted;
        const ImageRect rect = placed(state, corner, space, {resources.picture->across * wanted.x, wanted.y});
        const ImageRect frame = clipped(rect, corner, space);
        ImGui::GetWindowDrawList()->AddImage(resources.texture, rect.low, rect.high);
        if (resources.picture->across > 1)
            draw_names(rect, state, *resources.picture);
        else if (!resources.picture->beside.empty())
            draw_wipe(rect, state, *resources.picture, act);
        ImGui::SetCursorScreenPos(corner);
        ImGui::InvisibleButton("picture", space,
                               ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                                   ImGuiButtonFlags_MouseButtonMiddle);
        draw_pixel(rect, frame, state, *resources.picture);
        if (!draw_handles(state, wanted, left_of(rect, resources.picture->across), edits, act)) {
            if (ImGui::GetIO().KeyCtrl)
                zoom_picture(state, rect, *resources.picture, act);
            else
                move_camera(rect, act);
        }
        ask_about_pixel(rect, *resources.picture, act);
        mark_pixel(rect, state, *resources.picture);

        // Always on the image: what it is, how good it is, what is wrong with it.
        const float width = frame.high.x - frame.low.x - 2 * type;
        const bool held_against = state.shown.layer == ShownLayer::error || state.beside == reference_name;
        const float bottom = held_against ? std::min(frame.high.y + 12 * type, corner.y + space.y) : frame.high.y;
        const float top =
            draw_upwards({frame.low.x + 0.5f * type, bottom - 0.5f * type}, status_words(state, resources), width);
        if (state.shown.layer == ShownLayer::stops)
            draw_stops_legend({frame.low.x + 0.5f * type, top - 3.4f * type}, std::min(26 * type, width));
        draw_errors(frame, top, state, *resources.picture);
    }
    draw_messages(state, resources, {corner.x + 0.5f * type, corner.y + 0.5f * type}, space.x - 2 * type);
}
}
