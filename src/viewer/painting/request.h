// What the interface asks the render thread for.
#pragma once
#include "base/io/file_sequence.h"
#include "modes/settings.h"
#include "scene/camera.h"
#include "viewer/painting/tone.h"

#include <memory>
#include <optional>

namespace tyndall {
struct EditableParts;
struct RenderRequest;
struct Scene;
struct View;

// How a medium's density is shown.
enum class VolumeLook { slice, maximum, mean };
struct VolumeRequest {
    std::string medium; // empty = the first
    VolumeLook look = VolumeLook::slice;
    int axis = 2;          // of the slice's normal, or of the projection
    float position = 0.5f; // of a slice, as a fraction of the medium's extent

    bool operator==(const VolumeRequest&) const = default;
};

struct Request {
    std::shared_ptr<Scene> scene;                // used only by the render thread, which copies `edited` into it
    std::shared_ptr<const EditableParts> edited; // null: the scene as it is
    uint64_t revision = 0;                       // changes when the image changes
    uint64_t shown_revision = 0;                 // changes when only the display of the image changes
    bool moving = false;                         // another change is expected soon: quick images only
    int frame = 1;
    std::optional<int> next_frame; // the next to be requested, while playing
    Camera camera;
    ivec2 size{640, 360};
    std::string mode = main_mode_name();
    std::string stand_in = interactive_mode_name(); // mode of quick images if `mode` is slow; empty = the same
    std::string beside; // mode of the right part of still images, or the reference; empty = none
    Settings settings;
    uint32_t seed = 0;
    MissingFrame missing = MissingFrame::error;
    DisplayOptions shown;
    int metering_id = 0;          // changes when automatic exposure has to be measured again
    std::optional<ivec2> explain; // a pixel whose ray is to be explained
    std::optional<VolumeRequest> volume;
    int max_samples = 64;             // per pixel, after which an image is finished
    double wanted_seconds = 1.0 / 30; // per quick image
};

// The mode of quick images.
const std::string& quick_mode(const Request& request);

// The request to tyndall render that gives the finished image.
RenderRequest render_request(const Request& request);
View view_of(const Request& request);

// Copies the request's edits into its scene; call before reading from the scene.
void apply_edits(const Request& request);
}
