// Gaps in the volume files of a scene.
#pragma once
#include "base/io/file_sequence.h"

#include <string>
#include <vector>

namespace tyndall {
struct Scene;

// Frames of the scene for which a sequence of volume files has no file, ascending.
std::vector<int> missing_frames(const Scene& scene);

// The missing file of a frame and what replaces it: "a file of smoke is missing at this frame: smoke.0006.vdb is held".
// Empty if none is missing.
std::string missing_text(const Scene& scene, int frame, MissingFrame missing);
}
