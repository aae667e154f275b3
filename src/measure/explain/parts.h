// The parts of explain_ray(). Internal to it.
#pragma once
#include "integrate/lights/light_along.h"
#include "measure/explain/explain.h"
#include "render/frame/frame.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
// What all parts of the ray share. Must not be moved: `depths` point into `fog`.
struct RayScene {
    View view; // one sample at the center of each pixel
    const Snapshot& snapshot;
    const Settings &settings, truth;
    Snapshot fog;                   // the snapshot with terms.* and style.* applied
    std::vector<LightDepth> depths; // of every light, in that fog
    const ExplainOptions& options;

    const Occluders* casters(size_t light) const { return shadow_casters(snapshot.lights[light], snapshot).get(); }
    // Points on a light that are sampled for its shadows.
    uint32_t points_of(const Light& light) const {
        return is_soft(light) ? static_cast<uint32_t>(truth.terms.light_points) : 1;
    }
};

// The ray from the eye, or from a BLEND surface, to the next surface.
struct RaySegment {
    const Ray& ray;
    const RayBatch& batch; // of this ray alone
    double start = 0;      // meters from the eye
    double depth = 0;      // optical depth before it
    double throughput = 1; // share of the light at its start that arrives at the eye
};

// A light along one part of the ray.
struct LightOnSegment {
    size_t light = 0;                 // of the snapshot
    LightAlong along;                 // of its first point
    std::vector<LightPoint> points;   // sampled for its shadows
    std::vector<LightStretch> shares; // each with an exact number of visible points
    std::vector<LightStretch> lit;    // the same, with partly lit neighbors merged
};

LightOnSegment light_on(const RayScene& scene, const RaySegment& segment, size_t light);

// Multiplies the shares of the part's steps, which start at `first_step` in the report, by the light that surfaces with
// alpha transmit, and divides on.lit accordingly.
void add_alpha_shadows(const RayScene& scene, const RaySegment& segment, size_t first_step, const RayReport& report,
                       LightOnSegment& on, std::vector<LightAtStep>& at);

// Names what blocks the light on stretches that are shadowed or partly lit.
void name_blockers(const RayScene& scene, const RaySegment& segment, LightOnSegment& on);

// Appends the part's steps, with what each light contributes and where it shines.
void append_fog(const RayScene& scene, const RaySegment& segment, RayReport& report);

ModeResult mode_result(const Mode& mode, const RayScene& scene, const RayReport& report);
}
