// What explain_ray() is made of. Internal to it.
#pragma once
#include "integrate/lights/light_along.h"
#include "measure/explain/explain.h"
#include "render/frame/frame.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
// What all of the ray shares. Not to be moved: `depths` point into `fog`.
struct RayScene {
    View view; // one sample at the centre of each pixel
    const Snapshot& snapshot;
    const Settings &settings, truth;
    Snapshot fog;                   // as march.* and style.* see it
    std::vector<LightDepth> depths; // of every light, in that fog
    const ExplainOptions& options;

    const Occluders* casters(size_t light) const { return shadow_casters(snapshot.lights[light], snapshot).get(); }
    // Points of a light that are asked for its shadows.
    uint32_t points_of(const Light& light) const {
        return is_soft(light) ? static_cast<uint32_t>(truth.terms.light_points) : 1;
    }
};

// The ray from the eye, or from a BLEND surface, to the next surface.
struct RayPart {
    const Ray& ray;
    const RayBatch& batch; // of this ray alone
    double start = 0;      // metres from the eye
    double depth = 0;      // optical depth before it
    double through = 1;    // share of the light at its start that arrives at the eye
};

// A light along one part of the ray.
struct LightOnPart {
    size_t light = 0;                 // of the snapshot
    LightAlong along;                 // of its first point
    std::vector<LightPoint> points;   // that cast its shadows
    std::vector<LightStretch> shares; // exact: of how many of its points the light comes
    std::vector<LightStretch> lit;    // the same, with all that is partly lit put together
};

LightOnPart light_on(const RayScene& scene, const RayPart& part, size_t light);

// Shares of the light that surfaces with alpha let through to the steps, first to last of the story; and the
// stretches as the steps see them.
void add_alpha_shadows(const RayScene& scene, const RayPart& part, size_t first_step, const RayStory& story,
                       LightOnPart& on, std::vector<LightAtStep>& at);

// Names what stands between the light and the stretches that lack some of it.
void name_blockers(const RayScene& scene, const RayPart& part, LightOnPart& on);

// Appends the part's steps, what each light does at them, and where it is lit.
void append_fog(const RayScene& scene, const RayPart& part, RayStory& story);

std::string name_of_instance(const Snapshot& snapshot, int instance);

Answer answer_of(const Mode& mode, const RayScene& scene, const RayStory& story);
}
