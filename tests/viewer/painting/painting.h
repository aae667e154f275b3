// Paints to the end.
#pragma once
#include "viewer/fixtures.h"
#include "viewer/painting/painter.h"
#include "viewer/painting/shown_picture.h"

#include <atomic>
#include <vector>

namespace tyndall::test {
inline std::atomic<bool> never{false}; // cancelled

// All pictures until there is none to come.
std::vector<ShownPicture> paint_all(Painter& painter, const Request& request);
}
