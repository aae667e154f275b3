// Fog that dims red, green and blue differently: three scenes in grey fog, of which each gives its channel.
#pragma once
#include "render/frame/frame.h"

namespace tyndall {
struct SurfacePoint;

// A frame, or a moment of it.
Prepared prepare_moment(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        History* history);

// As shade_surfaces(), each channel through its own fog.
void shade(const Snapshot& snapshot, const Prepared& prepared, std::span<const SurfacePoint> points,
           std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light = nullptr);
}
