// Accumulates a pixel's samples into means and the variance of its batches.
#pragma once
#include "render/frame/samples.h"

namespace tyndall {
// Running mean of values, and the variance of that mean (Welford 1962).
struct RunningMean {
    glm::dvec3 mean{0}, squares{0}; // squares: summed squared deviations from the mean
    int count = 0;

    void add(vec3 value);
    vec3 variance() const; // squares / (n (n-1)); 0 for fewer than two
};

// The same with the fourth moment, which gives the uncertainty of that variance (Pébay 2008).
struct RunningSpread : RunningMean {
    glm::dvec3 cubes{0}, fourths{0}; // summed powers of deviations from the mean

    void add(vec3 value);
    // Squared standard error of the variance, averaged over channels; not an underestimate: for a normal distribution
    // half as much again; the square of the variance for two values, or if one value causes all of it.
    float variance_error() const;
};

// The parts of the color are averaged by batch; everything else is summed over all samples.
struct PixelSum {
    vec3 surface{0}, background{0}, inscatter{0}; // of the current batch
    RunningMean surface_mean, background_mean, half_means[2], fog_half_means[2];
    RunningSpread inscatter_mean, color_mean;
    float weight = 0, alpha = 0, transmittance = 0, validity = 0; // weighted
    int kept = 0;                                                 // samples
    float depth = infinity, off_center = infinity;

    void add(const PixelSample& sample);
    vec3 mean_color() const;
    void end_batch(int samples); // even batches go to the first half, odd ones to the second
};

// Writes the pixel at `p` of the existing layers; of `samples`, those not added count as black and invalid.
void store_pixel(const PixelSum& sum, int samples, ivec2 p, Layers& layers);
}
