// The image to show from a painter's state.
#pragma once
#include "viewer/painting/painter.h"

namespace tyndall {
// The mode of the right part; null if there is none or it is the reference.
const Mode* mode_beside(const Request& request);

// Whether nothing is left to do for a request: samples, reference, answers.
bool is_finished(const Painter& painter, const Request& request);

// The image that the request shows, with the answers to what it asks.
ShownPicture shown(Painter& painter, const Request& request);
}
