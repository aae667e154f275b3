// Paints to the end.
#pragma once
#include "fixtures.h"
#include "preview/painter.h"
#include "preview/shown_picture.h"

#include <atomic>
#include <vector>

namespace tyndall::test {
inline std::atomic<bool> never{false}; // cancelled

// All pictures until there is none to come.
std::vector<ShownPicture> paint_all(Painter& painter, const Request& request);
}
