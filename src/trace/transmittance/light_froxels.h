// Fits and fills froxels of optical depth to a light.
#pragma once
#include "trace/transmittance/light_depth.h"

#include <span>

namespace tyndall {
// Froxels over the part of `bounds` that the view sees, without their depths; size 0 if it sees none of it.
LightDepthFroxels fitted_froxels(const View& view, const Box& bounds, int resolution);

// Integrates the media from each corner to the light, in parallel over rows of corners.
void fill_froxels(std::span<const Medium* const> media, const Light& light, LightDepthFroxels& froxels);
}
