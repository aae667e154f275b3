// Light icons near the pointer, and drags of a light from where they began.
#pragma once
#include "viewer/editing/light_handles.h"
#include "viewer/state/view_state.h"

namespace tyndall {
// As light_icons(). Suns without a position are placed side by side near the upper edge of the image, `gap` pixels
// apart.
std::vector<LightIcon> icons_in_view(const ViewState& state, ivec2 size, float gap);

// The icon nearest to a pixel, within `reach`; null if there is none.
const LightIcon* nearest_icon(std::span<const LightIcon> icons, vec2 pixel, float reach);

struct HandleDrag {
    uint64_t number = 0;           // the `drag` of edit()
    std::shared_ptr<Scene> before; // lights and nodes only, as they were when the drag began
    Camera camera;
    ivec2 size{0};
    LightIcon icon;
    Handle handle = Handle::view;
    vec2 from{0};
    float length = 70; // of handles, pixels
    double seconds = 0;
};
HandleDrag begin_drag(const ViewState& state, ivec2 size, const LightIcon& icon, Handle handle, vec2 from, float length,
                      uint64_t number);

// The actions that move the light to the pointer's position `to`.
std::vector<Action> drag_actions(const HandleDrag& drag, vec2 to);

// The outline of a spot's beam at a distance of `meters`, in pixels; empty if part of it is behind the camera.
std::vector<vec2> beam_ring(const Camera& camera, ivec2 size, const Scene& scene, size_t light, double seconds,
                            float meters);
}
