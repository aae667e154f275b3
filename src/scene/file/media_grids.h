// What a medium of a scene file takes from grids beside its density, and how they glow.
#pragma once
#include "scene/file/values.h"
#include "scene/scene.h"

namespace tyndall {
// Reads "grids" and "blackbody" of a medium whose `sequence` is known, and what these make of "emission". Throws Error.
void read_grids(const Field& field, MediumSource& medium, Scene& scene);
}
