// Lights in the picture as hands find them, and a drag of one from where it began.
#pragma once
#include "viewer/editing/light_handles.h"
#include "viewer/state/view_state.h"

namespace tyndall {
// As light_icons. Suns without a place of their own stand side by side near the upper edge of the picture, `gap` pixels
// apart.
std::vector<LightIcon> icons_in_view(const ViewState& state, ivec2 size, float gap);

// Of icons, the one nearest to a pixel within reach; null when there is none.
const LightIcon* nearest_icon(std::span<const LightIcon> icons, vec2 pixel, float reach);

struct HandleDrag {
    uint64_t number = 0;           // as in edit()
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

// What brings the light to where the pointer is now.
std::vector<Action> drag_actions(const HandleDrag& drag, vec2 to);

// A spot's beam as a ring around its axis, in pixels, where it is `metres` away; empty when a part is behind the eye.
std::vector<vec2> beam_ring(const Camera& camera, ivec2 size, const Scene& scene, size_t light, double seconds,
                            float metres);
}
