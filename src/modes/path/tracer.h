// Paths of light from the eye through fog and over surfaces, followed sixteen at a time.
//
// A path is a chain of straight lines. Along a line, through BLEND surfaces up to the first opaque one, light is
// gathered in three ways: from a distance picked for the lights; from the point where delta tracking makes the path
// collide with fog; and from every surface met, dimmed by ratio tracking. The first two cover the same light and share
// it by multiple importance sampling. Where the path collided or met a surface it turns into its next line.
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
    bool surfaces_emit = true; // light on fog and other surfaces
    Camera camera;
    ivec2 size{0};
    std::shared_ptr<const EmissiveTriangles> glow; // surfaces that paths aim at; null = none
    std::shared_ptr<const EmissiveBricks> fire; // of media that only emit, which the snapshot is without; null = none
    std::vector<float> peaks;                   // of the media's phase functions, 1/sr; empty = no light has a face
    bool finds_sky = false;    // the environment by lines that leave the scene, too; else by aiming at it alone
    bool has_emission = false; // fog, surfaces or surroundings give off light that paths must find by themselves
};

// Traces the paths of one pixel sample of up to 16 pixels.
void trace_paths(const PathTracer& tracer, const RayBatch& batch, std::span<Scatter> results);
}
