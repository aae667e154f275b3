// What a plan knows of the error of its frames, noise apart.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
struct PlannedError {
    double target = 0;                    // of the whole error; 0 = none was asked for
    std::optional<Integrator> integrator; // of the candidate or the settings, in the first frame
    bool is_truth = false;                // the candidate is what images are held against
    std::optional<OrdersError> orders;    // where light scatters more than once
    std::optional<Noise> moments{};       // of motion blur by few of them

    bool is_checked() const { return target > 0 && integrator && !is_truth; } // on the finished image
};
}
