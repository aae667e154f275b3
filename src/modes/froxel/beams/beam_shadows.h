// Shadows of a lamp along camera rays: the lit segments, and the fraction of the lamp that lights each.
#pragma once
#include "integrate/ray_batch.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <memory>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

// A lamp's shadows from its center or, for a soft lamp, from several points on it.
using LampViews = std::vector<std::shared_ptr<const ShadowView>>;
size_t lamp_points(const Light& light); // number of those points
LampViews lamp_views(const Snapshot& snapshot, const Light& light, const View& view, float margin);

// Lit intervals of 16 rays, meters along each: a row has the i-th of every ray, ascending, empty (low >= high) for rays
// that have fewer; and the fraction of the lamp that is visible from there.
struct LitIntervals {
    struct Row {
        alignas(64) float low[16] = {}, high[16] = {}, share[16] = {};
        Interval<float> all; // union over rays
    };
    std::vector<Row> rows;
};

// Finds the segments between low and high of each ray that the lamp lights, for rays of the views' camera no farther
// than `margin` from their pixels. Penumbrae that are short relative to the lamp's distance become sharp edges. Rays
// with low >= high are skipped.
void find_lit_segments(const LampViews& views, vec3 lamp, const RayBatch& batch, float margin, const float (&low)[16],
                       const float (&high)[16], LitIntervals& lit);
}
