// A pixel's samples on their way to means, and to the spread of its batches.
#pragma once
#include "render/frame/samples.h"

namespace tyndall {
// Mean of numbers that come one by one, and the variance of that mean (Welford 1962).
struct RunningMean {
    glm::dvec3 mean{0}, squares{0}; // squares: summed squared deviations from the mean
    int count = 0;

    void add(vec3 value);
    vec3 variance() const; // squares / (n (n-1)); 0 for fewer than two
};

// What makes up the colour goes through the means of batches; everything else is summed over all samples.
struct PixelSum {
    vec3 surface{0}, background{0}, inscatter{0}; // of the current batch
    RunningMean surface_mean, background_mean, inscatter_mean, color_mean, half_means[2];
    float weight = 0, alpha = 0, transmittance = 0, validity = 0; // weighted
    int kept = 0;                                                 // samples
    float depth = infinity, off_center = infinity;

    void add(const PixelSample& sample);
    vec3 mean_color() const;
    void end_batch(int samples); // even batches go to the first half, odd ones to the second
};

// Writes the pixel at `p` of the layers there are; of `samples`, those not added count as black and not valid.
void store_pixel(const PixelSum& sum, int samples, ivec2 p, Layers& layers);
}
