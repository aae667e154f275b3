// Paints to the end.
#pragma once
#include "viewer/fixtures.h"
#include "viewer/painting/painter.h"
#include "viewer/painting/shown_picture.h"

#include <atomic>
#include <vector>

#include <chrono>
#include <thread>

namespace tyndall::test {
inline std::atomic<bool> never{false}; // cancelled

// All pictures until there is none to come.
std::vector<ShownPicture> paint_all(Painter& painter, const Request& request);

// Whether the condition comes true within ten seconds.
template<class Condition> bool eventually(const Condition& condition) {
    for (int i = 0; i < 5000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}
}
