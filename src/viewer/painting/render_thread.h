// One thread that owns rendering. The interface posts what it wants and looks for what is there; it never waits.
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

// Pictures made so far.
struct PictureCounts {
    int pictures = 0, quick = 0;
    double quick_seconds = 0; // spent on the quick ones,
    StageTimes quick_stages;  // by stage
};

class RenderThread {
public:
    // `news` is called from the thread when there is something to look for.
    explicit RenderThread(std::function<void()> news = {});
    ~RenderThread(); // ends what is being made
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    // The newest request counts. Work on an older one is cancelled, but for a quick picture while things go on moving.
    void post(Request request);

    // Made one after the other, before anything else.
    void save(SaveJob job);

    // The newest picture that was not taken yet; null when there is none.
    std::shared_ptr<const ShownPicture> take_picture();
    std::optional<Saved> take_saved();

    bool idle() const;     // nothing is being made or will be, and everything was taken
    double saving() const; // share done of the file being written; negative: none is
    PictureCounts counts() const;

private:
    void run();
    void make_file(SaveJob job);

    std::function<void()> news_;
    mutable std::mutex mutex_; // held for moments only
    std::condition_variable wake_;
    std::optional<Request> pending_;
    std::deque<SaveJob> saves_;
    std::shared_ptr<const ShownPicture> picture_;
    std::deque<Saved> saved_;
    PictureCounts counts_;
    bool stop_ = false, unfinished_ = false, working_ = false, painting_quick_ = false;
    std::atomic<bool> cancel_{false}, cancel_save_{false};
    std::atomic<double> saving_{-1};
    const std::unique_ptr<Painter> painter_; // the thread's own
    std::thread thread_;
};
}
