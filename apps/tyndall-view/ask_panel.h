// The question that comes before unsaved edits would be lost.
#pragma once
#include "panels.h"

namespace tyndall {
void draw_question(const ViewState& state, EditMemory& memory, const Act& act);
}
