// Small grids used by cases. Internal to stress.
#pragma once
#include "measure/stress/trial.h"
#include "scene/light.h"

namespace tyndall {
// A view of fog in the unit box, lit by the sun.
StressScene looking_at(Medium medium);

float blob(vec3 p);
float roughness(vec3 p);

constexpr Participants seen_modes = Claim::density | Claim::noise_free;
inline const Light noon_light = sun_light({0.3f, -1, -0.2f}, 10);
}
