// Where to split the integration along rays for narrow phase function lobes and for peaks and bends of tables. Those of
// droplets fall off within a fraction of a degree, while the rest of the integrand varies smoothly with the angle seen
// from the light.
#pragma once
#include <span>

namespace tyndall {
struct Medium;

// Slopes u / h of points on a ray, where u is measured from the point closest to the light, at distance h; ascending.
// Empty if all phase functions are smooth.
struct LobeCuts {
    int count = 0;
    float slopes[128] = {};
};

inline constexpr float wide_lobe = 0.3f; // 1 - |g| above which no cuts are needed

// Cuts for multi-lobe and tabulated phase functions; single lobes are handled through their g.
LobeCuts lobe_cuts(std::span<const Medium> media);

// Width in radians, at half its height, of the narrowest peak of a tabulated phase function that is neither straight on
// nor straight back; π if there is none.
float narrowest_halo(const Medium& medium);
}
