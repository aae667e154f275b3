// Verifies the program with the code that renders: closed forms, published values, conservation laws and invariances.
#pragma once
#include "base/math.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace tyndall {
struct Scene;

// One check: `measured` lies within `tolerance` of `expected`.
struct Check {
    std::string topic, name;
    double measured = 0, expected = 0, tolerance = 0;
    std::string basis; // of the tolerance: "rounding", "3 standard errors", ...

    bool holds() const;
};

struct VerifyControl {
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// Verifies the program by itself, in about a minute on two cores. Throws Error (internal) when cancelled.
std::vector<Check> verify_program(const VerifyControl& control);

struct VerifyOptions {
    int frame = 1;
    std::string camera; // empty = the scene's
    ivec2 size{160, 90};
    int samples = 256; // of the path tracer, per pixel; a multiple of 64
    uint32_t seed = 0;
};

// Verifies a user's scene that has fog: invariances, and the path tracer's first order against the deterministic
// reference. Throws Error.
std::vector<Check> verify_scene(const Scene& scene, const VerifyOptions& options, const VerifyControl& control);
}
