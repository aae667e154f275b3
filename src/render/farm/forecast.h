// What the tasks of a job are likely to take, measured on a small picture of its first frame.
#pragma once
#include "render/farm/farm_job.h"
#include "render/sequence/job.h"

#include <atomic>

namespace tyndall {
struct Scene;

struct TaskForecast {
    double memory = 0;               // bytes
    std::optional<double> seconds{}; // of all frames of a task, on its processors; none where an error decides samples
};

// Of a task of the job, where a frame takes so long to load and prepare and all its samples so long on `threads`.
double task_seconds(const FarmJob& job, double setup, double samples, int threads);

// Loads the first of the job's frames. Throws Error.
TaskForecast forecast_task(const FarmJob& job, const Scene& scene, const RenderRequest& asked,
                           std::atomic<bool>& cancel);

// What an engine is told: half as much memory again and four times the time, for frames that take more than the first
// and machines that are slower; what the job states itself stands. 0 = nothing is told.
struct TaskLimits {
    int memory = 0, minutes = 0; // MiB
};
TaskLimits limits_of(const FarmJob& job, const TaskForecast& forecast);
}
