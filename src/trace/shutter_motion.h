// How far things move on the picture while the shutter is open, and how many moments show that as one blur.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Scene;
struct Shutter;

inline constexpr int max_usual_moments = 512, max_moments = 1024; // without being asked for; at all
inline constexpr int max_costly_moments = 32;                     // of scenes whose moments take much memory

// Pixels that the fastest of lights, their beams, surfaces and media travels, the camera's own motion included; what
// never shows does not count. By a few points of each.
float motion_on_picture(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter);

// Whether anything may change while the shutter is open.
bool changes_while_open(const Scene& scene, int camera, const Shutter& shutter);

// A power of two: so many that the moments lie no more than 0.75 pixels apart, or max_usual_moments; at least 4 where
// anything changes, else 1; `finer` times as many where the error counts. Fewer where moving triangles would take more
// than 1 GiB, and, down to max_costly_moments, where what lights have in fog of voxels would take more than 4 GiB or,
// with `keeps_pictures`, what a mode has of each pixel more than 2. Fog that its velocities move takes
// max_costly_moments: its speed is in files that are not read yet.
int usual_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter,
                  bool keeps_pictures = false, int finer = 1);
}
