// Up to sixteen camera rays on their way through BLEND surfaces to the first opaque one. For the files of this folder
// and for what explains a ray.
#pragma once
#include "render/frame/samples.h"
#include "trace/occlusion/occluders.h"

namespace tyndall {
inline constexpr int max_layers = 64;

// Uses of random numbers.
enum : uint32_t { use_id = 1, use_jitter = 2, use_soft_light = 3 };

// A ray on its way: where its next stretch starts and how much of what follows reaches the eye.
struct Path {
    Ray ray;              // from the eye or the last BLEND surface
    float skip = 0;       // surfaces nearer than this are behind: the near plane, or the surface just left
    vec3 through{1};      // share of light that gets through fog and BLEND surfaces so far
    vec3 fog{1};          // the same through fog alone
    uint32_t seed = 0;    // of the pixel and batch in this frame
    uint32_t shift = 0;   // of its jitter
    SamplePlace place;    // in the batch
    uint32_t samples = 1; // of the batch so far
    vec2 screen{0};       // position in the picture, 0..1
    vec2 position{0};     // the same in pixels
    int lane = 0;
    int moment = 0;                   // while the shutter is open
    int instance = -1, triangle = -1; // just left: at grazing angles rounding may hit it again
};

struct PathPacket { // of the paths still on their way, packed
    Path path[16];
    int count = 0;
    Hits hits;
    int32_t face[16]; // the light whose glowing face is met before any surface, or -1
    float length[16]; // to the surface, or to the end of the ray
    Ray tested[16];   // the rays as given to the occluders

    bool hit(int i) const { return hits.instance[i] >= 0 || face[i] >= 0; }
    bool hit_again(int i) const {
        return hits.instance[i] >= 0 && hits.instance[i] == path[i].instance && hits.triangle[i] == path[i].triangle;
    }
};

// The surfaces at the ends of stretches, packed.
struct SurfacesMet {
    SurfacePoint points[16];
    int which[16]; // the stretch of each
    size_t count = 0;
};

// What a mode is told besides the rays.
struct RayNumbers {
    uint32_t ids[16];
    float jitter[16];
    SamplePlace places[16];
    vec2 positions[16];
};

// Sample `sample` of up to 16 pixels, at the eye, in the shutter's moments or in the middle of them; clears the results
// and notes how far off centre they are and how much they count.
void start_paths(const View& view, bool in_moments, std::span<const ivec2> pixels, int sample, PathPacket& s,
                 std::span<PixelSample> samples);

// The first surface of each path. The 64th layer counts as opaque.
void find_surfaces(const Snapshot& snapshot, int layer, PathPacket& s);
SurfacesMet surfaces_met(const Snapshot& snapshot, int layer, const PathPacket& s);

// Ends the paths at opaque surfaces and moves the others to the far side of theirs; true while any is left.
bool advance(const View& view, const SurfacesMet& met, PathPacket& s, std::span<PixelSample> samples);

RayNumbers ray_numbers(const View& view, int layer, const PathPacket& s);

// Modes with Surfaces::own: one whole ray for each path.
void follow_own_paths(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> parts);

// Whether depths are those of single rays: a mean over lens or shutter would be noise along edges.
bool has_single_depths(const FrameTracer& tracer);

// Planar depths of the first opaque surfaces on the rays through the centres of up to 16 pixels, the middle of the lens
// and the middle of the time that the shutter is open.
void depths_through_middle(const FrameTracer& tracer, std::span<const ivec2> pixels, std::span<float> depths);
}
