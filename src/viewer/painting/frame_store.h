// Scenes at the moments that were looked at, with all that was made for them: a loop is grown, read and lit once.
#pragma once
#include "trace/snapshot.h"

#include <map>
#include <memory>
#include <optional>

namespace tyndall {
struct Scene;

// How much memory the frames of a store may take: a quarter of the machine's.
uint64_t usual_store_bytes();

class FrameStore {
public:
    explicit FrameStore(uint64_t max_bytes = usual_store_bytes());
    ~FrameStore();

    // Forgets everything that is not of this scene and policy.
    void begin(const std::shared_ptr<const Scene>& scene, MissingFrame missing);
    void clear();

    // A frame that is left. When memory is full it is not kept, and nor are those after it: what a loop comes back to
    // last is what it has left last.
    void put(const Snapshot& snapshot);

    // The frame as it was left or made ahead, its things ready to be found; nothing when it has to be made. What making
    // it ahead took is added to `seconds`.
    std::optional<Snapshot> take(int frame, double& seconds);

    // Makes a frame that will be asked for, sharing with `current`; false when it is there already. What the user
    // caused is said when it is asked for.
    bool make_ahead(int frame, const Snapshot& current);

    size_t size() const;

private:
    std::shared_ptr<const Scene> scene_;
    MissingFrame missing_ = MissingFrame::error;
    std::map<int, Snapshot> frames_;
    std::optional<Snapshot> ahead_;
    double ahead_seconds_ = 0;
    uint64_t max_bytes_ = 0, bytes_before_ = 0; // resident before the first frame
};
}
