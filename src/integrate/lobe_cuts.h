// Where light along rays is cut for the sake of narrow lobes of phase functions. Those of droplets turn from bright to
// dim within a fraction of a degree, while other light changes with the whole angle seen from the lamp.
#pragma once
#include <span>

namespace tyndall {
struct Medium;

// Slopes u / h of points of a ray, u from where it passes the lamp at a distance h: ascending, so that the angle off
// the lobe's axis doubles from one to the next, forward and backward alike. None where no lobe is narrow.
struct LobeCuts {
    int count = 0;
    float slopes[32] = {};
};

inline constexpr float wide_lobe = 0.3f; // 1 - |g|: needs no cuts

// Of the media's phase functions of several lobes, and tables; a single lobe is looked at by its g.
LobeCuts lobe_cuts(std::span<const Medium> media);
}
