// The exposure of PNGs when neither the scene nor the user sets one.
#pragma once
#include "render/image/view_transform.h"
#include "render/sequence/job.h"

#include <optional>
#include <vector>

namespace tyndall {
struct Snapshot;

// Stops, in tenths, that show a picture of these luminances neither white nor black; nothing where all are black.
std::optional<double> exposure_for(std::vector<float> luminances);

// Whether PNGs of the request need automatic_exposure().
bool measures_exposure(const Scene& scene, const RenderRequest& request);

// Of all frames of a scene as the brightest of its first, middle and last one needs it, looked at in small pictures of
// one ray per pixel. It depends on scene, camera, picture's shape, orders and artistic settings, and not on the frames,
// the mode or the quality asked for. Frames that cannot be loaded do not count; 0 where all is black. Standing things
// are shared with `previous`, a snapshot of the same scene. A camera moved by hand may stand in for the scene's.
double automatic_exposure(const Scene& scene, const RenderRequest& request, int orders,
                          const Snapshot* previous = nullptr, const Camera* camera = nullptr);

// How many times light may scatter in a mode's pictures.
int orders_of(const Mode& mode, const Settings& settings);

// How the PNG of a frame looks. The plan has the exposure that was measured.
Display display_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, int frame);
}
