// The commands a job consists of, as words for whoever runs them: a shell, an engine, or a reader of `tyndall status`.
#pragma once
#include "render/farm/farm_job.h"

namespace tyndall {
// What differs from task to task and from engine to engine. Frames are a range, or one frame where each has its plan.
struct CommandBlanks {
    std::string folder; // of the job, with a slash at its end; empty where commands run in it
    std::string scene, frames, part;
};

// Words after `tyndall`.
using CommandWords = std::vector<std::string>;
CommandWords plan_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords prepare_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords render_words(const FarmJob& job, const CommandBlanks& blanks);
CommandWords merge_words(const FarmJob& job, const CommandBlanks& blanks);
}
