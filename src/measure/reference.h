// What a chart's pictures are held against: single scattering by the exact march, rendered twice with other random
// numbers, so that the noise of the one can be told from errors and taken out of a mean square.
#pragma once
#include "render/candidates.h"
#include "render/exr.h"
#include "render/provenance.h"

#include <array>

namespace tyndall {
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
    RenderJob job; // scene file, camera, picture size and settings, those of the reference not yet among them
    int frame = 0;
    std::filesystem::path directory; // files of references that are kept; empty = none are
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// How many pixel samples both halves of a reference take together; at pixel centres one is enough for each, except for
// soft lights.
struct ReferenceSamples {
    int count = 16;
    bool centers = false; // the light at pixel centres instead of the mean over pixels
    bool unlit = true;    // whether that part is wanted too
};

// Halves that an earlier run left in the directory are read back. Throws Error.
Reference make_reference(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// One hash over all that a reference depends on.
std::string reference_hash(const Shot& shot, ReferenceSamples samples, FileHashes& files);

// The mean of the halves.
ColorLayers mean_of(const std::array<ColorLayers, 2>& halves);

// A snapshot for which nothing has been made yet.
Snapshot fresh(const Snapshot& snapshot);
}
