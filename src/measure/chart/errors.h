// How far a picture is from a reference that comes as two independent halves: the halves' noise does not count.
#pragma once
#include "measure/chart/reference.h"
#include "measure/metrics/comparison.h"

namespace tyndall {
// Shares of the reference's mean, except for relMSE and FLIP.
struct ChartErrors {
    double error = 0; // E: of the picture or of its fog light, whichever is larger
    // Standard deviations of E and of inscatter_rmse, from the reference's noise.
    double uncertainty = 0, inscatter_uncertainty = 0;
    double rmse = 0, inscatter_rmse = 0;
    double bias = 0, inscatter_bias = 0; // mean differences
    double rel_mse = 0;
    double flip = 0; // of the picture as it is looked at; noise of the reference counts
};

// The reference as one kind of mode is measured against it.
struct ReferenceMetrics {
    std::array<ColorLayers, 2> halves;
    ColorLayers shown_mean; // the whole reference, to look at and to be a share of
    ColorLayers added;      // to a picture to make it whole; empty = nothing
    Viewing viewing;
    double mean = 0, inscatter_mean = 0;
};

// `lights_only`: a picture without ambient light, emission and background is measured.
ReferenceMetrics make_yardstick(const Reference& reference, bool lights_only);

// The picture with what it was measured without.
Image<vec3> whole(const ReferenceMetrics& reference_metrics, const Image<vec3>& color);

ChartErrors chart_errors(const ReferenceMetrics& reference_metrics, const ColorLayers& picture);

// The factor on a picture's fog light that brings it closest to the reference's: <I, R> / <I, I>; 1 for black fog.
double fitted_gain(const ReferenceMetrics& reference_metrics, const ColorLayers& picture);
ColorLayers with_gain(const ColorLayers& picture, double gain);

// Changes from frame to frame that the reference lacks: root of their mean square / its mean. Without the noise of the
// reference; NaN for fewer than two frames.
double chart_flicker(std::span<const ReferenceMetrics> frames, std::span<const ColorLayers> pictures);
}
