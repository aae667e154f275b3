// How noisy a picture is, from the spread of its batches.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
// From the variances of the layers, which stand on `freedom` differences between batches (batches - 1, summed over
// pictures combined). A layer that is black and free of noise has no error.
Noise noise_of(const Layers& layers, int freedom);
}
