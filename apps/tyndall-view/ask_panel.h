// The question that comes before unsaved edits would be lost or a job ended.
#pragma once
#include "panels.h"

namespace tyndall {
void draw_question(const ViewState& state, const PanelResources& resources, EditMemory& memory, const Act& act);
}
