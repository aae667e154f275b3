// Scenes made in memory and light along single rays, for checks. Internal to verify and stress.
#pragma once
#include "base/gauss_legendre.h"
#include "integrate/ray_estimate.h"
#include "measure/verify/verify.h"
#include "modes/settings.h"
#include "trace/small_scenes.h"

namespace tyndall {
// The checks made so far.
struct Checks {
    std::vector<Check> list;
    std::string topic;
    std::function<void(double)> progress; // 0..1 of the current group; may be empty
    uint64_t non_finite = 0;              // samples of images rendered so far

    void add(std::string name, double measured, double expected, double tolerance, std::string basis);
};

struct CheckGroup {
    const char* topic;
    double share; // of the whole time, approximately
    std::function<void(Checks&)> run;
};
std::vector<CheckGroup> closed_form_checks();
std::vector<CheckGroup> transport_checks();
std::vector<CheckGroup> invariance_checks();

// Runs groups one after the other.
std::vector<Check> run_checks(std::span<const CheckGroup> groups, const VerifyControl& control);

// --- scenes ------------------------------------------------------------------------------------------------------
Medium noise_medium(float extinction, Phase phase = forward_phase(0), vec3 albedo = vec3(1)); // rough, fills 0..1
Medium grid_medium(float extinction, int voxels, const std::function<float(vec3)>& density);  // fills 0..1

// --- light -------------------------------------------------------------------------------------------------------
// Light of fog and surfaces along a ray by the path tracer, from 64 batches of `samples` paths.
RayEstimate path_light(const Snapshot& snapshot, const Ray& ray, int samples, int orders = all_orders);

// Light of the fog along a ray by the deterministic reference.
Scatter reference_light(const Snapshot& snapshot, const Ray& ray);
}
