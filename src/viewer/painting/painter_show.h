// A painter's picture as it is to be seen.
#pragma once
#include "viewer/painting/painter.h"

namespace tyndall {
// The mode of the right part; null when there is none, or the reference.
const Mode* mode_beside(const Request& request);

// Whether nothing is left to do for a request: samples, reference, answers.
bool is_finished(const Painter& painter, const Request& request);

// Codes of what the request shows, with the answers to what it asks.
ShownPicture shown(Painter& painter, const Request& request);
}
