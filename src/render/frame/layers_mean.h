// Means of independent pictures.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
// Into the layers `share` of other ones, with the variances of such a mean. Depth stays.
void blend_layers(Layers& layers, const Layers& other, float share);
}
