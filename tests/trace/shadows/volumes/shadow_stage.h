// Boxes before a light, and what a ray crosses of their shadow volumes.
#pragma once
#include "support/random_points.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/shadows/shadow_rays.h"
#include "trace/shadows/volumes/shadow_view.h"
#include "trace/small_scenes.h"

namespace tyndall::test {
struct Stage {
    std::vector<ShadowTriangle> triangles;
    ShadowSlices slices;
    ShadowVolumes volumes;
    LightPoint light;
};
Stage stage_of(std::vector<ShadowTriangle> triangles, const LightPoint& light);
Stage stage_of(const std::vector<Mesh>& meshes, const LightPoint& light);

inline const Box room{vec3(-4), vec3(4)};
inline const LightPoint lights[] = {sun_from({0.3f, 1, 0.2f}), lamp_at({0.5f, 3, -0.4f}), lamp_at({0.1f, 0.2f, 0.3f}),
                                    sun_from({1, 0.001f, 0})};

std::vector<ShadowTriangle> triangles_of(const std::vector<Mesh>& meshes);
std::vector<Mesh> random_boxes(int count);

inline constexpr int lane = 5; // of the rays asked about

// What a ray crosses, and how many volumes hold its origin.
struct Counted {
    int dark = 0;
    std::vector<ShadowCrossing> crossings;

    int at(double t) const;                                    // volumes that hold the point
    std::vector<Interval<double>> lit(Interval<double> range); // sorts the crossings
};

Counted crossings_of(const ShadowView& view, const Ray& ray, int tile = -1);
}
