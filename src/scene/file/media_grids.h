// The grids of a scene file's medium besides its density, and their emission.
#pragma once
#include "scene/file/values.h"
#include "scene/scene.h"

namespace tyndall {
// Reads "grids" and "blackbody" of a medium whose `sequence` is known; a grid of emission makes 1 the default of
// "emission". Throws Error.
void read_grids(const Field& field, MediumSource& medium, Scene& scene);
}
