// The techniques: what each promises, where it fails, and how it turns a scene into light along camera rays.
#pragma once
#include "modes/history.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// What the fog does to one camera ray up to its t_max.
struct Scatter {
    vec3 radiance{0};        // light scattered and emitted towards the eye
    float transmittance = 1; // share of what lies behind that comes through
    float validity = 1;      // 0 where the mode knows itself wrong
    int steps = 0;           // evaluations spent, for statistics
    vec3 surface{0};         // of a mode with Surfaces::own: light of surfaces and background, through the fog
};

// Up to 16 neighbouring rays (4×4 pixels) of one pixel sample.
struct RayBatch {
    std::span<const Ray> rays;
    std::span<const uint32_t> ids;         // a number per ray, unique to pixel and sample: seeds random choices
    std::span<vec3> per_light;             // empty, or rays × lights: the part of radiance from each light
    std::span<const float> jitter;         // per ray in [0,1), stratified over the samples of a pixel; empty = ½
    std::span<const SamplePlace> places{}; // per ray: its pixel's low-discrepancy sequence; empty = none, take ids
    std::span<const float> near{}; // for Surfaces::own, per ray: nearer surfaces are cut away (fog is not); empty = 0
    std::span<const vec2> positions{}; // of the rays in the picture, in pixels from the upper left; empty = unknown
    std::span<const bool> open{};      // per ray: no surface ends it, but the fog; empty = unknown
};
using ScatterFunction = std::function<void(const RayBatch&, std::span<Scatter>)>;

enum class Accuracy { look, even_fog, single_scattering, multiple_scattering };
// Who shades what lies behind the fog: the renderer; the mode, which then gets whole camera rays, follows them through
// BLEND surfaces and adds surfaces and background itself; or nobody, because the mode works on the finished picture.
enum class Surfaces { shared, own, post };
enum class Severity { info, degraded, wrong };

struct Limit {
    Severity severity = Severity::info;
    std::string where, why;
};

// A picture without fog, and what a mode with Surfaces::post adds to it. All images cover the full picture.
struct PlainPicture {
    const Image<vec3>& color; // linear Rec.709
    const Image<float>& alpha;
    const Image<float>& depth; // planar z, infinite where there is no surface
};
struct Addition {
    Image<vec3> radiance;
    Image<float> validity;
    std::vector<Image<vec3>> per_light; // if the view wants them: parts of radiance, one for each light
};
using PostFunction = std::function<Addition(const PlainPicture&)>;

struct Mode {
    std::string_view name, summary;
    Accuracy accuracy;
    Surfaces surfaces;
    std::vector<Limit> (*limits)(const View&, const Snapshot&, const Settings&);
    // History may be null. Of Surfaces::post: the fog of the picture it works on.
    ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*);
    PostFunction (*prepare_post)(const View&, const Snapshot&, const Settings&) = nullptr; // for Surfaces::post only
    bool remembers = false; // whether a History changes anything
};

std::span<const Mode> modes();
const Mode& find_mode(std::string_view name); // throws Error (usage) listing the names

// Whether style.* changes its pictures: the truth has none.
bool honours_style(const Mode& mode);

// Whether it can add light that scatters more than once (fluence.orders).
bool has_fluence(const Mode& mode);

// Whether the mode's only error is noise, so that the variance of a picture says how far it is from the truth.
bool error_is_noise(const Mode& mode);

std::string_view name_of(Accuracy accuracy);
std::string_view name_of(Severity severity);
}
