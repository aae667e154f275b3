// The transform record of a grid in an OpenVDB file.
#pragma once
#include "base/math.h"
#include "volume/vdb/bytes.h"

#include <string>

namespace tyndall {
struct VdbTransform {
    dmat4 index_to_world{1}; // world = matrix · index
    std::string problem;     // why it cannot place fog in the world; empty when it can
    bool complete = true;    // the cursor stands behind it (not so for a kind of map that is not known)
};

// Throws Error (refused) when the record is cut or contradicts itself.
VdbTransform read_transform(ByteCursor& file);
}
