// The commands of a job, as words for whatever runs them: a shell, an engine, or a reader of `tyndall status`.
#pragma once
#include "render/farm/farm_job.h"

namespace tyndall {
// What differs between tasks and engines. Frames are a range, or a single frame if each has its own plan.
struct CommandVars {
    std::string folder; // of the job, with a trailing slash; empty if commands run in it
    std::string scene, frames, part;
};

// Words after `tyndall`.
using CommandArgs = std::vector<std::string>;
CommandArgs plan_args(const FarmJob& job, const CommandVars& vars);
CommandArgs prepare_args(const FarmJob& job, const CommandVars& vars);
CommandArgs render_args(const FarmJob& job, const CommandVars& vars);
CommandArgs merge_args(const FarmJob& job, const CommandVars& vars);
}
