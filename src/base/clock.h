// The monotonic clock that all timings use.
#pragma once
#include <chrono>

namespace tyndall {
inline double steady_seconds() { // since an arbitrary epoch
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}
