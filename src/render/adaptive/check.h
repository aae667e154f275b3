// Measures the integrator's error of an image again, with independent samples.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
// Checks of a candidate's image; each but the last may switch to a finer candidate.
inline constexpr uint32_t max_checks = 3;

// A finished image to check, or a pilot image of one still to be rendered.
struct CheckedImage {
    const Layers& layers;    // show where errors are likely
    Noise noise;             // of the image
    double samples = 0;      // per pixel, that give that noise
    double done = 0;         // samples per pixel so far
    bool may_restart = true; // whether a finer candidate may start over
};

// Measures the integrator's error of a finished image on tiles where the image shows that errors are likely,
// independent of the tiles the candidate was chosen by. If that error and the image's noise together exceed the goal,
// may return a finer candidate: one that takes less work than more samples would. With a time limit, few tiles are
// measured after `until`, by the goal's clock.
Choice check_choice(const Choice& choice, const CheckedImage& picture, double until, const Mode& mode, const View& view,
                    const Snapshot& snapshot, const Settings& settings, const Goal& goal, uint32_t salt,
                    const FrameOptions& options);
}
