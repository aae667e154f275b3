// Up to sixteen camera rays traced through BLEND surfaces to the first opaque one. For the files of this folder and
// measure/explain.
#pragma once
#include "render/frame/samples.h"
#include "trace/occlusion/occluders.h"

namespace tyndall {
inline constexpr int max_layers = 64;

// Uses of random numbers.
enum : uint32_t { use_id = 1, use_jitter = 2, use_soft_light = 3 };

// The state of a camera path: where its next segment starts and its throughput.
struct Path {
    Ray ray;              // from the camera or the last BLEND surface
    float skip = 0;       // surfaces nearer than this are ignored: the near plane, or the surface just left
    vec3 throughput{1};   // throughput of fog and BLEND surfaces so far
    vec3 fog{1};          // throughput of fog alone
    uint32_t seed = 0;    // of the pixel and batch in this frame
    uint32_t shift = 0;   // of its jitter
    SampleIndex sample;   // in the batch
    uint32_t samples = 1; // of the batch so far
    vec2 screen{0};       // image position, 0..1
    vec2 position{0};     // the same in pixels
    int lane = 0;
    int moment = 0;                   // shutter moment
    int instance = -1, triangle = -1; // surface just left: at grazing angles rounding may hit it again
};

struct PathPacket { // the active paths, packed
    Path path[16];
    int count = 0;
    Hits hits;
    int32_t face[16]; // light whose face is hit before any surface, or -1
    float length[16]; // to the surface, or to the end of the ray
    Ray tested[16];   // the rays as given to the occluders

    bool hit(int i) const { return hits.instance[i] >= 0 || face[i] >= 0; }
    bool hit_again(int i) const {
        return hits.instance[i] >= 0 && hits.instance[i] == path[i].instance && hits.triangle[i] == path[i].triangle;
    }
};

// The surfaces hit, packed.
struct SurfaceHits {
    SurfacePoint points[16];
    int which[16]; // the path of each
    size_t count = 0;
};

// Per-ray inputs of a mode besides the rays.
struct RayInputs {
    uint32_t ids[16];
    float jitter[16];
    SampleIndex sample_indices[16];
    vec2 positions[16];
};

// Starts sample `sample` of up to 16 pixels at the camera, at the shutter's moments or in the middle of the shutter
// interval; resets the results and sets their weights and distances from the pixel centers.
void start_paths(const View& view, bool in_moments, std::span<const ivec2> pixels, int sample, PathPacket& s,
                 std::span<PixelSample> samples);

// Finds the first surface of each path. The 64th layer counts as opaque.
void find_surfaces(const Snapshot& snapshot, int layer, PathPacket& s);
SurfaceHits surface_hits(const Snapshot& snapshot, int layer, const PathPacket& s);

// Ends the paths at opaque surfaces and moves the others past theirs; true while any is left.
bool advance(const View& view, const SurfaceHits& hits, PathPacket& s, std::span<PixelSample> samples);

RayInputs ray_inputs(const View& view, int layer, const PathPacket& s);

// For modes with Surfaces::own: one ray per path, from the camera to the far plane.
void trace_own_paths(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> parts);

// Whether depths come from separate rays through pixel centers: with a lens or an open shutter, those of samples would
// be noisy along edges.
bool has_center_depths(const FrameTracer& tracer);

// Planar depths of the first opaque surfaces on the rays through the centers of up to 16 pixels, at the middle of the
// lens and of the shutter interval.
void center_depths(const FrameTracer& tracer, std::span<const ivec2> pixels, std::span<float> depths);
}
