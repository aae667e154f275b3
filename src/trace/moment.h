// A moment of a scene, and the moments that a frame is made of: which cameras it has, and where they are then.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct Camera;
struct Scene;
struct Shutter;

struct Moment {
    int frame = 0; // of sequences of files
    double seconds = 0;
    std::optional<double> grown{}; // when its recipes are grown; none = then
};
Moment moment_of(const Scene& scene, int frame);

// All moments that a frame shows, which count the same.
struct FrameMoments {
    Moment middle;               // of the time that the shutter is open
    std::vector<Moment> moments; // in order; empty = the middle alone
};

// Sequences of files hold the frame's file. `count` below 2: the middle alone.
FrameMoments frame_moments(const Scene& scene, int frame, const Shutter& shutter, int count);

Camera camera_at(const Scene& scene, int camera, double seconds);

// Index of a camera by name; empty = the default. Throws Error (usage) listing the names.
int find_camera(const Scene& scene, const std::string& name);
}
