// The fog of a picture, computed once for every n-th pixel and found again for any ray of the picture.
#pragma once
#include "modes/mode.h"

namespace tyndall {
// Wraps the ScatterFunction of a mode so that fog is computed at a share of the picture's resolution, at the centres of
// its pixels, and spread over the full picture with regard to depth (joint bilateral: Kopf et al. 2007); with a history
// it also goes on from the last frame's picture where that shows the same place. Stretches that do not run from the eye
// to the first opaque surface (at BLEND surfaces) are computed as they are.
ScatterFunction from_fog_picture(const View& view, const Snapshot& snapshot, PictureShare share, ScatterFunction whole,
                                 History* history);
}
