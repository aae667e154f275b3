// The reference of a chart: single scattering by the exact march, rendered twice with different seeds, so that its
// noise can be removed from mean squared errors.
#pragma once
#include "render/adaptive/candidates.h"
#include "render/image/exr.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"

#include <array>

namespace tyndall {
struct Scene;
struct Snapshot;

// Color and fog light of an image.
struct ColorLayers {
    Image<vec3> color, inscatter;
};

struct Reference {
    std::array<ColorLayers, 2> halves; // independent; equal where nothing is random
    // The part of each half that does not come from lights: ambient light, emission, background. On request.
    std::array<ColorLayers, 2> unlit;
};

// A scene at one moment, seen by one camera.
struct Shot {
    const Scene& scene;
    const Snapshot& snapshot;
    RenderRequest request; // scene file, camera, image size and settings, before those of the reference are applied
    int frame = 0;
    std::filesystem::path directory; // where halves are cached; empty = not cached
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// How accurate a reference is to be. Light at pixel centers needs one sample for each half, except from soft lights.
struct ReferenceSamples {
    int count = 0;        // pixel samples of both halves together; 0 = as many as `noise` takes
    double noise = 0.02;  // of the mean of both halves, relative to the image's mean
    double seconds = 60;  // at most, for each half, whether `noise` is reached or not
    bool centers = false; // the light at pixel centers instead of the mean over pixels; needs a count
    bool unlit = true;    // render Reference::unlit too
};

// Renders both halves, or reads back those that an earlier run left in the directory. Throws Error.
Reference make_reference(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// Estimated seconds to render both halves.
double reference_seconds(const Shot& shot, ReferenceSamples samples);

// Hash of all that a reference depends on.
std::string reference_hash(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// The mean of the halves.
ColorLayers mean_of(const std::array<ColorLayers, 2>& halves);

// A copy of a snapshot with an empty cache.
Snapshot fresh(const Snapshot& snapshot);
}
