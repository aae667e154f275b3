// --mode auto: the mode that a scene needs.
#pragma once
#include "common.h"
#include "measure/plan/plan.h"
#include "render/sequence/job.h"

namespace tyndall {
struct Scene;

inline constexpr std::string_view automatic = "auto";

// The error that is asked for when only a quality is.
double usual_error(Quality quality);

// Plans a job by its first frame and sets mode, settings and certificate. With resume and a first frame that was
// rendered to the same goal, that frame's mode is kept. Says what was chosen unless quiet.
void choose_mode(const Scene& scene, RenderJob& job, const Snapshot& first, const Globals& globals);
}
