// Pictures of one request, each better than the one before: a quick small one while things move, then a whole one of
// the stand-in mode, then rounds of samples of the mode asked for, averaged; in turns with those of the mode beside and
// of the reference, when they are shown.
#pragma once
#include "modes/history.h"
#include "viewer/painting/frame_store.h"
#include "viewer/painting/pace.h"
#include "viewer/painting/ray_question.h"
#include "viewer/painting/reference_picture.h"
#include "viewer/painting/request.h"
#include "viewer/painting/shown_picture.h"
#include "viewer/painting/volume_picture.h"

#include <map>
#include <optional>

namespace tyndall {
// What lasts from picture to picture.
struct Painter {
    std::shared_ptr<const Scene> scene;          // of the snapshot,
    std::shared_ptr<const EditableParts> edited; // and the edits in it
    Snapshot snapshot;
    FrameStore store; // of this scene's frames
    History history;  // of quick pictures
    std::map<std::string, Pace> paces;
    std::optional<double> exposure; // measured,
    int measures = -1;              // for this number of the request, and of `measured`
    std::weak_ptr<const Scene> measured;
    int ticks = 0; // quick pictures and stand-ins so far
    bool begun = false;
    Request request; // of the newest picture
    bool quick = false, stood_in = false;
    Rounds rounds[2]; // of the mode, whose layers may be those of a quick picture, and of the mode beside
    ReferencePicture reference;
    std::shared_ptr<const RayAnswer> ray;
    std::shared_ptr<const VolumePicture> volume;
    KnownVolumes known_volumes;
    ShownPicture picture; // all but its codes
};

// The next picture for a request; nothing when there is none to come. What the user caused is in ShownPicture::error.
// When `cancel` is set from outside, the work ends soon and nothing comes of it.
std::optional<ShownPicture> paint(Painter& painter, const Request& request, std::atomic<bool>& cancel);
}
