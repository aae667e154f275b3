// The color spaces of FLIP; white is D65 in all of them.
#pragma once
#include "base/math.h"

namespace tyndall {
// Linear RGB ↔ YCxCz: CIELAB without its cube root, thus linear in light (Flohr et al. 1993).
vec3 ycxcz_of_rgb(vec3 rgb);
vec3 rgb_of_ycxcz(vec3 ycxcz);

// CIELAB of linear RGB, with a* and b* scaled by 0.01 L*: dark colors look less colorful (Hunt effect).
vec3 hunt_lab_of_rgb(vec3 rgb);

// HyAB distance in such a space, for large color differences (Abasi et al. 2020).
float hyab(vec3 a, vec3 b);
}
