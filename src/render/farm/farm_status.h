// Which frames and parts of a job are finished, by the names, sizes and headers of its files.
#pragma once
#include "render/farm/farm_job.h"

#include <atomic>

namespace tyndall {
struct FarmFrame {
    int frame = 0;
    bool planned = true, finished = false;
    std::vector<int> missing; // parts, where the frame is not finished
};

// A file that is there but cannot be used.
struct SuspectFile {
    std::string file, why;
};

struct FarmStatus {
    std::vector<FarmFrame> frames; // of the job, in its order
    std::vector<SuspectFile> suspects;
    uint64_t temporaries = 0; // of running or killed tasks
    uint64_t checkpoints = 0; // of unfinished parts
};

// A merged frame counts as finished without its parts, which may be removed after merging. With `verify` every byte is
// read. Throws Error (unreadable).
FarmStatus job_status(const FarmJob& job, bool verify, const std::atomic<bool>& cancel);

// The unfinished tasks of a step (plan, prepare, parts, merge), numbered as in the job's scripts: chunks in order, and
// parts within them.
std::vector<int> missing_tasks(const FarmJob& job, const FarmStatus& status, const std::string& step);

// Shell commands that make exactly what is missing, in this order.
std::vector<std::string> missing_commands(const FarmJob& job, const FarmStatus& status);
}
