// The picture with its line of status.
#pragma once
#include "panels.h"

namespace tyndall {
void draw_picture(ViewState& state, const Shelf& shelf, EditMemory& edits, const Act& act);
}
