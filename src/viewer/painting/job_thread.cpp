#include "viewer/painting/job_thread.h"

#include "base/parallel.h"

#include <utility>

namespace tyndall {
JobThread::JobThread(std::function<void()> news) : news_(std::move(news)) {}

JobThread::~JobThread() {
    stop();
    if (thread_.joinable()) thread_.join();
}

void JobThread::start(FileJob job) {
    {
        const std::scoped_lock lock(mutex_);
        if (progress_) fail(ExitCode::usage, name_of(job), "one job at a time: wait for " + name_ + " or stop it");
        name_ = name_of(job), frames_ = frame_count(job);
        progress_ = std::make_shared<Progress>(ProgressStyle::silent, name_, frames_);
        cancel_ = false;
    }
    if (thread_.joinable()) thread_.join(); // it has ended
    thread_ = std::thread([this, job = std::move(job)] { run(job); });
}

void JobThread::stop() { cancel_ = true; }

std::optional<JobStatus> JobThread::status() const {
    const std::scoped_lock lock(mutex_);
    if (!progress_) return {};
    return JobStatus{name_, frames_, progress_->share(), progress_->left(), cancel_};
}

std::optional<JobResult> JobThread::take_result() {
    const std::scoped_lock lock(mutex_);
    if (result_) progress_ = nullptr;
    return std::exchange(result_, std::nullopt);
}

void JobThread::run(const FileJob& job) {
    flush_denormals();
    JobResult result = run_job(job, *progress_, cancel_);
    {
        const std::scoped_lock lock(mutex_);
        result_ = std::move(result);
    }
    if (news_) news_();
}
}
