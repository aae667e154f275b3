// The deterministic reference: single scattering without a sampled shadow.
#pragma once
#include "integrate/single_scattering/single_scattering.h"

namespace tyndall {
// Fog along rays, integrated over exactly the stretches each light reaches (trace/shadows/intervals/shadow_slices.h),
// with densities and camera-side transmittance in closed form (volume/rays/fog_pieces.h). Every piece between kinks is
// split until it obeys the march's bounds and integrated by Gauss–Legendre; near local lights in the angle seen from
// them, in which 1/r² is constant (Kulla & Fajardo 2012, section 4.1). A soft light is one random point of it per ray;
// what MASK and BLEND surfaces shadow is found by a shadow ray per node.
void march_exact(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results);
}
