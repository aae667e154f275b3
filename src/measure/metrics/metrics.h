// Errors of a linear RGB image against its reference. Sums are in double and in pixel order.
//
// Pixels with a NaN or infinite channel in either image are counted and left out of everything else. With no pixel
// left, every value is NaN.
#pragma once
#include "base/image.h"

#include <cstdint>
#include <span>

namespace tyndall {
// Over all channels of all pixels, I the image and R the reference.
struct Errors {
    uint64_t pixels = 0;                                    // compared
    uint64_t non_finite_test = 0, non_finite_reference = 0; // pixels
    double mean_test = 0, mean_reference = 0;
    double bias = 0;                     // mean of I − R
    double rmse = 0, mae = 0;            // root of the mean of (I − R)², mean of |I − R|
    double p95 = 0, p99_9 = 0, most = 0; // percentiles (nearest rank) and maximum of |I − R|

    // relMSE: mean of (I − R)² / (R² + 0.01), both scaled so that mean(R) = 1; also without the largest 0.1 % of the
    // terms, which excludes single outliers.
    double rel_mse = 0, rel_mse_trimmed = 0;
};

// Both images must have the same size.
Errors measure_errors(const Image<vec3>& test, const Image<vec3>& reference);

// Pixel by pixel, of images of the same size.
Image<vec3> minus(const Image<vec3>& a, const Image<vec3>& b);

// An error relative to the reference's mean. 0 stays 0 for any mean; another error is infinite if the mean is not
// positive.
double relative(double error, double mean_reference);

// Errors of a whole sequence: bias, rmse, mae, means and relMSE over all its pixels; percentiles and maximum of the
// worst frame.
Errors pooled(std::span<const Errors> frames);

// Whether a pixel takes part in the comparison.
inline bool comparable(vec3 test, vec3 reference) { return is_finite(test) && is_finite(reference); }

// Changes between successive frames that the reference lacks: the root mean square over time and pixels of
// (I_t − I_t−1) − (R_t − R_t−1), divided by mean(R). For a single reference image, R_t − R_t−1 = 0.
class Flicker {
public:
    void add_frame(const Image<vec3>& test, const Image<vec3>& reference);
    double value() const; // NaN before the second frame

private:
    Image<vec3> error_; // I − R of the last frame
    double squares_ = 0, reference_ = 0;
    uint64_t differences_ = 0, values_ = 0;
};
}
