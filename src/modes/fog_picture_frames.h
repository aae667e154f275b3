// What makes jitter disappear from a FogPicture: its neighbours, and the frames before.
#pragma once
#include "modes/fog_picture.h"

namespace tyndall {
// Averages every pixel with those of like length around it: weights ½ 1 1 1 ½ along each side hold every phase of a
// 4×4 pattern equally often.
void blur_pattern(FogPicture& picture);

// Mixes in what the last frame's picture shows at the same places: the ends of the rays.
void go_on_from(const FogPicture& before, FogPicture& picture);
}
