// Pictures by formula: a reference with stripes, a checkerboard and a bright shaft, and a rendering that misses it by a
// little everywhere.
#pragma once
#include "base/image.h"

namespace tyndall::test {
Image<vec3> constant(vec3 color, ivec2 size = {2, 2});

// The shaft's middle is shifted by `shift` pixels, the stripes are `ripple` too strong.
Image<vec3> shaft(ivec2 size, double shift, double ripple);

Image<vec3> scaled(Image<vec3> image, float factor);
}
