// Scenes without files and light along single rays, for checks. Internal to verify.
#pragma once
#include "integrate/ray_batch.h"
#include "measure/verify/verify.h"
#include "modes/settings.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

namespace tyndall {
struct Light;
struct Medium;
struct Mode;
struct Snapshot;
// A list of checks under way.
struct Checks {
    std::vector<Check> list;
    std::string topic;
    std::function<void(double)> progress; // 0..1 of the current group; may be empty
    uint64_t non_finite = 0;              // samples of pictures rendered so far

    void add(std::string name, double measured, double expected, double tolerance, std::string basis);
};

struct CheckGroup {
    const char* topic;
    double share; // of the whole time, about
    std::function<void(Checks&)> run;
};
std::vector<CheckGroup> closed_form_checks();
std::vector<CheckGroup> transport_checks();
std::vector<CheckGroup> invariance_checks();

// Runs groups one after the other.
std::vector<Check> run_checks(std::span<const CheckGroup> groups, const VerifyControl& control);

// --- scenes ------------------------------------------------------------------------------------------------------
Phase forward_phase(float g);
Medium even_medium(float extinction, Box box, Phase phase = forward_phase(0), vec3 albedo = vec3(1));
Medium noise_medium(float extinction, Phase phase = forward_phase(0), vec3 albedo = vec3(1)); // rough, fills 0..1
SparseVolume unit_volume(int n, const std::function<float(vec3)>& density); // n^3 voxels that fill 0..1
Medium medium_of(const SparseVolume& volume, float extinction);
Medium grid_medium(float extinction, int voxels, const std::function<float(vec3)>& density); // fills 0..1
Light sun_light(vec3 direction, float lux);
Light point_light(vec3 position, float candela);
Snapshot snapshot_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient = vec3(0));
Mesh box_of(vec3 low, vec3 high, int material);
Mesh floor_of(float height, float half, int material);
// The scene must outlive the snapshot.
void add_surfaces(const Scene& scene, Snapshot& snapshot);

// --- light -------------------------------------------------------------------------------------------------------
struct RayLight {
    double value = 0, error = 0; // of the red channel; its standard error
};
// Light of fog and surfaces along a ray by the path tracer, from 64 batches of `samples` paths.
RayLight path_light(const Snapshot& snapshot, const Ray& ray, int samples, int orders = all_orders);

// Light of the fog along a ray by the deterministic reference.
Scatter reference_light(const Snapshot& snapshot, const Ray& ray);

// ∫ f over a..b by Gauss–Legendre with 5 nodes on each of `pieces` pieces.
double integral(double a, double b, int pieces, const std::function<double(double)>& f);
}
