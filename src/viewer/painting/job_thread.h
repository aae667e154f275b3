// A thread for a job that writes files. The interface starts it, polls its progress and stops it, without waiting.
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

    // Throws Error (usage) while another job runs.
    void start(FileJob job);

    // Starts no more frames, and abandons those being rendered.
    void stop();

    std::optional<JobResult> take_result();  // of a finished job, once; until then it counts as running
    std::optional<JobStatus> status() const; // of the running job

private:
    void run(const FileJob& job);

    std::function<void()> news_;
    mutable std::mutex mutex_; // held only briefly
    std::shared_ptr<Progress> progress_;
    std::string name_;
    int frames_ = 0;
    std::optional<JobResult> result_;
    std::atomic<bool> cancel_{false};
    std::thread thread_;
};
}
