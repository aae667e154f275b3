// How the march finds the shadows of a light within lit intervals.
#pragma once
#include "integrate/single_scattering.h"

namespace tyndall {
ShadowsBy shadows_by(const Light& light, const Occluders& occluders);
}
