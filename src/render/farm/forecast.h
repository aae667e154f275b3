// Predicted memory and time of a job's tasks, measured on a small image of its first frame.
#pragma once
#include "render/farm/farm_job.h"
#include "render/sequence/job.h"

#include <atomic>

namespace tyndall {
struct Scene;

struct TaskForecast {
    double memory = 0;               // bytes
    std::optional<double> seconds{}; // of all frames of a task, on its processors; none if an error decides samples
};

// Seconds of a task, from those of a frame to load and prepare (`setup`) and for all its samples on `threads` threads.
// Fewer processors slow down both; more of them make only the samples faster, since loading is partly serial.
double task_seconds(const FarmJob& job, double setup, double samples, int threads);

// Measures the job's first frame, which it loads. Throws Error.
TaskForecast forecast_task(const FarmJob& job, const Scene& scene, const RenderRequest& asked,
                           std::atomic<bool>& cancel);

// Limits for an engine: half as much memory again and four times the time, for frames that take more than the first and
// for slower machines; the job's own limits take precedence. 0 = no limit.
struct TaskLimits {
    int memory = 0, minutes = 0; // MiB
};
TaskLimits limits_of(const FarmJob& job, const TaskForecast& forecast);
}
