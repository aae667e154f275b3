// Shadows of a lamp on camera rays: which stretches of its beam are lit, exactly.
#pragma once
#include "integrate/ray_batch.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <array>

namespace tyndall {
// Intervals of sixteen rays in metres along each: the i-th of every ray side by side, ascending, empty (low >= high)
// on rays that have fewer.
struct LitIntervals {
    struct Row {
        alignas(64) float low[16], high[16];
    };
    std::vector<Row> rows;
};

// The stretches between low and high of each ray that the lamp of the view lights, for rays that are the view's
// camera's and lie no farther than `margin` from their pixels. Rays with low >= high are left out.
void find_beam_lit(const ShadowView& view, const RayBatch& batch, float margin, const float (&low)[16],
                   const float (&high)[16], LitIntervals& lit);
}
