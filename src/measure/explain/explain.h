// Explains one camera ray: fog, surfaces, where each light reaches it and what blocks it, and the result of every mode
// beside exact single scattering. Plain data, to be printed or drawn.
//
// Distances are meters along the ray from its start, radiances linear Rec.709 in nits.
#pragma once
#include "base/math.h"
#include "modes/mode.h"
#include "scene/lights/light_kind.h"

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
struct Mode;
struct Settings;
struct Snapshot;
struct View;

// A surface on the ray; the last one is opaque, unless the ray goes on into the background.
struct SurfaceOnRay {
    double distance = 0;
    std::string name, material; // empty = without a material
    float alpha = 1;
    vec3 radiance{0}; // sent towards the eye
    float share = 1;  // of it that arrives, after its own alpha and the fog and surfaces in front
};

struct MediumOnRay {
    std::string name;
    double depth = 0; // optical depth
};

enum class LightState { full, partial, shadowed, out_of_reach };

// A stretch of the ray on which one light has the same state.
struct LightStretch {
    double low = 0, high = 0;
    LightState state = LightState::full;
    double share = 0;                  // of the light's points that are visible, on average
    std::vector<std::string> blockers; // what hides the others, most frequent first
};

// A light as seen from one step.
struct LightAtStep {
    float share = 0;         // of the light's points that are visible
    float transmittance = 1; // of the fog between light and step
    vec3 scattered{0};       // radiance per meter that the fog scatters towards the eye
};

struct LightOnRay {
    std::string name;
    LightKind kind = LightKind::point;
    bool shadows = true;
    int points = 1;                      // on the light, sampled for shadows; more than one for soft lights
    bool sampled = false;                // shadows of MASK and BLEND surfaces are sampled once per step
    vec3 fog{0};                         // light scattered on the ray that arrives at the eye
    vec3 surfaces{0};                    // light reflected by surfaces that arrives at the eye
    std::vector<LightStretch> stretches; // ascending, without gaps where the ray has fog
    std::vector<LightAtStep> at;         // one for each step
};

// A piece of the ray on which the fog is taken as homogeneous. Steps also end at shadow boundaries.
struct RayStep {
    double low = 0, high = 0;
    double extinction = 0; // mean, 1/m
    double depth = 0;      // optical depth from the eye to its middle
    double to_eye = 1;     // transmittance from its middle to the eye, of fog and BLEND surfaces
    double reach = 0; // to_eye integrated over the step, meters: times radiance per meter gives the light that arrives
    vec3 glow{0};     // radiance per meter of emission and ambient light

    double middle() const { return 0.5 * (low + high); }
};

// A mode's result for the ray.
struct ModeResult {
    std::string mode;
    Accuracy accuracy = Accuracy::artistic;
    vec3 inscatter{0}; // fog light
    vec3 color{0};     // including what is behind the fog
    float transmittance = 1, validity = 1;
    int steps = 0;
    int samples = 1;                    // averaged; more than one if the mode is noisy
    std::optional<vec3> standard_error; // of the fog light, if the mode is noisy
    ivec2 image_size{0};                // size of the image rendered, if the mode works on whole images
    Limitations limitations;            // of the mode, those that concern this ray
    std::string remark;                 // how it was obtained, where that matters
    bool finite = true;
};

// Relative error of the luminance of a result's fog light: 0.1 = 10 % too bright. Infinite where there should be none.
double difference(const ModeResult& result, const ModeResult& reference);

struct RayReport {
    ivec2 pixel{0}, size{0};
    vec3 origin{0}, direction{0, 0, -1};
    dvec3 world_origin{0}; // world position that `origin` is relative to
    double end = 0;        // of the ray: its opaque surface, or the end of the visible fog
    bool hits = false;     // it ends at an opaque surface
    std::vector<SurfaceOnRay> surfaces;
    vec3 background{0}; // radiance, and the share of it that arrives
    float background_share = 0;
    std::vector<MediumOnRay> media;
    double depth = 0;               // optical depth of all fog on the ray
    vec3 glow{0};                   // emission and ambient light of all fog, at the eye
    std::vector<RayStep> steps;     // ascending; none where there is no fog
    std::vector<LightOnRay> lights; // of the snapshot
    ModeResult reference;           // exact single scattering
    std::vector<ModeResult> results;
};

struct ExplainOptions {
    std::vector<const Mode*> modes; // to be evaluated
    int light_points = 64;          // on soft lights, for the reference
    int noisy_samples = 8192;       // of a mode whose error is noise; a multiple of 32
    int steps = 128;                // of equal length, and as many of equal optical depth; shadows add more
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// Follows the ray through the center of a pixel of the view's full image. Modes are evaluated as in an image with one
// sample at the center of each pixel; of the view, only camera, size, jitter, seed and frame matter. Throws Error
// (internal) when cancelled.
RayReport explain_ray(const View& view, const Snapshot& snapshot, const Settings& settings, ivec2 pixel,
                      const ExplainOptions& options);

std::string_view name_of(LightState state);
}
