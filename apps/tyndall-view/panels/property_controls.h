// The label and control of one property of a light, fog or the scene.
#pragma once
#include "panels.h"
#include "viewer/editing/property_words.h"

namespace tyndall {
// Elevation and azimuth of a sun: another way to set its direction.
void draw_sun_place(const ViewState& state, size_t light, const EditMemory& memory, const Act& act);

void draw_property(const ViewState& state, const Property& property, size_t index, EditMemory& memory, const Act& act);
}
