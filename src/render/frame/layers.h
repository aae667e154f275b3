// A picture as it is rendered, and what is known of it.
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

// How far a picture may be from the mean of all pictures its mode makes.
struct Noise {
    double error = 0; // root mean square of the standard errors over linear RGB, as a share of the picture's mean; for
                      // colour or fog light alone, whichever is worse
    double bound = 0; // the error is below this with a confidence of 99.5 % (noise) or 97.5 % (all else)
    double settled = 0; // the bound, were the variance of each pixel known for certain
};

inline constexpr float ray_work = 16; // of a camera ray and what it hits, in evaluations of fog

// Pixels of the crop window. Colours are premultiplied linear Rec.709.
struct Layers {
    ivec2 display{0}, low{0}, size{0};        // full picture; where the pixels lie in it
    Image<vec3> color;                        // surfaces and background through fog, plus fog light
    Image<float> alpha;                       // coverage: 1 - what shows of a background that is not in the colour
    Image<float> depth;                       // planar z of the first opaque surface at the sample nearest the pixel's
                                              // centre, metres; infinite = none
    Image<vec3> inscatter;                    // fog light alone, as far as BLEND surfaces in front let it through
    Image<float> transmittance;               // of the fog, eye to surface
    Image<vec3> channel_transmittance;        // where fog of the scene is coloured: that of each channel
    Image<float> validity;                    // of the least valid stretch of a sample
    Image<vec3> variance, inscatter_variance; // of the means `color` and `inscatter`; for more than one batch
    Image<vec3> apart, inscatter_apart; // of two batches: the first less the second, where others may go on in them
    Image<float> variance_error, inscatter_variance_error; // squared standard errors of the variances' channel means
    Image<float> work;                                     // of a sample, see ray_work; for more than one batch
    Image<vec3> half_a, half_b;                            // on request: colour of the even and of the odd batches
    Image<vec3> surface, background;                       // on request: the colour without fog light
    // On request, what fog light is made of: by light name, every light of the scene, dark ones too; then OtherLight.
    std::vector<std::pair<std::string, Image<vec3>>> lights;
    Image<vec3> ambient, emission, multiple;
};

// Layers of fog light by where it comes from. Lights of one name share one; dark lights of the scene have theirs, so
// that every frame holds the same layers.
struct LightLayers {
    std::vector<std::string> names;
    std::vector<int> of_light; // which of them each light goes into
};

// Whether fog of the scene dims the channels differently, at any time.
bool has_colored_fog(const Scene& scene);

// Makes the mean of the channels' transmittances that of all, and fog light, and then colour, the float sums of the
// parts there are: surface + background + inscatter, and the lights in their order + ambient + emission + multiple.
void add_up(Layers& layers);

// How far the mode is from the truth whatever the number of samples, and what it was set to.
struct Integrator {
    Noise error; // as for noise, but systematic: measured against the truth on rays spread over the picture
    std::string candidate;
    Settings settings;
};

// How far multiple scattering from a grid is from path tracing, as shares of path tracing's mean; of beauty or fog
// light, whichever is further off.
struct OrdersError {
    double mean = 0; // of the image's mean: below 0 where it is darker than path tracing's
    Noise pixels;    // root mean square over pixels
};

struct FrameStats {
    double prepare_seconds = 0, render_seconds = 0;
    double fog_seconds = 0; // of both, what the mode took: its preparation, and its share of every thread's time
    uint64_t camera_rays = 0, steps = 0;
    uint64_t non_finite = 0; // samples dropped: they count as black and not valid
    ivec2 first_non_finite{-1};
    int samples = 0;                      // per pixel
    int moments = 1;                      // while the shutter was open
    std::optional<Noise> noise;           // for more than one batch
    std::optional<Integrator> integrator; // where it was measured
    std::optional<OrdersError> orders;    // where light of several orders is part of a goal
    std::optional<Noise> moments_error;   // of motion blur by few moments, where it was measured
    double goal_seconds = 0;              // of a goal: all that its time counts
    double forecast_seconds = 0;          // of it, made in its first third; 0 = none was made, infinite = out of reach

    std::optional<Noise> error() const; // noise and all that was measured besides
    bool is_noise_alone() const { return !integrator && !orders && !moments_error; }

    void add(const FrameStats& other);          // counts and times
    void add_lost(const FrameStats& missed);    // the cost of a picture thrown away, and what was forecast for the goal
    void drop(ivec2 pixel, uint64_t count = 1); // samples of it that are not finite
};

// How much of each tile of 4×4 pixels another picture is.
struct TileShares {
    ivec2 low{0}; // the first tile's place
    Image<float> shares;
};

// Into the layers a share of other ones, with the variances of such a mean. Depth stays; parts add up again.
void blend_layers(Layers& layers, const Layers& other, float share);
void blend_layers(Layers& layers, const Layers& other, const TileShares& shares);

inline constexpr double noise_deviations = 2.576; // below which 99.5 % of a normal distribution lie

// The squared error that 99.5 % of the pictures stay below, over its mean, where it comes from so many pixels of equal
// variance.
double largest_square(double pixels);

// From the variances of the layers and how well they are known, with noise that is independent from pixel to pixel. A
// layer that is black and free of noise has no error.
Noise noise_of(const Layers& layers);

// Of an image of one sample per pixel, by how far neighbouring pixels are apart. Their means are apart as well: noise
// is less than the bound says. The error is what it is along an edge, where half of the variance is noise.
Noise noise_by_neighbours(const Layers& layers);
}
