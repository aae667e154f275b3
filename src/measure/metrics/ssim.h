// Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004): 1 for equal pictures.
#pragma once
#include "base/image.h"

namespace tyndall {
// SSIM at every pixel of two pictures in 0..1: Gaussian windows of 11 × 11 with σ = 1.5, K1 = 0.01, K2 = 0.03.
Image<double> ssim_map(const Image<double>& test, const Image<double>& reference);

// Of the finite pixels; 0 when there is none.
double mean_luminance(const Image<vec3>& image);

// Mean SSIM of the luminance as a display shows it: exposed so that `mean`, the reference's mean luminance, becomes
// middle grey (0.18; left alone if it is 0), ACES curve, sRGB; the same for both pictures. Windows where the reference
// is black (mean up to 1e-3 after that) do not count, for there SSIM means nothing; when none counts, 1 for equal
// pictures and else 0. Pixels that are not finite in either picture are black in both.
double ssim(const Image<vec3>& test, const Image<vec3>& reference, double mean);
}
