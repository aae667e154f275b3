// Everything that is measured between a picture and its reference.
#pragma once
#include "measure/metrics/flip.h"
#include "measure/metrics/halves.h"
#include "measure/metrics/metrics.h"
#include "measure/metrics/picture.h"

#include <optional>
#include <utility>
#include <vector>

namespace tyndall {
// How pictures are looked at where metrics imitate the eye; the same for all frames of a sequence.
struct Viewing {
    FlipExposures exposures;
    double pixels_per_degree = flip_pixels_per_degree;
    double mean_luminance = 0; // of the reference
};

// The viewing conditions that suit these references.
Viewing viewing_of(const Image<vec3>& reference);
Viewing covering(std::span<const Viewing> frames);

struct Comparison {
    Errors beauty;
    std::vector<std::pair<std::string, Errors>> layers; // those both files have, by name
    bool stylised = false;                              // one of the two is: differences of looks, not errors
    double ssim = 0, flip = 0, flip_ldr = 0; // flip: over all exposures; flip_ldr: as stored, clamped to 0..1
    // Root mean square of the picture's own standard errors, when it has a layer Variance: what of rmse is noise.
    std::optional<double> noise;
    // When the reference has the layers half_a and half_b: mean squared error without the reference's noise, and when
    // the picture has them too, the square of its bias. In squared units of the picture.
    std::optional<Estimate> mse, bias_squared;

    // E: the relative RMSE of the picture or of its fog light (`inscatter`), whichever is larger.
    double worst_rmse() const;

    // Pixels left out, in the picture, its layers and those of the reference.
    uint64_t non_finite() const;
};

// Throws Error (refused) when the frames do not match. The FLIP map goes to `flip_map` if given.
Comparison compare(const Picture& test, const Picture& reference, const Viewing& viewing,
                   Image<float>* flip_map = nullptr);

// A sequence as one: errors pooled over all frames, SSIM, FLIP and the unbiased estimates averaged. Layers and
// estimates count where every frame has them.
Comparison pooled(std::span<const Comparison> frames);
}
