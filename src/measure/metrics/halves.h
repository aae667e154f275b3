// Squared error against a reference that is itself noisy, given as two independent halves R1 and R2 (two renders that
// differ in their seed only): the noise of the halves cancels in the mean of the product, so the estimates are unbiased
// and can come out below 0.
#pragma once
#include "base/image.h"

namespace tyndall {
struct Estimate {
    double value = 0, standard_error = 0; // of the mean over tiles of 8 × 8 pixels; NaN with fewer than two tiles
};

// mean of (A1 − R1)·(A2 − R2) over channels and pixels that are finite in all four images.
// With A1 = A2 the mean squared error of A, noise of A included; with independent halves A1, A2 its squared bias.
Estimate product_of_errors(const Image<vec3>& a1, const Image<vec3>& a2, const Image<vec3>& r1, const Image<vec3>& r2);
}
