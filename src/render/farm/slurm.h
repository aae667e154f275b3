// The Slurm scripts of a job: submit.sh submits what is missing, task.sh is what each task runs.
#pragma once
#include "render/farm/forecast.h"

namespace tyndall {
// Slurm's default MaxArraySize is 1001: no array has a larger index than 1000.
inline constexpr int tasks_of_array = 1000;

std::string slurm_submit_script(const FarmJob& job, const TaskLimits& limits);
std::string slurm_task_script(const FarmJob& job);

// Task numbers as job arrays: "FIRST LIST" each, LIST counted from FIRST in the syntax of --array.
std::vector<std::string> slurm_arrays(const std::vector<int>& tasks);
}
