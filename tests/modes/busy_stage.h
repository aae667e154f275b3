// A stage with a bit of everything, and rays through it.
#pragma once
#include "support/tiny_scenes.h"

namespace tyndall::test {
float wavy(vec3 p);

// A grid and homogeneous fog over each other, a lamp and the sun, and things in their way.
TestScene busy_scene();

std::vector<Ray> busy_rays(int count);
}
