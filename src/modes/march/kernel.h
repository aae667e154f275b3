// Ray marching of one packet of rays, separate from its preparation.
#pragma once
#include "integrate/single_scattering/single_scattering.h"

namespace tyndall {
// Fog along up to 16 rays, in steps by the frame's rule, with shadows from rays or maps at each step, or none. Source
// function and extinction are sampled once per step; within a step they are constant and the integral is exact: L += T
// J (1-e^-D)/σ, T *= e^-D (Hillaire 2015, section 5.6.3).
void march_packet(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results);
}
