// A medium's density and its grid.
#pragma once
#include "panels.h"

namespace tyndall {
// In the space that is left of the current window: picture and scale on the left, controls and facts on the right.
void draw_volume(const ViewState& state, const PanelResources& resources, const Act& act);
}
