// A small scene that moves, and jobs that render it with a mode of the test's own.
#pragma once
#include "render/fixtures.h"
#include "render/sequence/sequence.h"
#include "support/scratch.h"

#include <string>
#include <vector>

namespace tyndall::test {
// A plane, a moving camera and fog; the scene file is in `directory`.
Scene moving_scene(const TempFolder& directory);

RenderRequest job_for(const Scene& scene, const std::string& output, std::vector<int> frames);

// With the mode given, or with one whose light depends on everything.
RenderReport run(const Scene& scene, const RenderRequest& job);
RenderReport run(const Scene& scene, const RenderRequest& job, const Mode& mode);
}
