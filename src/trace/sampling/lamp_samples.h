// Samples of pixels that show a lamp. The light that fog scatters along a ray falls with the ray's distance from the
// lamp as 1 / distance, which has no variance in the limit: even samples never settle.
#pragma once
#include "trace/view.h"

namespace tyndall {
struct Snapshot;

// Local lights whose glow shows in the picture; none where it does not matter where in a pixel samples lie.
std::vector<View::Lamp> lamps_in(const View& view, const Snapshot& snapshot);

// Whether a lamp that is smaller than a pixel lies within the filter around `center`. Elsewhere the glow changes
// little, and the even samples of the filter are better: the error at edges falls faster with them.
bool beside_lamp(const View& view, vec2 center);

// Sampled by the filter times the brightness of the glow, with the weight that keeps means: one of many candidates, of
// the filter and of the lamps, each as likely as both together ask for (Talbot, Cline & Egbert 2005).
SamplePoint lamp_sample(const View& view, vec2 center, SamplePlace place);
}
