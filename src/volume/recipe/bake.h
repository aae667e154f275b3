// Bakes a recipe to a sequence of VDB files: leaves are packed as they grow, a frame is written while another grows.
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
    bool velocity = false; // a grid of recipe_velocity() beside the others
    bool resume = false;   // keep files whose stored settings hash matches and whose voxels read back
    const std::atomic<bool>* cancel = nullptr; // set from outside: no further frame is begun
};

struct BakeReport {
    int written = 0, kept = 0;
    bool cancelled = false;
    double seconds = 0;
    uint64_t voxels = 0, bytes = 0;
};

// `pattern` needs a frame token for more than one frame. Frame f shows the time f / frame_rate. Throws Error.
BakeReport bake(const FogRecipe& recipe, const std::string& pattern, const std::vector<int>& frames,
                const BakeOptions& options, Progress& progress);
}
