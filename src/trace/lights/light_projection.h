// How the rays of a light lie on a picture of them: in shadow maps and in light grids.
#pragma once

namespace tyndall {
enum class LightProjection {
    parallel,    // of a sun, across its direction
    perspective, // of a narrow cone, by its tangents
    all_around   // from a point in every direction
};
}
