// Moments in time: a single one, the moments that a frame averages, and a scene's nodes and cameras at a time.
#pragma once
#include "base/math.h"
#include "scene/keyed.h"
#include "scene/shutter.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct Camera;
struct Scene;

struct Moment {
    int frame = 0; // of the scene; selects files of sequences
    double seconds = 0;
    std::optional<double> grown{}; // seconds at which recipes and moving files are evaluated; none = `seconds`
    // Seconds over which brightness is averaged, so that no flash is missed; weights add up to 1; empty = `seconds`.
    std::vector<ExposedTime> exposed{};
};
Moment moment_of(const Scene& scene, int frame);

// A brightness over a moment's share of the exposure; `value` takes seconds.
template<class Value> auto mean_brightness(const Moment& moment, const Value& value) {
    if (moment.exposed.empty()) return value(moment.seconds);
    decltype(value(moment.seconds)) sum(0);
    for (const ExposedTime& exposed : moment.exposed) sum += static_cast<float>(exposed.weight) * value(exposed.time);
    return sum;
}

// The mean of a factor on brightness over the moment, weighted by that brightness.
template<class Value> float mean_factor(const Moment& moment, const Keyed<float>& factor, const Value& brightness) {
    if (factor.constant()) return factor.at(moment.seconds);
    const float whole = mean_brightness(moment, brightness);
    if (!(whole > 0)) return factor.at(moment.seconds);
    return mean_brightness(moment, [&](double s) { return brightness(s) * factor.at(s); }) / whole;
}

// The moments that a frame averages, with equal weights.
struct FrameMoments {
    Moment middle;               // of the shutter interval
    std::vector<Moment> moments; // in order; empty = only the middle
};

// `count` moments of the shutter interval; only the middle if `count` is below 2. All have the frame's number.
FrameMoments frame_moments(const Scene& scene, int frame, const Shutter& shutter, int count);

// A node's position and axes; `forward` is normalized.
struct NodeFrame {
    vec3 position, up, forward;
};

// Throws Error (refused) that begins with `what` if the node's transform is singular or not finite; not for lights with
// is_hidden().
NodeFrame node_frame(const Scene& scene, int node, double seconds, const std::string& what);

Camera camera_at(const Scene& scene, int camera, double seconds);

// Index of a camera by name; empty = the default. Throws Error (usage) listing the names.
int find_camera(const Scene& scene, const std::string& name);
}
