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

// Why a matrix cannot place fog in the world: numbers that are not finite, projections, and those that cannot be
// inverted. Empty when it can.
std::string matrix_problem(const dmat4& matrix);

// Throws Error (refused) when the record is cut or contradicts itself.
VdbTransform read_transform(ByteCursor& file);
}
