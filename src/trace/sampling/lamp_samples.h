// Sampling of pixels that show a lamp. In-scattered light along a ray falls off with the ray's distance from the lamp
// as 1 / distance, whose variance under uniform sampling is infinite.
#pragma once
#include "trace/view.h"

namespace tyndall {
struct Snapshot;

// Local lights whose glow shows in the image; none if sample positions within a pixel do not matter.
std::vector<View::Lamp> lamps_in(const View& view, const Snapshot& snapshot);

// Whether a lamp smaller than a pixel lies within the filter around `center`. Elsewhere the glow varies little, and the
// filter's own samples are better: they converge faster at edges.
bool beside_lamp(const View& view, vec2 center);

// A sample distributed as the filter times the glow, with the weight that keeps it unbiased: resampled from candidates
// of the filter and of the lamps (resampled importance sampling: Talbot, Cline & Egbert 2005).
SamplePoint lamp_sample(const View& view, vec2 center, SampleIndex sample);
}
