// The strip below the picture: what is looked into.
#pragma once
#include "panels.h"

namespace tyndall {
// Its height; 0 when nothing is looked into.
float inspector_height(const ViewState& state, float whole);
void draw_inspector(ViewState& state, const PanelResources& resources, const Act& act);
}
