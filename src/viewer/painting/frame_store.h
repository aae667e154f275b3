// A cache of snapshots by frame, with everything computed from them: a loop is loaded, grown and lit only once.
#pragma once
#include "trace/snapshot.h"

#include <map>
#include <memory>
#include <optional>

namespace tyndall {
struct Scene;

// The default memory limit of a store: a quarter of the machine's memory.
uint64_t usual_store_bytes();

class FrameStore {
public:
    explicit FrameStore(uint64_t max_bytes = usual_store_bytes());
    ~FrameStore();

    // Discards everything that belongs to another scene or policy.
    void begin(const std::shared_ptr<const Scene>& scene, MissingFrame missing);
    void clear();

    // Stores a frame that is no longer shown. Once memory is full, new frames are not stored: a loop returns last to
    // the frames it left last.
    void put(const Snapshot& snapshot);

    // The stored or prefetched frame, with its cache ready for reuse; empty if it has to be made. Adds the time of
    // prefetching it to `seconds`.
    std::optional<Snapshot> take(int frame, double& seconds);

    // Prefetches a frame, sharing data with `current`; false if it exists already or fails. Errors are reported when
    // the frame is requested.
    bool prefetch(int frame, const Snapshot& current);

    size_t size() const;

private:
    std::shared_ptr<const Scene> scene_;
    MissingFrame missing_ = MissingFrame::error;
    std::map<int, Snapshot> frames_;
    std::optional<Snapshot> prefetched_;
    double ahead_seconds_ = 0;
    uint64_t max_bytes_ = 0, bytes_before_ = 0; // resident memory before the first frame
};
}
