// All metrics of an image against its reference.
#pragma once
#include "measure/metrics/exr_colors.h"
#include "measure/metrics/flip.h"
#include "measure/metrics/halves.h"
#include "measure/metrics/metrics.h"

#include <optional>
#include <utility>
#include <vector>

namespace tyndall {
// Viewing conditions of perceptual metrics; the same for all frames of a sequence.
struct Viewing {
    FlipExposures exposures;
    double pixels_per_degree = flip_pixels_per_degree;
    double mean_luminance = 0; // of the reference
};

// The viewing conditions for a reference, and those that suit all frames of a sequence.
Viewing viewing_of(const Image<vec3>& reference);
Viewing covering(std::span<const Viewing> frames);

struct Comparison {
    Errors beauty;
    std::vector<std::pair<std::string, Errors>> layers; // those both files have, by name
    bool stylized = false;                              // one of the two is: differences in look, not errors
    double ssim = 0, flip = 0, flip_ldr = 0; // flip: over all exposures; flip_ldr: as stored, clamped to 0..1
    // Root mean square of the image's own standard errors, when it has a layer Variance: the noise in rmse.
    std::optional<double> noise;
    // When the reference has the layers half_a and half_b: mean squared error unbiased by the reference's noise, and
    // when the image has them too, the square of its bias. In squared units of the image.
    std::optional<Estimate> mse, bias_squared;

    // E: the relative RMSE of the image or of its fog light (`inscatter`), whichever is larger.
    double worst_rmse() const;

    // Non-finite pixels that were left out, in the image, the reference and their layers.
    uint64_t non_finite() const;
};

// Throws Error (refused) when the frames do not match. The FLIP map goes to `flip_map` if given.
Comparison compare(const ExrColors& test, const ExrColors& reference, const Viewing& viewing,
                   Image<float>* flip_map = nullptr);

// A sequence as a whole: errors pooled over all frames, SSIM, FLIP and the unbiased estimates averaged. Layers and
// estimates are included only if every frame has them.
Comparison pooled(std::span<const Comparison> frames);
}
