// The one clock that times are measured with.
#pragma once
#include <chrono>

namespace tyndall {
inline double steady_seconds() { // since some moment
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}
