// Small scenes of a few media, lights and meshes built in memory, for validation and tests.
#pragma once
#include "scene/light.h"
#include "scene/mesh.h"
#include "trace/snapshot.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"

#include <functional>

namespace tyndall {
struct Gobo;
struct IesProfile;

Phase forward_phase(float g);

Medium homogeneous_medium(float extinction, Box box = everywhere(), const Phase& phase = {}, vec3 albedo = vec3(1));

// A grid of voxels³ that fills the box 0..1; `density` is evaluated at voxel centers.
SparseVolume unit_volume(int voxels, const std::function<float(vec3)>& density);

Medium medium_of(const SparseVolume& volume, float extinction = 1);

Light sun_light(vec3 direction, float lux = 1);
Light point_light(vec3 position, float candela = 1);
Light spot_light(vec3 position, vec3 direction, float candela, float inner_cone, float outer_cone);

// Light filters: an IES profile with candela ~ cosine^power in the forward hemisphere, and a checkerboard gobo.
std::shared_ptr<const IesProfile> lobe_profile(double power);
std::shared_ptr<const Gobo> board_gobo(int squares, int texels_each, vec3 light, vec3 dark);
Light filtered_light(Light light, std::shared_ptr<const IesProfile> profile, std::shared_ptr<const Gobo> gobo);

// A parallelogram: a corner, and the two edges from it.
Mesh quad(vec3 corner, vec3 a, vec3 b, int material = -1);
Mesh box_of(vec3 low, vec3 high, int material = -1);
// A horizontal square of side 2 · half.
Mesh floor_of(float height, float half, int material = -1);

Snapshot snapshot_of(std::vector<Medium> media, std::vector<Light> lights = {}, vec3 ambient = vec3(0));

Material lambert(vec3 base_color, vec3 emission = vec3(0));

// Adds the scene's surfaces to the snapshot; the scene must outlive it.
void add_surfaces(const Scene& scene, Snapshot& snapshot);
}
