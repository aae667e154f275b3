// Packets of sixteen shadow rays.
#pragma once
#include "trace/occlusion/occluders.h"

namespace tyndall::test {
// Sets one lane; `lane` < 0 sets all of them.
inline void set_ray(Occluders::ShadowRays& rays, int lane, vec3 origin, vec3 direction, float t_max = infinity) {
    for (int i = lane < 0 ? 0 : lane; i < (lane < 0 ? 16 : lane + 1); ++i) {
        rays.ox[i] = origin.x, rays.oy[i] = origin.y, rays.oz[i] = origin.z;
        rays.dx[i] = direction.x, rays.dy[i] = direction.y, rays.dz[i] = direction.z;
        rays.t_min[i] = 0, rays.t_max[i] = t_max, rays.active[i] = -1;
    }
}
}
