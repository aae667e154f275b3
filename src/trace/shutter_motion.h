// How far things move on the picture while the shutter is open, and how many moments show that as one blur.
#pragma once
#include "base/math.h"

namespace tyndall {
struct MediumSource;
struct Scene;
struct Shutter;

inline constexpr int max_usual_moments = 512, max_moments = 1024; // without being asked for; at all
inline constexpr int moments_of_velocities = 32;                  // of fog that they move, at least

// Pixels that the fastest of lights, their beams, surfaces and media travels, the camera's own motion included; what
// never shows does not count. By a few points of each.
float motion_on_picture(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter);

// Whether a medium has keys, moving noise or velocities: whether it changes with time, apart from files one a frame.
bool changes(const MediumSource& medium);

// Whether anything may change while the shutter is open.
bool changes_while_open(const Scene& scene, int camera, const Shutter& shutter);

// A power of two: so many that the moments lie no more than 0.75 pixels apart, or max_usual_moments; at least 4 where
// anything changes, else 1; `finer` times as many where the error counts. Fewer, down to 4, where they would take more
// than 8 GiB; `keeps_pictures`: of a mode that keeps something of each pixel and light. Fog that its velocities move
// wants moments_of_velocities: its speed is in files that are not read yet.
int usual_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter,
                  bool keeps_pictures = false, int finer = 1);
}
