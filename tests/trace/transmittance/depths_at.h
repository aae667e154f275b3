// Optical depths towards a light, asked for sixteen points at a time.
#pragma once
#include "trace/transmittance/light_depth.h"

#include <vector>

namespace tyndall::test {
inline std::vector<float> depths_at(const LightDepth& depth, const std::vector<vec3>& points) {
    std::vector<float> result;
    for (size_t first = 0; first < points.size(); first += 16) {
        float v[3][16], out[16];
        int32_t active[16];
        for (size_t lane = 0; lane < 16; ++lane) {
            const vec3 p = points[std::min(first + lane, points.size() - 1)];
            v[0][lane] = p.x, v[1][lane] = p.y, v[2][lane] = p.z, active[lane] = -1;
        }
        light_depths(depth, v[0], v[1], v[2], active, out);
        result.insert(result.end(), out, out + std::min<size_t>(16, points.size() - first));
    }
    return result;
}
}
