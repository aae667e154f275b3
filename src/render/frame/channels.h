// Chromatic fog: red, green and blue are rendered as three scenes with gray fog, one for each channel, except by
// techniques that trace all channels together.
#pragma once
#include "render/frame/frame.h"

namespace tyndall {
struct SurfacePoint;

// Prepares a frame, or one of its moments.
Prepared prepare_moment(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        History* history);

// Like shade_surfaces(), with each channel in its own fog.
void shade(const Snapshot& snapshot, const Prepared& prepared, std::span<const SurfacePoint> points,
           std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light = nullptr);
}
