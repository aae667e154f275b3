// State that the scene-editing controls keep from one interface frame to the next.
#pragma once
#include "viewer/editing/handle_drag.h"
#include "viewer/state/setting_groups.h"

#include <string>

namespace tyndall {
struct EditState {
    uint64_t drags = 0;       // number of drags so far, which identifies the current one
    std::string held;         // path of the property whose slider is held
    SliderRange range;        // of that slider, fixed while it is held
    std::string refused, why; // path of the last refused edit, and the reason
    bool has_mouse = false;   // the mouse button was pressed on a light in the image
    bool moved = false;       // the mouse has moved far enough since to drag the light
    std::optional<HandleDrag> drag;
    bool file_exists = false; // a file named file_name exists
    std::string file_name;    // to save as
    std::string file_name_of; // the scene file for which file_name was proposed
};
}
