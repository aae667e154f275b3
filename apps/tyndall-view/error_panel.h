// What stands on a picture that is held against a reference.
#pragma once
#include <imgui.h>

namespace tyndall {
// The scale of the error's colours from `low` to the right, as wide as `width`; returns its height.
float draw_error_legend(ImVec2 low, float width);
}
