// Explains what happens on the ray of a pixel of the shown image.
#pragma once
#include "measure/explain/explain.h"

#include <memory>

namespace tyndall {
struct Request;
struct Snapshot;

struct RayAnswer {
    uint64_t revision = 0; // of the image it refers to
    ivec2 pixel{0};
    int frame = 1;
    RayReport report;
    bool complete = false; // includes the results of the modes
    double seconds = 0;
};

// Whether the request asks for a ray that `answer` does not fully explain.
bool asks_for_ray(const Request& request, const RayAnswer* answer);

// The next answer: first the ray itself, then the same with every mode's result. Throws Error (internal) when
// cancelled.
std::shared_ptr<const RayAnswer> answer_ray(const Request& request, const Snapshot& snapshot, const RayAnswer* before,
                                            std::atomic<bool>& cancel);
}
