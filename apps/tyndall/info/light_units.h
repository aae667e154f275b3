// Which of the three units in use a glTF's light intensities look like.
#pragma once
#include "scene/scene.h"

#include <string>

namespace tyndall {
// A line for people when the intensities, read as they stand, look like one of Blender's exports; else empty.
std::string light_units_hint(const Scene& scene);
}
