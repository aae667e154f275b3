// A moment of a scene: which cameras it has, and where they are then.
#pragma once
#include <string>

namespace tyndall {
struct Camera;
struct Scene;

struct Moment {
    int frame = 0;
    double seconds = 0;
};
Moment moment_of(const Scene& scene, int frame);

Camera camera_at(const Scene& scene, int camera, double seconds);

// Index of a camera by name; empty = the default. Throws Error (usage) listing the names.
int find_camera(const Scene& scene, const std::string& name);
}
