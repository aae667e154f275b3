// Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004): 1 for equal images.
#pragma once
#include "base/image.h"

namespace tyndall {
// SSIM at every pixel of two images in 0..1: Gaussian windows of 11 × 11 with σ = 1.5, K1 = 0.01, K2 = 0.03.
Image<double> ssim_map(const Image<double>& test, const Image<double>& reference);

// Mean over the finite pixels; 0 when there is none.
double mean_luminance(const Image<vec3>& image);

// Mean SSIM of the displayed luminance: both images exposed so that `mean`, the reference's mean luminance, becomes
// middle gray (0.18; unchanged if it is 0), ACES curve, sRGB. Windows where the displayed reference is black (mean up
// to 1e-3) do not count, since SSIM is meaningless there; if none counts, 1 for equal images and 0 otherwise. Pixels
// that are not finite in either image are black in both.
double ssim(const Image<vec3>& test, const Image<vec3>& reference, double mean);
}
