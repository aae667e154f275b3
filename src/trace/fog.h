// Media of a scene at one moment.
#pragma once
#include "trace/snapshot.h"

namespace tyndall {
// Of fog that emits and dims nothing, 1/m. Kernels divide emission by extinction, and multiply by it again: any value
// does that is nothing over the longest way.
inline constexpr float min_extinction = 1e-20f;

// Fills media, fog_sources and notes of `snapshot`. Media without extinction are left out. `previous` (may be null)
// lends bricks made from the same file or recipe. Throws Error.
void add_media(const Scene& scene, Moment moment, const Snapshot* previous, MissingFrame missing, Snapshot& snapshot);

// The smallest box around an affinely moved box; unbounded directions stay so.
Box moved_box(const mat4& matrix, const Box& box);
}
