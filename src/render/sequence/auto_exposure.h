// The exposure of PNGs when neither the scene nor the user sets one.
#pragma once
#include "render/image/view_transform.h"
#include "render/sequence/job.h"

#include <optional>
#include <vector>

namespace tyndall {
struct Snapshot;

// Exposure in stops, rounded to tenths, at which an image of these luminances is neither too bright nor too dark; none
// if all are black.
std::optional<double> exposure_for(std::vector<float> luminances);

// Whether PNGs of the request need automatic_exposure().
bool needs_auto_exposure(const Scene& scene, const RenderRequest& request);

// One exposure for all frames of a scene: what the brightest of its first, middle and last frame needs, measured on
// small images with one ray per pixel. Depends on scene, camera, aspect ratio, scattering orders and artistic settings,
// not on the requested frames, mode or quality. Frames that cannot be loaded are ignored; 0 if all is black. Static
// data is shared with `previous`, a snapshot of the same scene. `camera`, moved by hand, may replace the scene's.
double automatic_exposure(const Scene& scene, const RenderRequest& request, int orders,
                          const Snapshot* previous = nullptr, const Camera* camera = nullptr);

// The largest number of scatterings in a mode's images.
int orders_of(const Mode& mode, const Settings& settings);

// Exposure and view transform of a frame's PNG. A measured exposure is in the plan.
Display display_of(const Scene& scene, const RenderRequest& request, const RenderPlan& plan, int frame);
}
