// What is rendered: a camera, an image size and how pixels are sampled.
#pragma once
#include "base/image.h"
#include "scene/camera.h"
#include "trace/sampling/jitter.h"
#include "trace/sampling/pixel_filter.h"
#include "trace/sampling/sample_place.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tyndall {
inline constexpr int tile_side = 4; // pixels; a tile's 16 rays are traced together

// A number for each tile, usually the factor on its sample count.
struct TileFactors {
    ivec2 low{0}; // index of the first tile
    Image<uint16_t> factors;

    int at(ivec2 tile) const {
        const ivec2 p = tile - low;
        const bool inside = p.x >= 0 && p.y >= 0 && p.x < factors.size.x && p.y < factors.size.y;
        return inside ? factors.at(p.x, p.y) : 1;
    }
};

// Serialized to cache files in this order.
template<class Visit> void fields(TileFactors& tiles, Visit& visit) {
    visit(tiles.low), visit(tiles.factors.size), visit(tiles.factors.pixels);
}

// The moments of an open shutter.
struct OpenShutter {
    std::vector<Camera> cameras; // at each moment
    float motion = 0;            // pixels that the fastest object travels across the image
};

struct View {
    Camera camera;
    ivec2 size{640, 360};            // the full image (display window)
    ivec2 crop_low{0}, crop_high{0}; // pixels low..high (high excluded) to render; equal = all
    int pixel_samples = 4;
    int batches = 1;  // independent groups of equal size, each with its own random numbers
    int sections = 1; // consecutive parts of each batch, whose variance measures noise
    int leaves = 0;   // per section, if batches are the groups of a plan: a power of two; else 0
    PixelFilter filter = PixelFilter::blackman_harris;
    float filter_radius = 1.0f; // pixels
    Jitter jitter = Jitter::interleaved;
    int lamp_samples = 1;       // largest factor on the sample count around a lamp
    int edge_samples = 1;       // largest factor on the sample count where the image changes from pixel to pixel
    bool sparse = false;        // whether one pixel of each 2×2 is traced and stands for all four
    bool surface_parts = false; // whether light of surfaces and of the background is output separately
    bool fog_parts = false;     // whether light of the fog is output separately by source
    bool background = true;     // whether the background is in the image ...
    bool covered = true;        // ... and in its alpha
    uint32_t seed = 0;
    int frame = 0;            // varies the jitter from frame to frame
    bool has_history = false; // whether temporal techniques use the previous frames

    // A local light in the image, around which in-scattered light varies within a pixel.
    struct Lamp {
        vec2 at;               // pixels from the upper left
        float radius = 0;      // pixels
        vec2 axis{0, 1};       // unit: direction of a spot's beam in the image
        float half_angle = pi; // radians to each side of the axis; pi = all around
    };
    std::vector<Lamp> lamps;
    std::shared_ptr<const TileFactors> edges{};    // from the image's edges; null = none
    std::shared_ptr<const OpenShutter> shutter{};  // null = the image shows one moment
    std::shared_ptr<const TileFactors> allotted{}; // replaces the factors of lamps and edges; 0 = skips the tile
    std::shared_ptr<const TileFactors> before{};   // samples per batch of an earlier image, whose sequences this one
                                                   // continues, in equally many batches for all pixels; null = none
};

// Samples of a pixel: more around the view's lamps and at its edges, or as allotted; the same for all pixels of a 4×4
// tile. In-scattered light along a ray falls off as 1/d, with d its distance from the lamp in pixels.
int samples_of(const View& view, ivec2 pixel);
std::pair<int, int> samples_range(const View& view); // minimum and maximum over pixels

// Batches of a pixel's samples: more where it is allotted many, for a reliable estimate of its variance.
inline constexpr int many_allotted = 8, more_batches = 4; // from this factor on, if it is a multiple of more_batches
int batches_of(const View& view, ivec2 pixel);

// A sample as a member of its batch; counts the samples of the earlier image that the batch continues.
struct BatchSample {
    uint32_t batch, index, count; // count: samples of the batch once this image is done
};
BatchSample batch_sample(const View& view, ivec2 pixel, int sample);

SampleIndex sample_index(const View& view, ivec2 pixel, int sample);

// Position and weight of a sample; weights average 1.
struct SamplePoint {
    vec2 position; // pixels from the upper left of the image
    float weight = 1;
};

// The shutter moment of a sample. The samples of a pixel and batch are stratified over the moments, and so are those of
// each 2×2 pixels at one sample index. A 4×4 tile has at most four moments at one sample index, so that its rays stay
// coherent; with many samples, all its pixels have the same moment.
int moment_at(const View& view, ivec2 pixel, int sample);

// The camera ray of a sample at a position, through a point of the lens if there is one. Lens points follow a separate
// scrambled (0,2)-sequence.
Ray sample_ray(const View& view, const Camera& camera, vec2 position, SampleIndex sample);
inline Ray sample_ray(const View& view, vec2 position, SampleIndex sample) {
    return sample_ray(view, view.camera, position, sample);
}

// Importance sampled by the filter, with unit weights, or by filter times glow near a lamp.
SamplePoint sample_point(const View& view, ivec2 pixel, int sample);
}
