// Progressive images for a request: a quick small one while things move, then a full-size one of the stand-in mode,
// then averaged rounds of samples of the requested mode, alternating with those of the comparison mode and of the
// reference, if shown.
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
// State that is kept from image to image.
struct Painter {
    std::shared_ptr<const Scene> scene;          // of the snapshot,
    std::shared_ptr<const EditableParts> edited; // and the edits in it
    Snapshot snapshot;
    FrameStore store; // of this scene's frames
    History history;  // of quick images
    std::map<std::string, Pace> paces;
    std::optional<double> exposure; // measured for ...
    int metering_id = -1;           // ... this Request::metering_id and the scene `measured`
    std::weak_ptr<const Scene> measured;
    int ticks = 0; // quick images and stand-ins so far
    bool begun = false;
    Request request; // of the newest image
    bool quick = false, stood_in = false;
    Rounds rounds[2]; // of the mode, whose layers may be those of a quick image, and of the comparison mode
    ReferencePicture reference;
    std::shared_ptr<const RayAnswer> ray;
    std::shared_ptr<const VolumePicture> volume;
    KnownVolumes known_volumes;
    ShownPicture picture; // everything except its codes
};

// The next image for a request; empty if there is none. Errors are returned in ShownPicture::error. If `cancel` is set
// from another thread, the work ends soon without a result.
std::optional<ShownPicture> paint(Painter& painter, const Request& request, std::atomic<bool>& cancel);
}
