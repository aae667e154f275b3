// What the interface asks for, and the pictures it gets.
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

// What of a medium's density is to be seen.
enum class VolumeLook { slice, maximum, mean };
struct VolumeQuestion {
    std::string medium; // empty = the first
    VolumeLook look = VolumeLook::slice;
    int axis = 2;          // across which, or along which
    float position = 0.5f; // of a slice, as a share of the medium's extent

    bool operator==(const VolumeQuestion&) const = default;
};

struct Request {
    std::shared_ptr<Scene> scene;                // only the thread that renders touches it, and puts `edited` into it
    std::shared_ptr<const EditableParts> edited; // null: the scene as it is
    uint64_t revision = 0;                       // another number: the picture is another one
    uint64_t shown_revision = 0;                 // another number: the same picture is shown in another way
    bool moving = false;                         // the next change is near: quick pictures only
    int frame = 1;
    std::optional<int> next_frame; // that will be asked for, while playing
    Camera camera;
    ivec2 size{640, 360};
    std::string mode = main_mode_name();
    std::string stand_in = interactive_mode_name(); // mode of quick pictures when `mode` is slow; empty = the same
    std::string beside; // mode of the right part of still pictures, or reference; empty = none
    Settings settings;
    uint32_t seed = 0;
    MissingFrame missing = MissingFrame::error;
    Shown shown;
    int measures = 0;             // another number: an exposure that was measured is measured anew
    std::optional<ivec2> explain; // a pixel whose ray is asked about
    std::optional<VolumeQuestion> volume;
    int max_samples = 64;             // per pixel, after which a picture is finished
    double wanted_seconds = 1.0 / 30; // of quick pictures
};

// The mode of quick pictures.
const std::string& quick_mode(const Request& request);

// What tyndall render would be told to make the finished picture.
RenderRequest render_request(const Request& request);
View view_of(const Request& request);

// Puts the edits of the request into its scene: before anything is read from it.
void stage(const Request& request);
}
