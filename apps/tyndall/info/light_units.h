// Guesses which of the three units in use a glTF's light intensities have.
#pragma once
#include "scene/scene.h"

#include <string>

namespace tyndall {
// A one-line hint when the intensities, taken as stored, look like one of Blender's export conventions; else empty.
std::string light_units_hint(const Scene& scene);
}
