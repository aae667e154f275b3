// Shadows of a lamp on camera rays: how much of it lights which stretches of them.
#pragma once
#include "integrate/ray_batch.h"
#include "trace/shadows/volumes/shadow_view.h"

#include <memory>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

// A lamp's shadows from its centre or, where it is soft, from some points of it.
using LampViews = std::vector<std::shared_ptr<const ShadowView>>;
size_t lamp_points(const Light& light); // how many those are
LampViews lamp_views(const Snapshot& snapshot, const Light& light, const View& view, float margin);

// Intervals of sixteen rays in metres along each: the i-th of every ray side by side, ascending, empty (low >= high)
// on rays that have fewer; and the share of the lamp that is seen from there.
struct LitIntervals {
    struct Row {
        alignas(64) float low[16] = {}, high[16] = {}, share[16] = {};
        Interval<float> all; // of any ray
    };
    std::vector<Row> rows;
};

// The stretches between low and high of each ray that the lamp lights, for rays that are the views' camera's and lie no
// farther than `margin` from their pixels; edges that are short, as the lamp is far, are sharp. Rays with low >= high
// are left out.
void find_beam_lit(const LampViews& views, vec3 lamp, const RayBatch& batch, float margin, const float (&low)[16],
                   const float (&high)[16], LitIntervals& lit);
}
