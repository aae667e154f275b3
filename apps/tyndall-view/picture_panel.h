// The picture with its line of status.
#pragma once
#include "panels.h"

namespace tyndall {
void draw_picture(ViewState& state, const PanelResources& resources, EditMemory& edits, const Act& act);
}
