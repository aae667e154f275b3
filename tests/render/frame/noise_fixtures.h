// Modes whose noise is known by construction, and what to hold it against.
#pragma once
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"

namespace tyndall::test {
// Every sample is a gray of its own, even in [0,1): mean 1/2, variance 1/12.
ScatterFunction prepare_random(const View&, const Snapshot&, const Settings&, History*);
inline constexpr double random_mean = 0.5, random_variance = 1.0 / 12;

// The number that spreads samples along a ray, and one of those that spread them over a lens or a light.
ScatterFunction prepare_jitter(const View&, const Snapshot&, const Settings&, History*);
ScatterFunction prepare_place(const View&, const Snapshot&, const Settings&, History*);

Mode own_mode(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*));

View batched_view(ivec2 size, int samples, int batches);

Layers rendered(const Mode& mode, const View& view, const Snapshot& snapshot, FrameOptions options = {});

double mean_red(const Image<vec3>& image);
}
