// One light along one camera ray: the intervals it reaches, and the amount of light at each point.
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
    LightPoint point;                       // point on the light used for this ray's shadows
    dvec3 origin{0}, direction{0};          // of the ray
    double nearest = 0, distance = 0;       // local lights: t of the closest point, and its distance
    double cone_scale = 0, cone_offset = 1; // like ConeFalloff, in double
    std::vector<Interval<double>> lit;      // ascending; split where the light's intensity has a kink
    // Intervals where grid fog may lie between ray and light, and its voxels per meter perpendicular to the light:
    // steps on the ray must resolve their shadows.
    struct ShadowedInterval {
        Interval<double> stretch;
        double voxels = 0;
    };
    std::vector<ShadowedInterval> shadowed;
    std::vector<double> kinks; // scratch memory of find_light()

    bool local() const { return !is_distant(*light); }
    // From the light to the nearest point of low..high; infinite for distant lights.
    double distance_to(double low, double high) const;
    double height() const; // distance of a local light from the ray, at least its radius
    EquiAngular<double> angles(double low, double high) const; // low..high as seen from a local light
    // Voxels per meter on low..high, which must not cross the end of a shadowed interval.
    double shadow_voxels(double low, double high) const;
};

// Unshadowed light at a point of the ray, like arrival() of scene/light.h, in double.
struct LightSamplesAt {
    dvec3 to_light;    // unit
    double amount = 0; // multiplies the light's intensity
    dvec3 tint{1};     // likewise: gobo color
};
LightSamplesAt arriving_at(const LightAlong& along, double t);

// Fills `along` for a ray: the parts of 0..t_max that the light reaches, minus the shadows of `slices` (may be null),
// and the intervals behind the grids among `media`.
void find_light(const Light& light, const LightPoint& point, const Ray& ray, const ShadowSlices* slices,
                std::span<const Medium> media, LightAlong& along);

// Sample point k of `count` on a light for a ray, stratified over a pixel's samples; the center for point lights.
LightPoint light_point(const RayBatch& batch, size_t ray, const Light& light, size_t light_index, uint32_t k,
                       uint32_t count);
}
