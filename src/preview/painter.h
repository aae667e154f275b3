// Pictures of one request, each better than the one before: a quick small one while things move, then a whole one of
// the stand-in mode, then rounds of samples of the mode asked for, averaged.
#pragma once
#include "preview/pace.h"
#include "preview/request.h"

#include <map>
#include <optional>

namespace tyndall {
// What the rounds of a mode have come to.
struct Rounds {
    std::shared_ptr<const Prepared> prepared; // from the snapshot
    Layers layers;
    int samples = 0, rounds = 0;
    double sample_seconds = 0; // of the last round
};

// What lasts from picture to picture.
struct Painter {
    std::shared_ptr<const Scene> scene;          // of the snapshot,
    std::shared_ptr<const EditableParts> edited; // and the edits in it
    Snapshot snapshot;
    History history; // of quick pictures
    std::map<std::string, Pace> paces;
    int ticks = 0; // quick pictures and stand-ins so far
    bool begun = false;
    Request request; // of the newest picture
    bool quick = false, stood_in = false;
    Rounds rounds[2];     // of the mode, whose layers may be those of a quick picture, and of the mode beside
    ShownPicture picture; // all but its codes
};

// The next picture for a request; nothing when there is none to come. What the user caused is in ShownPicture::error.
// When `cancel` is set from outside, the work ends soon and nothing comes of it.
std::optional<ShownPicture> paint(Painter& painter, const Request& request, std::atomic<bool>& cancel);
}
