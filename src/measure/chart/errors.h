// Errors of an image against a reference in two independent halves, unbiased by the halves' noise.
#pragma once
#include "measure/chart/reference.h"
#include "measure/metrics/comparison.h"

namespace tyndall {
// Relative to the reference's mean, except for relMSE and FLIP.
struct ChartErrors {
    double error = 0; // E: of the image or of its fog light, whichever is larger
    // Standard deviations of E and of inscatter_rmse, from the reference's noise.
    double uncertainty = 0, inscatter_uncertainty = 0;
    double rmse = 0, inscatter_rmse = 0;
    double bias = 0, inscatter_bias = 0; // mean differences
    double rel_mse = 0;
    double flip = 0; // of the image as displayed; includes the reference's noise
};

// The reference that one kind of mode is compared with.
struct ReferenceMetrics {
    std::array<ColorLayers, 2> halves;
    ColorLayers shown_mean; // the whole reference, for display and for the means below
    ColorLayers added;      // light to add to an image for display; empty = none
    Viewing viewing;
    double mean = 0, inscatter_mean = 0;
};

// `lights_only`: for images without ambient light, emission and background.
ReferenceMetrics make_metrics(const Reference& reference, bool lights_only);

// The image plus the light it was measured without.
Image<vec3> whole(const ReferenceMetrics& reference_metrics, const Image<vec3>& color);

ChartErrors chart_errors(const ReferenceMetrics& reference_metrics, const ColorLayers& picture);

// The least-squares factor from an image's fog light to the reference's: <I, R> / <I, I>; 1 for black fog.
double fitted_gain(const ReferenceMetrics& reference_metrics, const ColorLayers& picture);
ColorLayers with_gain(const ColorLayers& picture, double gain);

// Root mean square of changes from frame to frame that the reference lacks, relative to its mean; unbiased by the
// reference's noise. NaN for fewer than two frames.
double chart_flicker(std::span<const ReferenceMetrics> frames, std::span<const ColorLayers> pictures);
}
