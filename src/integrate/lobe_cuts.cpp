#include "integrate/lobe_cuts.h"

#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
LobeCuts lobe_cuts(std::span<const Medium> media) {
    float width = 1; // radians, about
    for (const Medium& medium : media)
        if (medium.optics.phase.shape) width = std::min(width, 1 - narrowest_lobe(medium.optics.phase));
    LobeCuts cuts;
    if (width > wide_lobe) return cuts;
    for (float angle = std::max(width, 1e-3f); angle < 1 && cuts.count < 16; angle *= 2)
        cuts.slopes[cuts.count++] = -1 / std::tan(angle);
    for (int i = cuts.count - 1; i >= 0; --i) cuts.slopes[cuts.count++] = -cuts.slopes[i];
    return cuts;
}
}
