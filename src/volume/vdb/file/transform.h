// The transform record of a grid in an OpenVDB file.
#pragma once
#include "base/math.h"
#include "volume/vdb/file/bytes.h"

#include <string>

namespace tyndall {
struct VdbTransform {
    dmat4 index_to_world{1}; // world = matrix · index
    std::string problem;     // why it cannot be used; empty if valid
    bool complete = true;    // the cursor is past the record; false for an unknown kind of map
};

// Why a matrix cannot be used as an index-to-world transform (nonfinite, projective or not invertible); empty if valid.
std::string matrix_problem(const dmat4& matrix);

// Throws Error (refused) if the record is truncated or inconsistent.
VdbTransform read_transform(ByteCursor& file);
}
