// Scenes of one medium and one light, made in memory, with surfaces where wanted.
#pragma once
#include "scene/light.h"
#include "support/meshes.h"
#include "trace/snapshot.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <functional>
#include <memory>

namespace tyndall::test {
Medium even_fog(float extinction, Box box = everywhere(), Phase phase = {PhaseKind::isotropic, 0});

Light sun(vec3 direction, float lux = 1);

Light point_light(vec3 position, float candela = 1);

Snapshot scene_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient = vec3(0));

// A grid of n³ voxels that fills the unit box 0..1; density at voxel centres from `value`.
SparseVolume unit_grid(int n, const std::function<float(vec3)>& value);

Medium grid_fog(float extinction, const SparseVolume& volume);

// A snapshot with triangles; keeps their scene.
struct Stage {
    std::shared_ptr<Scene> scene;
    Snapshot snapshot;
};
Stage stage_of(std::vector<Medium> media, std::vector<Light> lights, std::vector<Mesh> meshes, vec3 ambient = vec3(0));

// Opaque over x < edge at height y, far out to the other sides.
Mesh shade(float edge, float y);
}
