// The label and control of one property of a light, fog or the scene.
#pragma once
#include "panels.h"
#include "viewer/editing/property_words.h"

namespace tyndall {
// Elevation and azimuth of a sun: another way to set its direction.
void draw_sun_angles(const ViewState& state, size_t light, const EditState& edits, const Act& act);

void draw_property(const ViewState& state, const Property& property, size_t index, EditState& edits, const Act& act);
}
