// Path tracing from the eye through fog and over surfaces, 16 paths at a time.
//
// A path is a chain of straight lines. Along a line, through BLEND surfaces up to the first opaque one, light is
// gathered in three ways: at a distance sampled for the lights; at the point where the path collides with fog (delta
// tracking); and at every surface, attenuated by ratio tracking. The first two sample the same light and are combined
// by multiple importance sampling. Where the path collides with fog or hits a surface, it scatters into its next line.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/settings.h"
#include "scene/camera.h"
#include "trace/lights/emissive_bricks.h"
#include "trace/lights/emissive_triangles.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
struct PathTracer {
    Snapshot snapshot;
    PathSettings settings;
    bool surfaces_emit = true;  // whether they illuminate fog and other surfaces
    bool ambient_in_fog = true; // whether fog scatters light of the surroundings; surfaces always do
    Camera camera;
    ivec2 size{0};
    std::shared_ptr<const EmissiveTriangles> emitters; // emissive surfaces, for light sampling; null = none
    std::shared_ptr<const EmissiveBricks> fire;        // media that only emit, taken out of the snapshot; null = none
    std::vector<float> peaks;                          // of the media's phase functions, 1/sr; empty = no area lights
    bool finds_sky = false;    // lines that leave the scene add the environment too; else only light sampling does
    bool has_emission = false; // lines may meet emission of fog, surfaces or surroundings
    bool chromatic = false;    // extinction differs between channels
};

// Traces the paths of one pixel sample of up to 16 pixels.
void trace_paths(const PathTracer& tracer, const RayBatch& batch, std::span<Scatter> results);
}
