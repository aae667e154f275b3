// Bakes a recipe to a sequence of VDB files: leaves are compressed as they are generated, and one frame is written
// while the next is generated.
#pragma once
#include "base/io/progress.h"
#include "volume/recipe/recipe.h"
#include "volume/vdb/vdb.h"

#include <atomic>
#include <string>
#include <vector>

namespace tyndall {
struct BakeOptions {
    VdbWriteOptions write;
    bool velocity = false;                     // add a grid of recipe_velocity()
    bool resume = false;                       // keep intact files whose stored settings hash matches
    const std::atomic<bool>* cancel = nullptr; // set by the caller: no further frame is started
};

struct BakeReport {
    int written = 0, kept = 0;
    bool cancelled = false;
    double seconds = 0;
    uint64_t voxels = 0, bytes = 0;
};

// `pattern` needs a frame token for more than one frame. Frame f is at time f / frame_rate. Throws Error.
BakeReport bake(const FogRecipe& recipe, const std::string& pattern, const std::vector<int>& frames,
                const BakeOptions& options, Progress& progress);
}
