// What controls that edit the scene remember from frame to frame.
#pragma once
#include "viewer/editing/handle_drag.h"
#include "viewer/state/setting_groups.h"

#include <string>

namespace tyndall {
struct EditMemory {
    uint64_t drags = 0;       // so far: the number of the one that goes on
    std::string held;         // the property whose slider is held,
    SliderRange range;        // and how far it goes as long
    std::string refused, why; // the last edit that was refused
    bool has_mouse = false;   // since it was pressed on a light in the picture,
    bool moved = false;       // and has gone far enough to move it
    std::optional<HandleDrag> drag;
    bool file_exists = false; // there is one of the name to save as
    std::string file_name;    // to save as
    std::string file_name_of; // the scene's own file when that was proposed
};
}
