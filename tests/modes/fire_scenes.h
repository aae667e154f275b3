// Fog whose light and colors come from grids, written to files of a test's own folder, and its light along a ray.
#pragma once
#include "scene/scene.h"
#include "support/scratch.h"
#include "trace/snapshot.h"
#include "volume/bricks/sparse_volume.h"

#include <functional>

namespace tyndall::test {
// Voxels of .1 m, their centers at 0, .1, .2 ... m.
SparseVolume tenth_volume(ivec3 size, const std::function<float(ivec3)>& value);

// A file of one grid in the folder.
FileSequence grid_file(const TempFolder& scratch, const std::string& name, SparseVolume volume);

// Fog of that name with nothing but a density, or without one (`extinction` 0).
MediumSource grid_source(const TempFolder& scratch, const std::string& name, const SparseVolume& density,
                         float extinction, vec3 albedo = vec3(0));

// A property in a file of its own.
GridSource property(const TempFolder& scratch, const std::string& name, const SparseVolume& volume);

Snapshot snapshot_with(Scene& scene, const MediumSource& medium);

// Within a share of the red.
void expect_light(vec3 found, dvec3 expected, double share, const std::string& what);

// Of the light along a ray, in every way that looks at it point by point.
void expect_along(const Snapshot& snapshot, const Ray& ray, dvec3 expected, const std::string& what,
                  double share = 1e-3);
}
