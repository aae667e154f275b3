// FLIP: the difference a viewer would notice when flipping between two images, 0 (none) to 1.
//
// LDR-FLIP after Andersson et al., "FLIP: A Difference Evaluator for Alternating Images" (2020); HDR-FLIP after
// Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images" (2021).
#pragma once
#include "base/image.h"

#include <span>

namespace tyndall {
// Pixels per degree of the field of view: a 3840 pixels wide, 0.7 m wide monitor seen from 0.7 m.
inline constexpr double flip_pixels_per_degree = 67;

// Linear colors, clamped to 0..1 as a display would.
Image<float> flip_ldr(const Image<vec3>& test, const Image<vec3>& reference, double pixels_per_degree);

// The exposures, in stops, at which HDR-FLIP compares two images: `count` of them, evenly spaced from start to stop.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 0; // 0 for a black reference, which is compared without exposure
};

// From the exposure at which the reference's brightest pixel is nearly white to the one at which its median is. A
// median of 0 counts as 1/1000 of the maximum.
FlipExposures flip_exposures(const Image<vec3>& reference);
// The range that covers all of them: the frames of a sequence need the same exposures, else FLIP flickers. Black frames
// do not count.
FlipExposures covering(std::span<const FlipExposures> frames);

// The largest LDR-FLIP over the exposures. Pixels that are not finite in either image are black in both.
Image<float> flip_hdr(const Image<vec3>& test, const Image<vec3>& reference, const FlipExposures& exposures,
                      double pixels_per_degree);

double flip_mean(const Image<float>& map);
}
