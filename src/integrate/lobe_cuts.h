// Where to split the integration along rays for narrow phase function lobes. Those of droplets fall off within a
// fraction of a degree, while the rest of the integrand varies smoothly with the angle seen from the light.
#pragma once
#include <span>

namespace tyndall {
struct Medium;

// Slopes u / h of points on a ray, where u is measured from the point closest to the light, at distance h. Ascending;
// the angle from the lobe's axis doubles from one to the next, both forward and backward. Empty if no lobe is narrow.
struct LobeCuts {
    int count = 0;
    float slopes[32] = {};
};

inline constexpr float wide_lobe = 0.3f; // 1 - |g| above which no cuts are needed

// Cuts for multi-lobe and tabulated phase functions; single lobes are handled through their g.
LobeCuts lobe_cuts(std::span<const Medium> media);
}
