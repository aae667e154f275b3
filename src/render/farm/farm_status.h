// What of a job is finished, told by the names of its files, their sizes and headers.
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
    uint64_t temporaries = 0; // of tasks that write, or were killed
    uint64_t checkpoints = 0; // of parts that were begun
};

// Frames without parts count as finished: parts may be removed once they are merged. With `verify` every byte is read.
// Throws Error (unreadable).
FarmStatus look_at(const FarmJob& job, bool verify, const std::atomic<bool>& cancel);

// The tasks of a step (plan, prepare, parts, merge) that are not done, numbered as the job's scripts do: chunks in
// order, and within them parts.
std::vector<int> missing_tasks(const FarmJob& job, const FarmStatus& status, const std::string& step);

// Commands that make just what is missing, in this order, ready for a shell.
std::vector<std::string> missing_commands(const FarmJob& job, const FarmStatus& status);
}
