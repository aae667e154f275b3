// When a camera's shutter is open, in frames relative to the frame being rendered.
#pragma once
#include <span>
#include <vector>

namespace tyndall {
struct Shutter {
    double open = 0, close = 0; // equal: an instantaneous exposure
    // Transmission at equally spaced times from opening to closing, linear in between; empty = fully open throughout.
    std::vector<float> curve;

    explicit operator bool() const { return close > open; }
    double middle() const { return 0.5 * (open + close); }
};

// `count` times that represent equal fractions of the exposure: the midpoint of each.
std::vector<double> shutter_times(const Shutter& shutter, int count);

// A time and its share of an integral.
struct ExposedTime {
    double time = 0, weight = 0;
};

// For each of `count` equal fractions of the exposure, times and weights, which add up to 1, that average over it what
// is smooth between the times `breaks`, which ascend.
std::vector<std::vector<ExposedTime>> exposed_times(const Shutter& shutter, int count, std::span<const double> breaks);
}
