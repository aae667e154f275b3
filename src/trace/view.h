// What is rendered: a camera, a picture size and how its pixels are sampled.
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
// A number for each tile of 4×4 pixels: most often, how many times as many samples it takes.
struct TileFactors {
    ivec2 low{0}; // the first tile's place
    Image<uint16_t> factors;

    int at(ivec2 tile) const {
        const ivec2 p = tile - low;
        const bool inside = p.x >= 0 && p.y >= 0 && p.x < factors.size.x && p.y < factors.size.y;
        return inside ? factors.at(p.x, p.y) : 1;
    }
};

// Of cache files, in this order.
template<class Visit> void fields(TileFactors& tiles, Visit& visit) {
    visit(tiles.low), visit(tiles.factors.size), visit(tiles.factors.pixels);
}

// While the shutter is open.
struct OpenShutter {
    std::vector<Camera> cameras; // at each moment
    float motion = 0;            // pixels that the fastest thing travels on the picture
};

struct View {
    Camera camera;
    ivec2 size{640, 360};            // the full picture (display window)
    ivec2 crop_low{0}, crop_high{0}; // pixels low..high (high excluded) to render; equal = all
    int pixel_samples = 4;
    int batches = 1;  // independent groups of equally many samples, each with random numbers of its own
    int sections = 1; // of each batch, in its order, whose spread tells noise
    int leaves = 0;   // of each section, where batches are a plan's groups: a power of two; 0 = they are not
    PixelFilter filter = PixelFilter::blackman_harris;
    float filter_radius = 1.0f; // pixels
    Jitter jitter = Jitter::interleaved;
    int lamp_samples = 1;       // most times as many samples around a lamp
    int edge_samples = 1;       // most times as many samples where the picture changes from pixel to pixel
    bool surface_parts = false; // whether the light of surfaces and of the background is wanted apart
    bool fog_parts = false;     // and that in fog by where it comes from
    bool background = true;     // whether the background is in the picture ...
    bool covered = true;        // ... and then in alpha
    uint32_t seed = 0;
    int frame = 0;            // varies the jitter from frame to frame
    bool has_history = false; // whether techniques with a memory look at the frames before

    // A local light in the picture, around which the fog's glow changes within a pixel.
    struct Lamp {
        vec2 at;               // pixels from the upper left
        float radius = 0;      // pixels
        vec2 axis{0, 1};       // unit: the way a spot shines, in the picture
        float half_angle = pi; // radians to both sides of it; pi = all around
    };
    std::vector<Lamp> lamps;
    std::shared_ptr<const TileFactors> edges{};    // found for the picture; null = none
    std::shared_ptr<const OpenShutter> shutter{};  // null = the picture is one moment
    std::shared_ptr<const TileFactors> allotted{}; // instead of what lamps and edges take; 0 = the tile is left out
    std::shared_ptr<const TileFactors> before{};   // samples of a batch that an earlier picture took: this one goes on
                                                   // in their sequences, in as many batches for all pixels; null = none
};

// Samples of a pixel: more around the view's lamps and at its edges, or as allotted, the same for all pixels of a tile
// of 4×4. The light that fog scatters along a ray falls with the ray's distance from the lamp, d pixels, as 1/d.
int samples_of(const View& view, ivec2 pixel);
std::pair<int, int> samples_range(const View& view); // fewest and most that a pixel may take

// Batches that a pixel's samples come in: more where it is allotted many, so that its spread is well known.
inline constexpr int many_allotted = 8, more_batches = 4; // from that factor on, if it is a multiple
int batches_of(const View& view, ivec2 pixel);

// A sample of a pixel as one of its batch, which counts those of earlier pictures that it goes on from.
struct BatchSample {
    uint32_t batch, index, count; // count: samples of the batch once this picture is done
};
BatchSample batch_sample(const View& view, ivec2 pixel, int sample);

SamplePlace sample_place(const View& view, ivec2 pixel, int sample);

// Where a sample lies and how much its light counts: 1 on the average.
struct SamplePoint {
    vec2 position; // pixels from the upper left of the picture
    float weight = 1;
};

// Which of the shutter's moments a sample shows. Those of a pixel and batch are spread evenly over them, and so are
// those of each 2×2 pixels at one sample; a tile of 4×4 holds four moments at most at one sample, so that its rays
// still go together. Many samples: all pixels of a tile show the same moment.
int moment_at(const View& view, ivec2 pixel, int sample);

// The ray of a sample that lies at a position: through the lens, where the camera has one. Points of the lens follow a
// scrambled (0,2)-sequence of their own.
Ray sample_ray(const View& view, const Camera& camera, vec2 position, SamplePlace place);
inline Ray sample_ray(const View& view, vec2 position, SamplePlace place) {
    return sample_ray(view, view.camera, position, place);
}

// Importance sampled by the filter, so that weights are one, or by filter and glow where a lamp is seen.
SamplePoint sample_point(const View& view, ivec2 pixel, int sample);
}
