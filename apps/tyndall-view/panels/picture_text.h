// Texts on the image: its status, errors and messages.
#pragma once
#include "handles.h"

#include <string>
#include <vector>

namespace tyndall {
struct Words {
    std::string text;
    ImVec4 color;
};

// Draws texts side by side on a dark band, readable on any image. Returns its height.
float draw_band(ImVec2 at, const std::vector<Words>& words, float width);

// The same on one band whose lower edge is `low`, or on one band each where they do not fit side by side. Returns the
// upper edge.
float draw_upwards(ImVec2 low, const std::vector<Words>& words, float width);

// The shown image in one line: mode, size, samples, time, the mode's accuracy, and its worst limitation.
std::vector<Words> status_words(const ViewState& state, const PanelResources& resources);

// Draws the reference the image is compared with, and the errors against it, from `bottom` upwards.
void draw_errors(const ImageRect& rect, float bottom, const ViewState& state, const ShownPicture& picture);

// Draws messages and progress, one band below the other.
void draw_messages(const ViewState& state, const PanelResources& resources, ImVec2 at, float width);
}
