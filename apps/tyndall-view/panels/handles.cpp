#include "handles.h"

#include "../theme.h"
#include "base/text.h"
#include "panels.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "viewer/editing/scene_edit.h"
#include "viewer/state/edit_actions.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr ImU32 shade = IM_COL32(0, 0, 0, 150);
constexpr float still = 3; // window pixels the mouse may move in a click

// Maps image pixels to window pixels.
struct Zoom {
    vec2 low;
    float scale;
    ImVec2 operator()(vec2 pixel) const { return {low.x + scale * pixel.x, low.y + scale * pixel.y}; }
    vec2 back(ImVec2 at) const { return (vec2(at.x, at.y) - low) / scale; }
};

// A line with a dark outline, visible on any image.
void line(ImVec2 a, ImVec2 b, ImU32 color, float width) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddLine(a, b, shade, width + 2);
    list->AddLine(a, b, color, width);
}

void ring(ImVec2 middle, float radius, ImU32 color, float width) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddCircle(middle, radius, shade, 0, width + 2);
    list->AddCircle(middle, radius, color, 0, width);
}

void rays(ImVec2 middle, float from, float to, int count, ImU32 color) {
    for (int i = 0; i < count; ++i) {
        const float angle = 2 * pi * static_cast<float>(i) / static_cast<float>(count);
        const float x = std::cos(angle), y = std::sin(angle);
        line({middle.x + from * x, middle.y + from * y}, {middle.x + to * x, middle.y + to * y}, color, 1.5f);
    }
}

// The outline of a cone from its tip along a direction in the image.
void cone(ImVec2 tip, vec2 along, float length, ImU32 color) {
    const vec2 across(-along.y, along.x);
    const vec2 end = vec2(tip.x, tip.y) + length * along, side = 0.6f * length * across;
    const ImVec2 a{end.x + side.x, end.y + side.y}, b{end.x - side.x, end.y - side.y};
    line(tip, a, color, 1.5f), line(tip, b, color, 1.5f), line(a, b, color, 1.5f);
}

// The direction a light shines in the image; down when it shines along the view.
vec2 drawn_direction(const ViewState& state, ivec2 size, const LightIcon& icon) {
    const Camera camera = camera_now(state);
    const vec3 direction = light_placement(*state.scene, icon.light, seconds_of(state)).direction;
    const auto tip = pixel_of(camera, size, icon.place + 20 * pixel_size(camera, size, icon.place) * direction);
    const vec2 way = tip ? *tip - icon.pixel : vec2(0);
    return glm::length(way) > 2 ? glm::normalize(way) : vec2(0, 1);
}

void draw_icon(const ViewState& state, ivec2 size, const LightIcon& icon, ImVec2 at, bool bright, ImU32 fill) {
    const float r = 0.42f * ImGui::GetFontSize();
    const ImU32 color = bright ? ImGui::GetColorU32(accent) : IM_COL32(255, 255, 255, 130);
    const LightSource& light = state.scene->lights[icon.light];
    if (is_distant(light)) rays(at, 1.7f * r, 2.5f * r, 8, color);
    if (shines_around(light)) rays(at, 1.6f * r, 2.1f * r, 4, color);
    if (has_cone(light)) cone(at, drawn_direction(state, size, icon), 2.6f * r, color);
    ImGui::GetWindowDrawList()->AddCircleFilled(at, r, fill);
    ring(at, r, color, 1.5f);
}

ImU32 handle_color(Handle handle) {
    switch (handle) {
    case Handle::x:
        return IM_COL32(232, 92, 80, 255);
    case Handle::y:
        return IM_COL32(124, 196, 96, 255);
    case Handle::z:
        return IM_COL32(92, 148, 236, 255);
    case Handle::view:
    case Handle::direction:
        break;
    }
    return ImGui::GetColorU32(accent);
}

void draw_handle(ImVec2 from, ImVec2 to, Handle handle, bool hot) {
    if (handle == Handle::view) return;
    const ImU32 color = handle_color(handle);
    const float r = 0.3f * ImGui::GetFontSize() * (hot ? 1.35f : 1.0f);
    line(from, to, color, hot ? 3.0f : 2.0f);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddCircleFilled(to, r + 1, shade);
    list->AddCircleFilled(to, r, color);
    if (handle == Handle::direction) ring(to, r + 3, color, 1.5f);
}

void draw_words(ImVec2 at, const std::string& text) {
    const float type = ImGui::GetFontSize();
    const ImVec2 low{at.x + 1.2f * type, at.y + 0.7f * type}, extent = ImGui::CalcTextSize(text.c_str());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({low.x - 5, low.y - 2}, {low.x + extent.x + 5, low.y + extent.y + 2}, shade, 3);
    list->AddText(low, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

// A spot's beam, as long as the distance to its target; without a target, twice as long as its handles.
void draw_beam(const ViewState& state, ivec2 size, const LightIcon& icon, const Zoom& zoom, float length) {
    const LightSource& light = state.scene->lights[icon.light];
    if (!has_cone(light)) return;
    const Camera camera = camera_now(state);
    const double seconds = seconds_of(state);
    const LightPlacement place = light_placement(*state.scene, icon.light, seconds);
    const float meters = light.target ? glm::distance(light.target->at(seconds), place.position)
                                      : 2 * length * pixel_size(camera, size, icon.place);
    const std::vector<vec2> ends = beam_ring(camera, size, *state.scene, icon.light, seconds, meters);
    const ImU32 color = IM_COL32(255, 255, 255, 90);
    for (size_t i = 0; i < ends.size(); ++i) {
        ImGui::GetWindowDrawList()->AddLine(zoom(ends[i]), zoom(ends[(i + 1) % ends.size()]), color, 1.2f);
        if (i % (ends.size() / 4) == 0)
            ImGui::GetWindowDrawList()->AddLine(zoom(icon.pixel), zoom(ends[i]), color, 1.2f);
    }
}

// The light, and which of its handles, under the pointer.
struct Grip {
    const LightIcon* icon = nullptr;
    std::optional<Handle> handle;
};

Grip grip_at(const std::vector<LightIcon>& icons, const LightIcon* selected, std::span<const HandlePoint> handles,
             vec2 pixel, float reach) {
    if (selected)
        if (const std::optional<Handle> handle = pick_handle(handles, pixel, reach)) return {selected, handle};
    return {nearest_icon(icons, pixel, reach), {}};
}

// A press selects the light and begins a drag.
void take_hold(const ViewState& state, ivec2 size, const Grip& grip, vec2 pixel, float length, EditState& edits,
               const Act& act) {
    edits.has_mouse = true, edits.moved = false;
    if (state.playing) act({Verb::stop, {}, {}, {}});
    act(selection_of(*state.scene, {Part::light, grip.icon->light}));
    edits.drag = begin_drag(state, size, *grip.icon, grip.handle.value_or(Handle::view), pixel, length, edits.drags);
}

void drag_on(vec2 pixel, float scale, EditState& edits, const Act& act) {
    if (!edits.drag) return;
    if (ImGui::IsKeyPressed(ImGui::GetIO().KeyMap[ImGuiKey_Escape], false)) {
        if (edits.moved) act({Verb::cancel, {}, {static_cast<double>(edits.drag->number)}, {}});
        edits.drag.reset();
        return;
    }
    edits.moved |= scale * glm::distance(pixel, edits.drag->from) > still;
    if (!edits.moved || (ImGui::GetIO().MouseDelta.x == 0 && ImGui::GetIO().MouseDelta.y == 0)) return;
    for (const Action& action : drag_actions(*edits.drag, pixel)) act(action);
}

std::string place_text(const ViewState& state, const LightIcon& icon, Handle handle) {
    const LightPlacement place = light_placement(*state.scene, icon.light, seconds_of(state));
    const vec3 v = handle == Handle::direction ? place.direction : place.position;
    return formatted(handle == Handle::direction ? "%.2f  %.2f  %.2f" : "%.2f  %.2f  %.2f m", v.x, v.y, v.z);
}
}

bool draw_handles(const ViewState& state, ivec2 size, const ImageRect& place, EditState& edits, const Act& act) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) edits.has_mouse = false, edits.drag.reset();
    if (!state.scene || !state.lights_tab || !state.handles) return edits.has_mouse;
    const Zoom zoom{{place.low.x, place.low.y}, place.height() / static_cast<float>(size.y)};
    const float type = ImGui::GetFontSize(), length = 4.7f * type / zoom.scale, reach = 0.75f * type / zoom.scale;
    const vec2 pixel = zoom.back(io.MousePos);
    if (!has_camera(state)) return edits.has_mouse;
    const Camera camera = camera_now(state);

    const std::vector<LightIcon> icons = icons_in_view(state, size, 3 * type / zoom.scale);
    const LightIcon* selected = nullptr;
    for (const LightIcon& icon : icons)
        if (state.selected == PartRef{Part::light, icon.light}) selected = &icon;
    std::vector<HandlePoint> handles;
    if (selected) handles = light_handles(camera, size, *selected, *state.scene, seconds_of(state), length);

    const bool pressed = ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !io.KeyShift;
    const bool looks = ImGui::IsItemHovered() && !edits.has_mouse && (pressed || !ImGui::IsItemActive());
    const Grip grip = looks ? grip_at(icons, selected, handles, pixel, reach) : Grip{};
    if (grip.icon && pressed) take_hold(state, size, grip, pixel, length, edits, act);
    if (edits.has_mouse) drag_on(pixel, zoom.scale, edits, act);
    if (grip.icon || edits.drag) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);

    ImGui::PushClipRect(place.low, place.high, true);
    for (const LightIcon& icon : icons) {
        const vec3 color = state.scene->lights[icon.light].color.at(seconds_of(state));
        const bool bright = &icon == selected || grip.icon == &icon;
        const vec3 hue = color / std::max(max_component(color), 1e-6f);
        ImVec4 fill = shown_color(hue);
        fill.w = bright ? 1 : 0.5f;
        if (&icon == selected) draw_beam(state, size, icon, zoom, length);
        draw_icon(state, size, icon, zoom(icon.pixel), bright, ImGui::GetColorU32(fill));
    }
    if (selected)
        for (const HandlePoint& handle : handles)
            draw_handle(zoom(selected->pixel), zoom(handle.pixel), handle.handle,
                        edits.drag ? edits.drag->handle == handle.handle
                                   : grip.icon == selected && grip.handle == handle.handle);
    if (edits.drag && edits.moved && selected)
        draw_words(zoom(selected->pixel), place_text(state, *selected, edits.drag->handle));
    else if (grip.icon)
        draw_words(zoom(grip.icon->pixel), printable(state.scene->lights[grip.icon->light].name, 40));
    ImGui::PopClipRect();
    return edits.has_mouse;
}
}
