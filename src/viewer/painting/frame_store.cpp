#include "viewer/painting/frame_store.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/process.h"
#include "trace/frame_cache.h"

#include <utility>

namespace tyndall {
uint64_t usual_store_bytes() { return physical_memory() / 4; }

FrameStore::FrameStore(uint64_t max_bytes) : max_bytes_(max_bytes) {}
FrameStore::~FrameStore() = default;

size_t FrameStore::size() const { return frames_.size(); }

void FrameStore::begin(const std::shared_ptr<const Scene>& scene, MissingFrame missing) {
    if (scene == scene_ && missing == missing_) return;
    clear();
    scene_ = scene, missing_ = missing;
}

void FrameStore::clear() { frames_.clear(), prefetched_.reset(); }

void FrameStore::put(const Snapshot& snapshot) {
    if (!snapshot.cache || snapshot.scene != scene_.get()) return;
    if (frames_.empty()) bytes_before_ = resident_memory(); // which includes everything that snapshots refer to
    const bool is_there = frames_.contains(snapshot.frame);
    if (!is_there && resident_memory() >= bytes_before_ + max_bytes_) return;
    Snapshot& stored = frames_[snapshot.frame];
    stored = snapshot;
    stored.previous_cache = nullptr;
}

std::optional<Snapshot> FrameStore::take(int frame, double& seconds) {
    std::optional<Snapshot> found;
    if (const auto stored = frames_.find(frame); stored != frames_.end()) {
        found = stored->second;
        found->previous_cache = std::exchange(found->cache, std::make_shared<FrameCache>());
    } else if (prefetched_ && prefetched_->frame == frame) {
        found = std::exchange(prefetched_, std::nullopt);
        seconds += ahead_seconds_;
    }
    return found;
}

bool FrameStore::prefetch(int frame, const Snapshot& current) {
    if (!scene_ || frames_.contains(frame) || (prefetched_ && prefetched_->frame == frame)) return false;
    prefetched_.reset();
    const double start = steady_seconds();
    try {
        prefetched_ = make_snapshot(*scene_, moment_of(*scene_, frame), &current, missing_);
    } catch (const Error&) {
        return false;
    }
    ahead_seconds_ = steady_seconds() - start;
    return true;
}
}
