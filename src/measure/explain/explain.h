// What happens along one camera ray: fog, surfaces, where each light comes in and what keeps it out, and what every
// mode makes of it beside exact single scattering. Plain data, to be printed or drawn.
//
// Distances are metres along the ray from its start, radiances linear Rec.709 in nits.
#pragma once
#include "base/math.h"
#include "modes/mode.h"
#include "scene/light_kind.h"

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
    vec3 radiance{0}; // it sends towards the eye
    float share = 1;  // of it that arrives there: its own alpha, fog and surfaces before it
};

struct MediumOnRay {
    std::string name;
    double depth = 0; // optical depth
};

enum class Lighting { full, partial, shadowed, out_of_reach };

// A stretch on which one light does the same.
struct LightStretch {
    double low = 0, high = 0;
    Lighting state = Lighting::full;
    double share = 0;                  // of the light's points that see it, on average
    std::vector<std::string> blockers; // what stands before the others, the most of it first
};

// A light as one step sees it.
struct LightAtStep {
    float share = 0;         // of the light's points that see it
    float transmittance = 1; // of the fog between light and step
    vec3 scattered{0};       // radiance per metre that the fog sends towards the eye
};

struct LightOnRay {
    std::string name;
    LightKind kind = LightKind::point;
    bool shadows = true;
    int points = 1;                      // of the light, that were asked for shadows; more than one of soft lights
    bool sampled = false;                // shadows of MASK and BLEND surfaces are known step by step only
    vec3 fog{0};                         // light scattered on the ray that arrives at the eye
    vec3 surfaces{0};                    // the same for what surfaces reflect
    std::vector<LightStretch> stretches; // ascending, without gaps where the ray has fog
    std::vector<LightAtStep> at;         // one for each step
};

// A piece of the ray on which the fog is taken as even. Steps end where a light's shadow does.
struct RayStep {
    double low = 0, high = 0;
    double extinction = 0; // mean, 1/m
    double depth = 0;      // optical depth from the eye to its middle
    double to_eye = 1;     // share of the light from its middle that arrives: through fog and BLEND surfaces
    double reach = 0;      // the same integrated over the step, metres: times a radiance per metre, what arrives
    vec3 glow{0};          // radiance per metre of emission and ambient light

    double middle() const { return 0.5 * (low + high); }
};

// What a mode says of the ray.
struct Answer {
    std::string mode;
    Accuracy accuracy = Accuracy::artistic;
    vec3 inscatter{0}; // fog light
    vec3 color{0};     // with what lies behind the fog
    float transmittance = 1, validity = 1;
    int steps = 0;
    int samples = 1;                    // averaged; more than one where the mode is noisy
    std::optional<vec3> standard_error; // of the fog light, then
    ivec2 picture{0};                   // of a mode that works on pictures: the size of the one it was asked for
    Limitations limitations;            // what the mode says of itself, as far as it concerns this ray
    std::string remark;                 // how it was asked, where that matters
    bool finite = true;
};

// How far an answer's fog light is from the reference's, of its luminance: 0.1 = 10 % too bright. Infinite where there
// should be none.
double difference(const Answer& answer, const Answer& reference);

struct RayStory {
    ivec2 pixel{0}, size{0};
    vec3 origin{0}, direction{0, 0, -1};
    dvec3 world_origin{0}; // what `origin` counts from
    double end = 0;        // of the ray: its opaque surface, or where no more fog is to be seen
    bool hits = false;     // whether an opaque surface is there
    std::vector<SurfaceOnRay> surfaces;
    vec3 background{0}; // radiance, and the share of it that arrives
    float background_share = 0;
    std::vector<MediumOnRay> media;
    double depth = 0;               // optical depth of all fog on the ray
    vec3 glow{0};                   // of all fog, at the eye
    std::vector<RayStep> steps;     // ascending; none where there is no fog
    std::vector<LightOnRay> lights; // of the snapshot
    Answer reference;               // exact single scattering
    std::vector<Answer> answers;
};

struct ExplainOptions {
    std::vector<const Mode*> modes; // to be asked
    int light_points = 64;          // of soft lights, for the reference
    int noisy_samples = 8192;       // of a mode whose error is noise; a multiple of 32
    int steps = 128;                // of equal length, and as many of equal optical depth; shadows add more
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress; // 0..1
};

// Follows the ray through the centre of a pixel of the view's full picture. Modes answer as in a picture of one sample
// at the centre of each pixel; of the view counts what decides on that: camera, size, jitter, seed, frame. Throws Error
// (internal) when cancelled.
RayStory explain_ray(const View& view, const Snapshot& snapshot, const Settings& settings, ivec2 pixel,
                     const ExplainOptions& options);

std::string_view name_of(Lighting state);
}
