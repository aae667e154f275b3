// One light as one camera ray sees it: on which stretches its light arrives, and how much of it where.
#pragma once
#include "base/math.h"
#include "integrate/equi_angular.h"
#include "integrate/ray_batch.h"
#include "scene/light.h"
#include "trace/lights/light_ray.h"
#include "trace/shadows/intervals/shadow_slices.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;

struct LightAlong {
    const Light* light = nullptr;
    LightPoint point;                       // that casts the shadows of this ray
    dvec3 origin{0}, direction{0};          // of the ray
    double nearest = 0, distance = 0;       // local lights: where the ray passes, and how near
    double cone_scale = 0, cone_offset = 1; // as ConeFalloff, in double
    std::vector<Interval<double>> lit;      // ascending; cut where the light's strength has a kink
    // Where grid fog may stand between ray and light, and its voxels per metre across the light: the ray has to be
    // followed as finely as their shadows are drawn.
    struct ShadowedInterval {
        Interval<double> stretch;
        double voxels = 0;
    };
    std::vector<ShadowedInterval> shadowed;
    std::vector<double> kinks; // memory that find_light() reuses

    bool local() const { return !is_distant(*light); }
    double distance_to(double low, double high) const; // from the light to the nearest point of a stretch, or infinite
    double height() const;                             // of a local light over the ray, no less than its radius
    EquiAngular<double> angles(double low, double high) const; // of a stretch seen from a local light
    double shadow_voxels(double low, double high) const; // per metre, on a stretch that no end of one of these divides
};

// Unshadowed light at a point of the ray, as arrival() of scene/light.h, in double.
struct LightSamplesAt {
    dvec3 to_light;    // unit
    double amount = 0; // multiplies the light's intensity
    dvec3 tint{1};     // likewise: colours of a gobo
};
LightSamplesAt arriving_at(const LightAlong& along, double t);

// Fills `along` for a ray: what its light reaches of 0..t_max, less what `slices` (may be null) shadow, behind
// the grids among `media`.
void find_light(const Light& light, const LightPoint& point, const Ray& ray, const ShadowSlices* slices,
                std::span<const Medium> media, LightAlong& along);

// Point k of `count` points of a light, for a ray of a batch: well spread over the samples of a pixel. The centre of a
// light that is a point.
LightPoint light_point(const RayBatch& batch, size_t ray, const Light& light, size_t light_index, uint32_t k,
                       uint32_t count);
}
