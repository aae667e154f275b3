// One property of a light, of fog or of the scene: its name and what changes it.
#pragma once
#include "panels.h"
#include "viewer/editing/property_words.h"

namespace tyndall {
// Where a sun stands: another way to give its direction.
void draw_sun_place(const ViewState& state, size_t light, const EditMemory& memory, const Act& act);

void draw_property(const ViewState& state, const Property& property, size_t index, EditMemory& memory, const Act& act);
}
