// How shadow maps and light grids parameterize a light's rays.
#pragma once

namespace tyndall {
enum class LightProjection {
    parallel,    // suns: plane perpendicular to the direction
    perspective, // narrow cones: tangent plane
    all_around   // all directions from a point
};
}
