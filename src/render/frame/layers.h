// The layers of a rendered image, and its statistics.
#pragma once
#include "base/image.h"
#include "modes/settings.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tyndall {
struct Scene;

// How far an image may be from the expected value of its mode's images.
struct Noise {
    double error = 0;   // root mean square of the standard errors over linear RGB, relative to the image's mean; for
                        // color or inscatter, whichever is worse
    double bound = 0;   // the error is below this with 99.5 % (noise) or 97.5 % (all else) confidence
    double settled = 0; // the bound if the variance of each pixel were known exactly
};

inline constexpr float ray_work = 16; // of a camera ray and what it hits, in fog evaluations

// Pixels of the crop window. Colors are premultiplied linear Rec.709.
struct Layers {
    ivec2 display{0}, low{0}, size{0};        // full image; where the pixels lie in it
    Image<vec3> color;                        // surfaces and background through fog, plus inscatter
    Image<float> alpha;                       // coverage: 1 - what shows of a background that is not in the color
    Image<float> depth;                       // planar z of the first opaque surface at the sample nearest the pixel's
                                              // center, meters; infinite = none
    Image<vec3> inscatter;                    // light scattered or emitted by fog, through BLEND surfaces in front
    Image<float> transmittance;               // of the fog, camera to surface
    Image<vec3> channel_transmittance;        // if the scene's fog is chromatic: that of each channel
    Image<float> validity;                    // of the least valid segment of a sample
    Image<vec3> variance, inscatter_variance; // of the means `color` and `inscatter`; for more than one batch
    Image<vec3> apart, inscatter_apart;       // first minus second of two batches that later images may continue
    Image<float> variance_error, inscatter_variance_error; // squared standard errors of the variances' channel means
    Image<float> work;                                     // per sample, see ray_work; for more than one batch
    Image<vec3> half_a, half_b;                            // on request: color of the even and of the odd batches
    Image<vec3> surface, background;                       // on request: the parts of the color besides inscatter
    // On request, the parts of inscatter: by light name, for every light of the scene, also dark ones; then OtherLight.
    std::vector<std::pair<std::string, Image<vec3>>> lights;
    Image<vec3> ambient, emission, multiple;
};

// Layers of inscatter by light. Lights of the same name share one; dark lights of the scene have one too, so that every
// frame has the same layers.
struct LightLayers {
    std::vector<std::string> names;
    std::vector<int> of_light; // the layer of each light
};

// Whether the scene has chromatic fog, at any time.
bool has_colored_fog(const Scene& scene);

// Scales channel_transmittance so that its mean is `transmittance`; sets inscatter to the float sum of the lights in
// their order + ambient + emission + multiple, then color to that of surface + background + inscatter, where these
// layers exist.
void add_up(Layers& layers);

// The mode's error in the limit of infinitely many samples, and the settings it was rendered with.
struct Integrator {
    Noise error; // like noise, but systematic: measured against ground truth on rays all over the image
    std::string candidate;
    Settings settings;
};

// Error of multiple scattering from a grid against path tracing, relative to path tracing's mean; for color or
// inscatter, whichever is worse.
struct OrdersError {
    Noise mean;   // of the image's mean: below 0 if it is darker than path tracing's; the bound is of its magnitude
    Noise pixels; // root mean square over pixels
};

// Share of the predicted time up to which a later forecast replaces an earlier one.
inline constexpr double early_share_of_time = 1.0 / 3;

struct FrameStats {
    double prepare_seconds = 0, render_seconds = 0;
    double fog_seconds = 0; // of both, time spent in the mode: its preparation, and its share of every thread's time
    uint64_t camera_rays = 0, steps = 0;
    uint64_t non_finite = 0; // samples dropped: they count as black and invalid
    ivec2 first_non_finite{-1};
    int samples = 0;                      // per pixel
    int moments = 1;                      // of the open shutter
    std::optional<Noise> noise;           // for more than one batch
    std::optional<Integrator> integrator; // if it was measured
    std::optional<OrdersError> orders;    // if multiple scattering from a grid was measured
    std::optional<Noise> moments_error;   // of motion blur from few moments, if it was measured
    int wanted_moments = 0;               // that the goal needs, if nothing was rendered as the frame has too few
    double goal_seconds = 0;              // all the time that counts towards a goal
    double forecast_seconds = 0;          // of it, predicted early; 0 = not predicted, infinite = out of reach

    std::optional<Noise> error() const; // noise and all other errors that were measured
    bool is_noise_alone() const { return !integrator && !orders && !moments_error; }

    void add(const FrameStats& other);          // counts and times
    void add_lost(const FrameStats& missed);    // cost of a discarded image, and the goal's forecast
    void drop(ivec2 pixel, uint64_t count = 1); // non-finite samples of a pixel
};

// The share of another image in each tile of 4×4 pixels.
struct TileShares {
    ivec2 low{0}; // coordinates of the first tile, in tiles
    Image<float> shares;
};

// Blends a share of `other` into the layers, with the variances of such a mean. Keeps the depth; recomputes the sums of
// parts.
void blend_layers(Layers& layers, const Layers& other, float share);
void blend_layers(Layers& layers, const Layers& other, const TileShares& shares);

inline constexpr double noise_deviations = 2.576; // 99.5 % quantile of the normal distribution

// 99.5 % quantile of an image's squared error over its mean, if the error comes from that many pixels of equal
// variance.
double largest_square(double pixels);

// Noise from the variances of the layers and their uncertainty, if it is independent from pixel to pixel. A layer that
// is black and free of noise has no error.
Noise noise_of(const Layers& layers);

// Noise of an image with one sample per pixel, from the differences between neighboring pixels. Their means differ too,
// so that the noise is less than the bound. The error is that along an edge, where half of the variance is noise.
Noise noise_by_neighbors(const Layers& layers);
}
