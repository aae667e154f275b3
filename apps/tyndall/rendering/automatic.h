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

// The plan of a request by its first frame. With resume and a first frame that was
// rendered to the same goal, that frame's mode is kept. Says what was chosen unless quiet.
RenderPlan chosen_plan(const Scene& scene, const RenderRequest& request, const Snapshot& first, const Globals& globals);
}
