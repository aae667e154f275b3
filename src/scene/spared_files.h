// The files that a scene is made of, none of which a command may overwrite.
#pragma once
#include "base/io/output.h"

namespace tyndall {
struct Scene;

// Throws Error (usage) if an output is one of the scene's files: of the scene itself, or of any number of a sequence.
void spare_files(const Scene& scene, const OutputPaths& places);
}
