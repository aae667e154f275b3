// One thread for a job that writes files. The interface starts it, looks how far it is, stops it; it never waits.
#pragma once
#include "viewer/painting/file_job.h"

#include <functional>
#include <mutex>
#include <thread>

namespace tyndall {
class JobThread {
public:
    // `news` is called from the thread when the job has ended.
    explicit JobThread(std::function<void()> news = {});
    ~JobThread(); // stops the job: finished frames stay
    JobThread(const JobThread&) = delete;
    JobThread& operator=(const JobThread&) = delete;

    // Throws Error (usage) while another one runs.
    void start(FileJob job);

    // No frame is begun any more, and those being rendered are given up.
    void stop();

    std::optional<JobResult> take_result();  // of a job that has ended, once; until then it counts as running
    std::optional<JobStatus> status() const; // of the job that runs

private:
    void run(const FileJob& job);

    std::function<void()> news_;
    mutable std::mutex mutex_; // held for moments only
    std::shared_ptr<Progress> progress_;
    std::string name_;
    int frames_ = 0;
    double start_ = 0;
    std::optional<JobResult> result_;
    std::atomic<bool> cancel_{false};
    std::thread thread_;
};
}
