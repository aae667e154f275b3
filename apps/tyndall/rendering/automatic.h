// --mode auto: chooses a mode for a scene.
#pragma once
#include "common.h"
#include "measure/plan/plan.h"
#include "render/sequence/job.h"

namespace tyndall {
struct Scene;

inline constexpr std::string_view automatic = "auto";

// The target error when only a quality is given.
double default_error(Quality quality);

// The plan of a request, measured on its first frame. With --resume, an existing first frame that was rendered to the
// same goal keeps its mode. Prints the choice unless quiet.
RenderPlan chosen_plan(const Scene& scene, const RenderRequest& request, const Snapshot& first, const Globals& globals);
}
