// One mode at one value of a case, and what cases are made of. Internal to stress.
#pragma once
#include "measure/stress/stress.h"
#include "measure/verify/rays.h"
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
    std::shared_ptr<const StressScene> finer{}; // what the truth is rendered of, where it is not this: more moments
};
// What no picture may hold.
struct Faults {
    uint64_t non_finite = 0, negative = 0;
};

struct Truth {
    Layers layers;
    Faults faults;
    std::optional<Layers> again{}; // as good, by other random numbers, where they decide what it shows
};

struct Trial {
    const Mode* mode = nullptr; // null = the program
    double value = 0, allowed = 0;
    const StressScene& scene;
    std::optional<Truth>& known_truth; // of the scene, shared by the modes
    std::atomic<bool>* cancel = nullptr;
    Faults faults{};        // of everything rendered but the shared truth
    double bias = -1;       // of the mean of the fog's light, as a share, where it is measured
    int noisy_samples = 16; // per pixel, of a mode whose error is noise

    Layers render(const StressScene& what, History* history = nullptr, bool parts = false);
    Layers render() { return render(scene); }
    Layers truth_of_scene(const StressScene& what); // exact single scattering, at pixel centres
    const Layers& truth();
    const Layers& other_truth(); // the same picture where chance has no part in it
};

// --- errors ------------------------------------------------------------------------------------------------------
// E: the relative RMSE of picture or fog light, whichever is worse.
double difference(const Layers& test, const Layers& reference);
double difference(const Image<vec3>& test, const Image<vec3>& reference);
// Of the trial's mode against the truth, grain included. Where noise is the only error there is: what noise does not
// explain, from so many samples that a bias as large as is allowed shows.
double error_to_truth(Trial& trial);
double error_of_mean(Trial& trial); // of the fog light; where noise is the only error, as above
// The error, and beside it the bias of the mean of the fog's light, neither with the truth's own noise.
double error_and_bias(Trial& trial);
double leak(Trial& trial); // the fog's mean light, by that of the same fog without surfaces
inline constexpr std::string_view to_truth = StressMeasure{}.criterion;
double mean_of(const Image<vec3>& image);
double max_of(const Image<vec3>& image);

// --- scenes ------------------------------------------------------------------------------------------------------
constexpr ivec2 stress_size{49, 27}; // odd: the middle ray looks where the camera does

Camera camera_from(vec3 position, vec3 target, float vertical_fov = 0.7f);
Camera flat_camera(vec3 position, vec3 target, float height); // orthographic

// At preview, one ray through each pixel's centre, froxels as wide as a pixel.
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
