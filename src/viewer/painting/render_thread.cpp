#include "viewer/painting/render_thread.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"
#include "modes/history.h"
#include "viewer/painting/painter.h"

#include <new>
#include <utility>

namespace tyndall {
namespace {

void count_quick(const ShownPicture& picture, double seconds, PictureCounts& counts) {
    StageTimes& sum = counts.quick_stages;
    const StageTimes& times = picture.times;
    ++counts.quick, counts.quick_seconds += seconds;
    sum.load += times.load, sum.prepare += times.prepare, sum.fog += times.fog;
    sum.render += times.render, sum.tone += times.tone;
}
}

RenderThread::RenderThread(std::function<void()> news)
    : news_(std::move(news)), painter_(std::make_unique<Painter>()), thread_([this] { run(); }) {}

RenderThread::~RenderThread() {
    {
        const std::scoped_lock lock(mutex_);
        stop_ = true, cancel_ = true, cancel_save_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void RenderThread::post(Request request) {
    {
        const std::scoped_lock lock(mutex_);
        const bool let_finish = painting_quick_ && request.moving;
        if (working_ && !let_finish) cancel_ = true;
        pending_ = std::move(request);
    }
    wake_.notify_one();
}

void RenderThread::save(SaveJob job) {
    {
        const std::scoped_lock lock(mutex_);
        saves_.push_back(std::move(job));
    }
    wake_.notify_one();
}

std::shared_ptr<const ShownPicture> RenderThread::take_picture() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(picture_, nullptr);
}

std::optional<SaveResult> RenderThread::take_saved() {
    const std::scoped_lock lock(mutex_);
    if (saved_.empty()) return {};
    SaveResult saved = std::move(saved_.front());
    saved_.pop_front();
    return saved;
}

bool RenderThread::idle() const {
    const std::scoped_lock lock(mutex_);
    return !pending_ && !unfinished_ && !working_ && !picture_ && saves_.empty();
}

double RenderThread::saving() const { return saving_; }

PictureCounts RenderThread::counts() const {
    const std::scoped_lock lock(mutex_);
    return counts_;
}

void RenderThread::make_file(SaveJob job) {
    const double start = steady_seconds();
    SaveResult saved{job.file, 0, {}, ExitCode::ok};
    saving_ = 0;
    try {
        const bool same = painter_->scene == job.request.scene;
        save_picture(job, same ? &painter_->snapshot : nullptr, cancel_save_, [&](double share) { saving_ = share; });
    } catch (const Error& error) {
        saved.error = error.what(), saved.code = error.code;
    } catch (const std::bad_alloc&) {
        saved.error = "out of memory", saved.code = ExitCode::out_of_memory;
    } catch (const std::exception& error) {
        saved.error = error.what(), saved.code = ExitCode::internal;
    }
    saved.seconds = steady_seconds() - start;
    saving_ = -1;
    const std::scoped_lock lock(mutex_);
    saved_.push_back(std::move(saved));
}

void RenderThread::run() {
    flush_denormals();
    std::optional<Request> current;
    while (true) {
        std::optional<SaveJob> save;
        {
            std::unique_lock lock(mutex_);
            working_ = painting_quick_ = false;
            wake_.wait(lock, [&] { return stop_ || pending_ || unfinished_ || !saves_.empty(); });
            if (stop_) return;
            working_ = true, cancel_ = false;
            if (!saves_.empty()) {
                save = std::move(saves_.front());
                saves_.pop_front();
            } else {
                if (pending_) current = std::exchange(pending_, std::nullopt);
                painting_quick_ = current->moving;
            }
        }
        if (save) {
            make_file(std::move(*save));
        } else {
            const double start = steady_seconds();
            std::optional<ShownPicture> picture = paint(*painter_, *current, cancel_);
            const std::scoped_lock lock(mutex_);
            unfinished_ = !picture ? false : !picture->finished;
            if (!picture && current->moving && counts_.quick > 0) counts_.quick_seconds += steady_seconds() - start;
            if (picture) {
                ++counts_.pictures;
                if (picture->quick) count_quick(*picture, steady_seconds() - start, counts_);
                picture_ = std::make_shared<const ShownPicture>(std::move(*picture));
            }
        }
        if (news_) news_();
    }
}
}
