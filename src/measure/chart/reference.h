// What a chart's pictures are held against: single scattering by the exact march, rendered twice with other random
// numbers, so that the noise of the one can be told from errors and taken out of a mean square.
#pragma once
#include "render/adaptive/candidates.h"
#include "render/image/exr.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"

#include <array>

namespace tyndall {
struct Scene;
struct Snapshot;

// Colour and fog light of a picture.
struct ColorLayers {
    Image<vec3> color, inscatter;
};

struct Reference {
    std::array<ColorLayers, 2> halves; // independent of each other, where anything is left to chance
    // Of each half, what lights have no part in: ambient light, emission, background. On request.
    std::array<ColorLayers, 2> unlit;
};

// A scene at one moment, seen by one camera.
struct Shot {
    const Scene& scene;
    const Snapshot& snapshot;
    RenderRequest request; // scene file, camera, picture size and settings, those of the reference not yet among them
    int frame = 0;
    std::filesystem::path directory; // files of references that are kept; empty = none are
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// How good a reference is to be. Light at pixel centres needs one sample for each half, except from soft lights.
struct ReferenceSamples {
    int count = 0;        // pixel samples that both halves take together; 0 = as many as it takes to get to the noise
    double noise = 0.02;  // of the mean of both halves, as a share of the picture's mean
    double seconds = 60;  // at most, for each half: then it is as noisy as it is
    bool centers = false; // the light at pixel centres instead of the mean over pixels; needs a count
    bool unlit = true;    // whether that part is wanted too
};

// Halves that an earlier run left in the directory are read back. Throws Error.
Reference make_reference(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// About how long both halves of a whole picture take.
double reference_seconds(const Shot& shot, ReferenceSamples samples);

// One hash over all that a reference depends on.
std::string reference_hash(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// The mean of the halves.
ColorLayers mean_of(const std::array<ColorLayers, 2>& halves);

// A snapshot for which nothing has been made yet.
Snapshot fresh(const Snapshot& snapshot);
}
