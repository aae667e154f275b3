// The reference: single scattering without sampled shadows of opaque surfaces.
#pragma once
#include "integrate/single_scattering/single_scattering.h"

namespace tyndall {
// Fog along rays, integrated over exactly the segments that each light reaches
// (trace/shadows/intervals/shadow_slices.h), with densities and camera-side transmittance in closed form
// (volume/rays/fog_pieces.h). Every piece between kinks is split until it is within the march's step limits and
// integrated by Gauss–Legendre quadrature; for local lights in the angle seen from them, in which dt/r² is constant
// (Kulla & Fajardo 2012, section 4.1). Each ray samples light_points random points of a soft light; shadows of MASK and
// BLEND surfaces take a shadow ray per node.
void march_exact(const SingleScattering& frame, const RayBatch& batch, std::span<Scatter> results);
}
