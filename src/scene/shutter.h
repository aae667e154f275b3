// When a camera's shutter lets light in, in frames counted from the frame.
#pragma once
#include <vector>

namespace tyndall {
struct Shutter {
    double open = 0, close = 0; // equal: the frame is one moment
    // How much light gets through at even times from opening to closing, straight in between; empty = always all.
    std::vector<float> curve;

    explicit operator bool() const { return close > open; }
    double middle() const { return 0.5 * (open + close); }
};

// Moments that stand for equal shares of the light: the middle of each share.
std::vector<double> shutter_times(const Shutter& shutter, int count);
}
