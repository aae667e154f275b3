// What makes jitter disappear from a FogBuffer: its neighbours, and the frames before.
#pragma once
#include "modes/fog_buffer.h"

namespace tyndall {
struct FogBuffer;
struct Medium;

// Averages every pixel with those of like length around it: weights ½ 1 1 1 ½ along each side hold every phase of a
// 4×4 pattern equally often.
void blur_pattern(FogBuffer& picture);

// Mixes in what the last frame's picture shows of the same fog: where the light of homogeneous fog comes from. The more
// its near and its far half move against each other the less is remembered.
void go_on_from(const FogBuffer& before, std::span<const Medium> media, FogBuffer& picture);
}
