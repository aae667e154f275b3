// The thread that owns rendering. The interface posts requests and polls for results, without waiting.
#pragma once
#include "viewer/painting/request.h"
#include "viewer/painting/save_picture.h"
#include "viewer/painting/shown_picture.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace tyndall {
struct Painter;

// Images made so far.
struct PictureCounts {
    int pictures = 0, quick = 0;
    double quick_seconds = 0; // spent on the quick ones,
    StageTimes quick_stages;  // by stage
};

class RenderThread {
public:
    // `news` is called from the thread when there is a new result.
    explicit RenderThread(std::function<void()> news = {});
    ~RenderThread(); // cancels work in progress
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    // Replaces the previous request. Cancels work on it, except for a quick image while things keep moving.
    void post(Request request);

    // Queues a file to save; these are made one at a time, before anything else.
    void save(SaveJob job);

    // The newest image that was not taken yet; null if there is none.
    std::shared_ptr<const ShownPicture> take_picture();
    std::optional<SaveResult> take_saved();

    bool idle() const;     // nothing is in progress or pending, and the image was taken
    double saving() const; // progress of the file being written, 0 to 1; negative: none
    PictureCounts counts() const;

private:
    void run();
    void make_file(SaveJob job);

    std::function<void()> news_;
    mutable std::mutex mutex_; // held only briefly
    std::condition_variable wake_;
    std::optional<Request> pending_;
    std::deque<SaveJob> saves_;
    std::shared_ptr<const ShownPicture> picture_;
    std::deque<SaveResult> saved_;
    PictureCounts counts_;
    bool stop_ = false, unfinished_ = false, working_ = false, painting_quick_ = false;
    std::atomic<bool> cancel_{false}, cancel_save_{false};
    std::atomic<double> saving_{-1};
    const std::unique_ptr<Painter> painter_; // used only by the thread
    std::thread thread_;
};
}
