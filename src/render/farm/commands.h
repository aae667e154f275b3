// The commands of a job, as words for whatever runs them: a shell, an engine, or a reader of `tyndall status`.
#pragma once
#include "render/farm/farm_job.h"

namespace tyndall {
// What differs between tasks and engines. Frames are a range, or a single frame if each has its own plan.
struct CommandBlanks {
    std::string folder; // of the job, with a trailing slash; empty if commands run in it
    std::string scene, frames, part;
};

// Words after `tyndall`.
using CommandWords = std::vector<std::string>;
CommandWords plan_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords prepare_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords render_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords merge_words(const FarmJob& job, const CommandBlanks& blanks);
}
