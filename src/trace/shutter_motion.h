// How far things move across the image while the shutter is open, and how many moments motion blur needs.
#pragma once
#include "base/math.h"

namespace tyndall {
struct LightSource;
struct MediumSource;
struct Scene;
struct Shutter;

inline constexpr int max_auto_moments = 512, max_moments = 1024; // chosen automatically; on request
inline constexpr int moments_of_velocities = 32;                 // minimum for fog that velocities move

// Distance in pixels that the fastest light, beam, shadow, surface or medium travels across the image, camera motion
// included. Estimated from a few points of each (shutter_points.h); points that stay out of view do not count.
float image_motion(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter);

// Whether a light changes in anything but brightness.
bool changes(const Scene& scene, const LightSource& light);

// Whether a medium changes within a frame: keyframes, moving noise, velocities or blended files. One file per frame
// alone does not count.
bool changes(const MediumSource& medium);

// Whether anything may change while the shutter is open besides the brightness of lights and of the background, whose
// mean one moment shows as well.
bool moves_while_open(const Scene& scene, int camera, const Shutter& shutter);

// Number of moments for motion blur, a power of two: enough that they lie at most 0.75 pixels apart, at least 4 if
// anything moves, else 1; times `finer` for an error target; at most affordable_moments(). Fog moved by velocities gets
// at least moments_of_velocities, as its speed is in files that are not read yet.
int auto_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter,
                 bool keeps_images = false, int finer = 1);

// The largest such number: max_auto_moments, or fewer, down to 4, if they would take more than 8 GiB. `keeps_images`:
// the mode stores data per pixel and light.
int affordable_moments(const Scene& scene, int camera, ivec2 size, int frame, const Shutter& shutter,
                       bool keeps_images);
}
