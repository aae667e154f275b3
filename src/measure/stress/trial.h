// One mode at one value of a case, and the parts that cases are made of. Internal to stress.
#pragma once
#include "measure/stress/stress.h"
#include "measure/verify/rays.h"
#include "modes/cone/limitations.h"
#include "modes/settings.h"
#include "render/frame/frame.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <optional>

namespace tyndall {
// What is rendered at one value of a sweep.
struct StressScene {
    std::shared_ptr<Scene> scene; // of the snapshot's surfaces; null = none
    Snapshot snapshot;
    View view;
    Settings settings;
    std::shared_ptr<const StressScene> finer{}; // scene of the ground truth if it is not this one: more moments
};
// Values that no image may have.
struct Faults {
    uint64_t non_finite = 0, negative = 0;
};

struct Truth {
    Layers layers;
    Faults faults;
    std::optional<Layers> again{}; // the same with another seed, if it is random
};

struct Trial {
    const Mode* mode = nullptr; // null = the program
    double value = 0, allowed = 0;
    const StressScene& scene;
    std::optional<Truth>& known_truth; // of the scene, shared by the modes
    std::atomic<bool>* cancel = nullptr;
    Faults faults{};        // of everything rendered but the shared ground truth
    double bias = -1;       // of the mean fog light, relative; below 0: not measured
    int noisy_samples = 16; // per pixel, of a mode whose error is noise

    Layers render(const StressScene& what, History* history = nullptr, bool parts = false);
    Layers render() { return render(scene); }
    Layers truth_of_scene(const StressScene& what); // exact single scattering, at pixel centers
    const Layers& truth();
    const Layers& other_truth(); // with another seed; the same image if nothing is random
};

// --- errors ------------------------------------------------------------------------------------------------------
// E: the relative RMSE of image or fog light, whichever is worse.
double difference(const Layers& test, const Layers& reference);
double difference(const Image<vec3>& test, const Image<vec3>& reference);
// Error of the trial's mode against the ground truth, grain included. If noise is the only error: the part that noise
// does not explain, from enough samples to show a bias as large as the allowed error.
double error_to_truth(Trial& trial);
double error_of_mean(Trial& trial); // of the fog light; if noise is the only error, as above
// The error; trial.bias gets the bias of the mean fog light. Both are unbiased by the ground truth's noise.
double error_and_bias(Trial& trial);
double leak(Trial& trial); // mean fog light relative to that of the same fog without surfaces
inline constexpr std::string_view to_truth = StressMeasure{}.criterion;
double mean_of(const Image<vec3>& image);
double max_of(const Image<vec3>& image);

// The error that a limitation states in percent, with a margin: it is measured on a few rays, and others differ.
double stated_error(const Limitation& limitation);
inline constexpr Excuse shadows_ignored{&limitation::no_shadows, 0, stated_error}; // by cone

// --- scenes ------------------------------------------------------------------------------------------------------
constexpr ivec2 stress_size{49, 27}; // odd, so that the middle ray is the view direction

Camera camera_from(vec3 position, vec3 target, float vertical_fov = 0.7f);
Camera flat_camera(vec3 position, vec3 target, float height); // orthographic

// A scene at quality preview: one ray through each pixel center, froxels as wide as a pixel.
StressScene stress_scene(std::vector<Medium> media, std::vector<Light> lights, Camera camera,
                         std::vector<Mesh> meshes = {}, std::vector<Material> materials = {});

// --- the groups of cases -------------------------------------------------------------------------------------------
std::vector<StressCase> stress_lamps();
std::vector<StressCase> stress_filters();
std::vector<StressCase> stress_fog();
std::vector<StressCase> stress_shadows();
std::vector<StressCase> stress_history();
std::vector<StressCase> stress_looks();
std::vector<StressCase> stress_files();
std::vector<StressCase> stress_data();
std::vector<StressCase> stress_scattering();
std::vector<StressCase> stress_orders();
std::vector<StressCase> stress_program();
std::vector<StressCase> stress_fire();
std::vector<StressCase> stress_glow();
std::vector<StressCase> stress_faces();
std::vector<StressCase> stress_beams();
std::vector<StressCase> stress_skies();
std::vector<StressCase> stress_lobes();
std::vector<StressCase> stress_colors();
std::vector<StressCase> stress_shutters();
}
