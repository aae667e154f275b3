// A scene in other units of length.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// Everything `factor` times as large, lights and fog changed so that the image stays the same: intensities of local
// lights grow by factor², extinction and emission of fog shrink by the factor.
Scene scaled(Scene scene, float factor);
}
