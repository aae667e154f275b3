// Shadow rays, the lights they go to, and what they say is lit.
#pragma once
#include "trace/lights/light_ray.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/brick_walk.h"

namespace tyndall::test {
// Sets one lane; `lane` < 0 sets all of them.
inline void set_ray(Occluders::ShadowRays& rays, int lane, vec3 origin, vec3 direction, float t_max = infinity) {
    for (int i = lane < 0 ? 0 : lane; i < (lane < 0 ? 16 : lane + 1); ++i) {
        rays.ox[i] = origin.x, rays.oy[i] = origin.y, rays.oz[i] = origin.z;
        rays.dx[i] = direction.x, rays.dy[i] = direction.y, rays.dz[i] = direction.z;
        rays.t_min[i] = 0, rays.t_max[i] = t_max, rays.active[i] = -1;
    }
}

inline LightPoint sun_from(vec3 towards) { return {glm::normalize(dvec3(towards)), true}; }
inline LightPoint lamp_at(vec3 position, double radius = 0) {
    return {dvec3(position), false, dvec3(position), radius};
}

inline double length_of(const std::vector<Interval<double>>& stretches) {
    double length = 0;
    for (const Interval<double>& stretch : stretches) length += stretch.length();
    return length;
}

// Length that only one of the two lists covers.
inline double difference(const std::vector<Interval<double>>& a, const std::vector<Interval<double>>& b) {
    double common = 0;
    for (const Interval<double>& x : a)
        for (const Interval<double>& y : b)
            common += Interval<double>{std::max(x.low, y.low), std::min(x.high, y.high)}.length();
    return length_of(a) + length_of(b) - 2 * common;
}
}
