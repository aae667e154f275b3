#include "integrate/lobe_cuts.h"

#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
LobeCuts lobe_cuts(std::span<const Medium> media) {
    // A lobe is half as bright 0.77 of this off its axis. A table may fall in a step: that is where the first cut is.
    float width = 1; // radians, about
    for (const Medium& medium : media)
        if (const auto& shape = medium.optics.phase.shape)
            width = std::min(width, (shape->lobes.empty() ? 0.77f : 1.0f) * (1 - shape->narrowest));
    LobeCuts cuts;
    if (width > wide_lobe) return cuts;
    for (float angle = std::max(width, 1e-3f); angle < 1 && cuts.count < 16; angle *= 2)
        cuts.slopes[cuts.count++] = -1 / std::tan(angle);
    for (int i = cuts.count - 1; i >= 0; --i) cuts.slopes[cuts.count++] = -cuts.slopes[i];
    return cuts;
}
}
