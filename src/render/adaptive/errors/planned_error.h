// What a plan knows about the error of its frames, apart from noise.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
struct PlannedError {
    double target = 0;                    // for the total error; 0 = none
    std::optional<Integrator> integrator; // of the candidate or the settings, in the first frame
    bool is_truth = false;                // the candidate is itself the ground truth
    std::optional<OrdersError> orders;    // for multiple scattering from a grid
    std::optional<Noise> moments{};       // error of motion blur from few moments

    bool is_checked() const { return target > 0 && integrator && !is_truth; } // on the finished image
};
}
